"""The link to a robot by its page's server, which shows the robot and passes on wishes."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from typing import Any, Final

import websockets

from roomba.client.page_api import PageApi
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.ui.top.grids import Grid, take_tiles

_AGAIN: Final = 1.0
"""s of wall time from a lost connection to the next try."""
_LARGEST: Final = 64 << 20
"""Bytes of a message: a map of 20 million cells, and more."""


class PageLink:
    """The newest state of one robot, which the server sends; a lost connection is renewed.

    ``state`` and ``home`` are as the API tells them, empty at first; ``grids`` are layers by name.
    ``link`` is connecting, live, gone (the robot does not answer) or lost (its server does not).
    """

    def __init__(self, port: int, token: str, host: str = "127.0.0.1") -> None:
        """Connect nothing yet; without a token, an empty one, the robot can only be looked at."""
        self._address, self._token = f"{host}:{port}", token
        self._api = PageApi(f"http://{self._address}", token)
        self.state: dict[str, Any] = {}
        self.home: dict[str, Any] = {}
        self.grids: dict[str, Grid] = {}
        self.link = "connecting"
        self.may_change = False
        self.on_refusal: Callable[[str], None] = lambda _: None
        self._socket: Any = None

    async def run(self) -> None:
        """Follow the robot until it is cancelled."""
        while True:
            try:
                # Of this machine: it goes past any proxy.
                async with websockets.connect(
                    f"ws://{self._address}/live", max_size=_LARGEST, proxy=None
                ) as socket:
                    self._socket = socket
                    await socket.send(json.dumps({"type": "hello", "token": self._token}))
                    async for message in socket:
                        self._take(message)
            except (OSError, ValueError, websockets.WebSocketException):
                pass
            self._socket, self.link = None, "lost"
            await asyncio.sleep(_AGAIN)

    async def drive(self, linear: float, angular: float) -> None:
        """Drive by hand, m/s and rad/s; the robot stands half a second after the last wish."""
        if self._socket is None:
            raise RobotUnavailableError("the robot cannot be reached")
        if not self.may_change:
            raise RequestRefusedError(NO_TOKEN)
        await self._socket.send(json.dumps({"type": "drive", "linear": linear, "angular": angular}))

    async def command(self, name: str, wish: dict[str, Any] | None = None) -> None:
        """Let the API do something; raises RequestRefusedError, RobotUnavailableError."""
        if not self._token:
            raise RequestRefusedError(NO_TOKEN)
        await asyncio.to_thread(self._api.send, name, wish)

    async def limits(self) -> dict[str, Any]:
        """Return the robot's limits; raises RequestRefusedError, RobotUnavailableError."""
        return await asyncio.to_thread(self._api.get, "api/v1/limits")

    def _take(self, message: str | bytes) -> None:
        """Take a message of the server; raises ValueError for a senseless one."""
        if isinstance(message, bytes):
            take_tiles(self.grids, message)
            return
        told = json.loads(message)
        kind = told.get("type") if isinstance(told, dict) else None
        if kind == "state":
            self.state, self.link = told, str(told.get("link", "live"))
        elif kind == "home":
            self.home = told
        elif kind == "welcome":
            self.may_change = bool(told.get("may_change"))
        elif kind == "refused":
            self.on_refusal(str(told.get("reason", "")))


NO_TOKEN: Final = (
    "its server obeys only who has its token, and none that fits was found: give ./roomba top the "
    "whole address that ./roomba run or play printed"
)
"""Why the user cannot change anything."""
