"""Serves viewers of the page: each gets the newest unseen state, and may drive by hand."""

from __future__ import annotations

import asyncio
import contextlib
import json
from typing import Final

from fastapi import WebSocket, WebSocketDisconnect

from roomba.client.observed import ObservedRobot
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.ui.web.bounded.limits import MOST_GARBAGE
from roomba.ui.web.feed import Feed
from roomba.ui.web.guard import Guard
from roomba.ui.web.routes.wishes import DriveWish, SeenWish
from roomba.ui.web.streams.told import text_of

SENSELESS: Final = 1008
"""The code with which a WebSocket is closed after senseless messages."""


class Viewers:
    """Serves the WebSockets of pages."""

    def __init__(
        self, feed: Feed, robot: ObservedRobot, guard: Guard, abilities: dict[str, bool]
    ) -> None:
        """Serve none yet; ``abilities`` are told to each page that says hello."""
        self._feed, self._robot, self._guard = feed, robot, guard
        self._abilities = abilities

    async def serve(self, socket: WebSocket) -> None:
        """Show a viewer all that changes, until it goes."""
        await socket.accept()
        seen = _Seen()
        hearing = asyncio.create_task(self._hear(socket, seen))
        showing = asyncio.create_task(self._show(socket, seen))
        await until_one_ends(hearing, showing)

    async def _show(self, socket: WebSocket, seen: _Seen) -> None:
        """Send the newest state when the viewer took the last: a slow viewer skips old states."""
        feed = self._feed
        number, home, trail = 0, 0, 0
        versions = dict.fromkeys(feed.layers, 0)
        while True:
            number = await feed.newer(number)
            if feed.home is not None and feed.home_version != home:
                home = feed.home_version
                await socket.send_text(feed.home.text)
            for name, layer in feed.layers.items():
                changes = layer.since(versions[name])
                if changes is not None:
                    versions[name] = layer.version
                    await socket.send_bytes(changes)
            walked = feed.trail.since(trail)
            if walked is not None:
                trail = walked.value["end"]
                await socket.send_text(walked.text)
            state = feed.state
            await socket.send_text(state.text)
            await seen.has_come(state.value.get("looked", 0.0))

    async def _hear(self, socket: WebSocket, seen: _Seen) -> None:
        """Take a viewer's messages: first the token, then twists for driving by hand."""
        may_drive, garbage = False, 0
        while garbage < MOST_GARBAGE:
            try:
                told = json.loads(await socket.receive_text())
                kind = told.get("type") if isinstance(told, dict) else None
                if kind == "hello":
                    token = str(told.get("token", ""))
                    may_drive = self._guard.is_token(token)
                    welcome = {"type": "welcome", "may_change": may_drive, **self._abilities}
                    await socket.send_text(text_of(welcome))
                elif kind == "drive":
                    wish = DriveWish(linear=told.get("linear"), angular=told.get("angular"))
                    if may_drive:
                        await asyncio.to_thread(self._robot.drive, wish.linear, wish.angular)
                elif kind == "seen":
                    seen.note(SeenWish(looked=told.get("looked")).looked)
                else:
                    raise ValueError(f"unknown type {kind!r}")
                garbage = 0
            except (RequestRefusedError, RobotUnavailableError) as refusal:
                await socket.send_text(text_of({"type": "refused", "reason": str(refusal)}))
            except (ValueError, KeyError, RecursionError):
                garbage += 1
                reason = "expected JSON with a type that is known"
                await socket.send_text(text_of({"type": "refused", "reason": reason}))
            # Received messages come here without waiting: give other tasks their turn.
            await asyncio.sleep(0)
        await socket.close(SENSELESS, "expected JSON with a type that is known")


class _Seen:
    """The newest look that a viewer confirmed; the next one is sent only after that.

    A viewer that never confirms any gets each look that its connection takes, so that many may be
    on their way.
    """

    def __init__(self) -> None:
        self._newest: float | None = None
        self._is_told = asyncio.Event()

    def note(self, looked: float) -> None:
        """Note that the viewer has the look of a time, s since 1970."""
        self._newest = max(looked, self._newest or 0.0)
        self._is_told.set()

    async def has_come(self, looked: float) -> None:
        """Wait until a confirming viewer has that look; pings tell whether it still lives."""
        while self._newest is not None and self._newest < looked:
            self._is_told.clear()
            await self._is_told.wait()


async def until_one_ends(*tasks: asyncio.Task[None]) -> None:
    """Wait until one of the tasks of a WebSocket ends, and end the others."""
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
            with contextlib.suppress(asyncio.CancelledError, WebSocketDisconnect, RuntimeError):
                await task
