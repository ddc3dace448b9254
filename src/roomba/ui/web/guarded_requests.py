"""Checks each request before it is read: its page is of this server, and it has the token."""

from __future__ import annotations

from typing import Any, Final

from fastapi import Request, WebSocket
from fastapi.responses import JSONResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from roomba.ui.web.bounded.limits import MOST_BODY
from roomba.ui.web.guard import Guard

_SAFE_METHODS: Final = ("GET", "HEAD", "OPTIONS")
_POLICY: Final = (
    "default-src 'self'; connect-src 'self'; img-src 'self' data: blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_FOREIGN: Final = 4403
"""The code with which a WebSocket of another site is closed."""


class GuardedRequests:
    """Refuses requests of other sites, and changes without the token, before they are read.

    To open a WebSocket changes nothing; the token comes in its messages.
    """

    def __init__(self, app: ASGIApp, guard: Guard) -> None:
        """Stand before ``app``."""
        self._app, self._guard = app, guard

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] == "websocket":
            await self._pass_socket(scope, receive, send)
        elif scope["type"] == "http":
            await self._pass_request(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    async def _pass_socket(self, scope: Scope, receive: Receive, send: Send) -> None:
        socket = WebSocket(scope, receive, send)
        host = socket.headers.get("host")
        if self._guard.is_host(host) and self._guard.is_origin(socket.headers.get("origin"), host):
            await self._app(scope, receive, send)
        else:
            await socket.close(_FOREIGN)

    async def _pass_request(self, scope: Scope, receive: Receive, send: Send) -> None:
        refusal = self._refusal(Request(scope))
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
        # Without either of these headers a request has no body (RFC 9112, 6.3).
        length = headers.get("content-length", "" if "transfer-encoding" in headers else "0")
        if not (length.isascii() and length.isdigit() and len(length) < 10) or (
            int(length) > MOST_BODY
        ):
            return 413, f"expected a body with a length of at most {MOST_BODY} bytes"
        if int(length) and headers.get("content-type", "").split(";")[0] != "application/json":
            return 415, "expected a body of application/json"
        scheme, _, token = headers.get("authorization", "").partition(" ")
        if scheme != "Bearer" or not self._guard.is_token(token):
            return 401, "expected the token of the printed address (Authorization: Bearer TOKEN)"
        return None


def _with_policy(send: Send) -> Send:
    """Return a sender that adds security headers to responses."""

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
    """Whether a response has a content security policy of its own."""
    return any(name == b"content-security-policy" for name, _ in message["headers"])
