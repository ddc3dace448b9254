"""The link to a robot: what the server of its page shows, and the wishes that it passes on."""

from __future__ import annotations

import asyncio
import json
import urllib.error
import urllib.request
from collections.abc import Callable
from typing import Any, Final

import websockets

from roomba.errors import RoombaError
from roomba.ui.top.grids import Grid, take_tiles

_AGAIN: Final = 1.0
"""s of wall time from a lost connection to the next try."""
_PATIENCE: Final = 6.0
"""s of wall time; a robot that says nothing for 5 s is told by its server."""
_LARGEST: Final = 64 << 20
"""Bytes of a message: a map of 20 million cells, and more."""
_OPENER: Final = urllib.request.build_opener(urllib.request.ProxyHandler({}))
"""Goes past any proxy: the server is on this machine."""


class RefusedError(RoombaError):
    """The robot, or its server, does not do what was wished for; the message is the reason."""


class PageLink:
    """What is seen of one robot: it comes by itself, and comes back when it was lost.

    ``state`` and ``home`` are as the API tells them, empty at first; ``grids`` are layers by name.
    ``link`` is connecting, live, gone (the robot does not answer) or lost (its server does not).
    """

    def __init__(self, port: int, token: str, host: str = "127.0.0.1") -> None:
        """Connect nothing yet; without a token, an empty one, the robot can only be looked at."""
        self._address, self._token = f"{host}:{port}", token
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
            raise RefusedError("the robot cannot be reached")
        if not self.may_change:
            raise RefusedError(NO_TOKEN)
        await self._socket.send(json.dumps({"type": "drive", "linear": linear, "angular": angular}))

    async def command(self, name: str, wish: dict[str, Any] | None = None) -> None:
        """Let the API do something; raises RefusedError with the reason."""
        await asyncio.to_thread(self._post, name, wish or {})

    async def limits(self) -> dict[str, Any]:
        """Return what may be asked for; raises RefusedError."""
        return await asyncio.to_thread(self._asked, urllib.request.Request(self._url("limits")))

    def _take(self, message: str | bytes) -> None:
        """Take in what the server shows; raises ValueError for what makes no sense."""
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

    def _post(self, name: str, wish: dict[str, Any]) -> None:
        if not self._token:
            raise RefusedError(NO_TOKEN)
        headers = {"Authorization": f"Bearer {self._token}", "Content-Type": "application/json"}
        self._asked(
            urllib.request.Request(
                self._url(name), json.dumps(wish).encode(), headers, method="POST"
            )
        )

    def _url(self, name: str) -> str:
        return f"http://{self._address}/api/v1/{name}"

    def _asked(self, request: urllib.request.Request) -> dict[str, Any]:
        try:
            with _OPENER.open(request, timeout=_PATIENCE) as answer:
                told: dict[str, Any] = json.load(answer)
                return told
        except urllib.error.HTTPError as refusal:
            raise RefusedError(_reason_of(refusal)) from refusal
        except (OSError, ValueError) as error:
            raise RefusedError(f"the robot cannot be reached: {error}") from error


NO_TOKEN: Final = (
    "its server obeys only who has its token, and none that fits was found: give ./roomba top the "
    "whole address that ./roomba run or play printed"
)
"""Why nothing can be changed."""


def _reason_of(refusal: urllib.error.HTTPError) -> str:
    """Return the sentence of the server, or what HTTP says."""
    try:
        return str(json.load(refusal)["detail"])
    except (ValueError, KeyError, TypeError, OSError):
        return str(refusal)
