"""The WebSockets on which programs speak rosbridge."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from fastapi import FastAPI, WebSocket

from roomba.ui.web.guard import Guard


class Bridge(Protocol):
    """Speaks with programs over WebSockets."""

    limits: Mapping[str, int]
    """The limits of what programs get."""

    async def serve(self, socket: WebSocket, guard: Guard, *, may_change: bool) -> None:
        """Speak with one program until it goes; without the token it may only read."""


def add_bridge(app: FastAPI, bridge: Bridge, guard: Guard) -> None:
    """Serve a bridge at ``/rosbridge``, and at ``/`` for programs that only know host and port."""

    async def speak(socket: WebSocket) -> None:
        given = _token_of(socket)
        may_change = given is not None and guard.is_token(given)
        if given is not None and not may_change:
            await socket.close(4401)
            return
        await socket.accept()
        await bridge.serve(socket, guard, may_change=may_change)

    for path in ("/rosbridge", "/"):
        app.add_api_websocket_route(path, speak)


def _token_of(socket: WebSocket) -> str | None:
    scheme, _, token = socket.headers.get("authorization", "").partition(" ")
    return token if scheme == "Bearer" else socket.query_params.get("token")
