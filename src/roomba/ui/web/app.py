"""The application: the page, the API, and the stream of what viewers see, for one robot."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any, Final

from fastapi import FastAPI, Request, WebSocket, WebSocketDisconnect
from fastapi.responses import JSONResponse
from fastapi.staticfiles import StaticFiles
from starlette.types import ASGIApp, Receive, Scope, Send

from roomba.client.observed import MapKeeper, ObservedRobot, Playground
from roomba.client.protocol import CameraClient, RequestRefusedError, RobotUnavailableError
from roomba.history.recorder import HistoryKeeper
from roomba.ui.web.api import DriveWish, api_of
from roomba.ui.web.feed import Feed
from roomba.ui.web.guard import Guard
from roomba.ui.web.past import Replays, history_api
from roomba.ui.web.playing import playing_api

STATIC: Final = Path(__file__).parent / "static"
_MOST_BODY: Final = 65536
"""Bytes of a request's body."""
_SAFE_METHODS: Final = ("GET", "HEAD", "OPTIONS")
_POLICY: Final = (
    "default-src 'self'; connect-src 'self'; img-src 'self' data: blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)


def create_app(robot: ObservedRobot, guard: Guard, keeper: HistoryKeeper | None = None) -> FastAPI:
    """Return the application for a robot; what changes anything needs the guard's token.

    The keeper keeps its runs in the history, which the page shows then.
    """
    feed = Feed(robot, keeper)
    replays = (
        None if keeper is None else Replays(keeper.history, lambda run: create_app(run, guard))
    )

    @contextlib.asynccontextmanager
    async def life(_: FastAPI) -> AsyncIterator[None]:
        looking = asyncio.create_task(feed.run())
        try:
            yield
        finally:
            looking.cancel()
            if replays is not None:
                await replays.end()

    abilities = {
        "history": keeper is not None,
        "camera": isinstance(robot, CameraClient),
        "maps": isinstance(robot, MapKeeper),
    }
    app = FastAPI(title="roomba_robot", lifespan=life, docs_url=None, redoc_url=None)
    app.include_router(api_of(robot))
    if isinstance(robot, Playground):
        app.include_router(playing_api(robot))

    @app.websocket("/live")
    async def live(socket: WebSocket) -> None:
        await _serve_viewer(socket, feed, robot, guard, abilities)

    if keeper is not None and replays is not None:
        app.include_router(history_api(keeper.history))
        app.mount("/replay", replays)
    app.mount("/", StaticFiles(directory=STATIC, html=True), name="page")
    app.add_middleware(GuardedRequests, guard=guard)
    return app


class GuardedRequests:
    """Refuses requests of other sites, and changes without the token, before they are read."""

    def __init__(self, app: ASGIApp, guard: Guard) -> None:
        """Stand before ``app``."""
        self._app, self._guard = app, guard

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        refusal = self._refusal(request)
        if refusal is not None:
            await JSONResponse({"detail": refusal[1]}, refusal[0])(scope, receive, send)
            return
        await self._app(scope, receive, _with_policy(send))

    def _refusal(self, request: Request) -> tuple[int, str] | None:
        headers = request.headers
        host = headers.get("host")
        if not self._guard.is_host(host):
            return 421, "this server is not called so; use the address that it printed"
        if not self._guard.is_origin(headers.get("origin"), host):
            return 403, "requests of other sites are refused"
        if request.method in _SAFE_METHODS:
            return None
        length = headers.get("content-length", "")
        if not length.isdigit() or int(length) > _MOST_BODY:
            return 413, f"expected a body with a length of at most {_MOST_BODY} bytes"
        if int(length) and headers.get("content-type", "").split(";")[0] != "application/json":
            return 415, "expected a body of application/json"
        scheme, _, token = headers.get("authorization", "").partition(" ")
        if scheme != "Bearer" or not self._guard.is_token(token, time.monotonic()):
            return 401, "expected the token of the printed address (Authorization: Bearer TOKEN)"
        return None


def _with_policy(send: Send) -> Send:
    """Return a sender that adds the headers which bind a browser."""

    async def sending(message: Any) -> None:
        if message["type"] == "http.response.start":
            own = [] if _has_policy(message) else [(b"content-security-policy", _POLICY.encode())]
            message["headers"] = [
                *message["headers"],
                *own,
                (b"x-content-type-options", b"nosniff"),
                (b"referrer-policy", b"no-referrer"),
                (b"cache-control", b"no-cache"),
            ]
        await send(message)

    return sending


def _has_policy(message: Any) -> bool:
    """Whether a response binds a browser more tightly itself."""
    return any(name == b"content-security-policy" for name, _ in message["headers"])


# ---------------------------------------------------------------- viewers


async def _serve_viewer(
    socket: WebSocket, feed: Feed, robot: ObservedRobot, guard: Guard, abilities: dict[str, bool]
) -> None:
    """Show a viewer all that changes, until it goes."""
    host = socket.headers.get("host")
    if not (guard.is_host(host) and guard.is_origin(socket.headers.get("origin"), host)):
        await socket.close(4403)
        return
    await socket.accept()
    hearing = asyncio.create_task(_hear(socket, robot, guard, abilities))
    showing = asyncio.create_task(_show(socket, feed))
    try:
        await asyncio.wait((hearing, showing), return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in (hearing, showing):
            task.cancel()
            with contextlib.suppress(asyncio.CancelledError, WebSocketDisconnect, RuntimeError):
                await task


async def _show(socket: WebSocket, feed: Feed) -> None:
    """Send the newest whenever the last was taken: a slow viewer skips what is out of date."""
    number, home, trail = 0, 0, 0
    versions = dict.fromkeys(feed.layers, 0)
    while True:
        number = await feed.newer(number)
        if feed.home is not None and feed.home_version != home:
            home = feed.home_version
            await socket.send_text(_text(feed.home))
        for name, layer in feed.layers.items():
            changes = layer.since(versions[name])
            if changes is not None:
                versions[name] = layer.version
                await socket.send_bytes(changes)
        walked = feed.trail_since(trail)
        if walked is not None:
            trail = walked["end"]
            await socket.send_text(_text(walked))
        await socket.send_text(_text(feed.state))


async def _hear(
    socket: WebSocket, robot: ObservedRobot, guard: Guard, abilities: dict[str, bool]
) -> None:
    """Take a viewer's stream of drives by hand, which begins with the token."""
    may_drive = False
    while True:
        try:
            told = json.loads(await socket.receive_text())
            kind = told.get("type") if isinstance(told, dict) else None
            if kind == "hello":
                may_drive = guard.is_token(str(told.get("token", "")), time.monotonic())
                welcome = {"type": "welcome", "may_change": may_drive, **abilities}
                await socket.send_text(_text(welcome))
            elif kind == "drive" and may_drive:
                wish = DriveWish(linear=told.get("linear"), angular=told.get("angular"))
                await asyncio.to_thread(robot.drive, wish.linear, wish.angular)
        except (RequestRefusedError, RobotUnavailableError) as refusal:
            await socket.send_text(_text({"type": "refused", "reason": str(refusal)}))
        except (ValueError, KeyError):
            await socket.send_text(
                _text({"type": "refused", "reason": "expected JSON with a type that is known"})
            )


def _text(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False)
