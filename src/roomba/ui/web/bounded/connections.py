"""Guards connections to the page's server: silent ones are closed, and none queues much output.

uvicorn waits for a request without a deadline, answers pings of a client that does not read, and
waits for such a client before it closes. It has no settings for that, so its protocols are
subclassed here.
"""

from __future__ import annotations

import asyncio
import contextlib
import resource
from typing import Any, Final

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import Frame

from roomba.ui.web.bounded.limits import (
    BODY_WITHIN,
    MOST_CONNECTIONS,
    MOST_FRAGMENTS,
    OWN_FILES,
    SENT_AHEAD,
    UNSENT,
)

_UNSENT_CALM: Final = SENT_AHEAD // 4
"""Bytes of waiting output below which a paused sender goes on."""


def most_connections() -> int:
    """Return the most connections, after asking the system for as many open files."""
    wanted = MOST_CONNECTIONS + OWN_FILES
    allowed, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    if allowed == resource.RLIM_INFINITY or allowed >= wanted:
        return MOST_CONNECTIONS
    asked_for = wanted if most == resource.RLIM_INFINITY else min(wanted, most)
    # A service may not be allowed to raise the limit.
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (asked_for, most))
        allowed = asked_for
    return max(1, allowed - OWN_FILES)


class GuardedConnection(H11Protocol):
    """A connection on which each request must come whole within some seconds."""

    _deadline: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Take a connection, unless there are too many."""
        super().connection_made(transport)
        transport.set_write_buffer_limits(high=SENT_AHEAD, low=_UNSENT_CALM)
        if len(self.connections) > most_connections():
            transport.abort()
        else:
            self._set_deadline()

    def data_received(self, data: bytes) -> None:
        """Take received bytes; a whole request, or a WebSocket, ends the deadline."""
        super().data_received(data)
        is_socket = self.transport.get_protocol() is not self
        is_partial = self.conn.their_state is h11.SEND_BODY or (
            self.conn.their_state is h11.IDLE and bool(self.conn.trailing_data[0])
        )
        if is_socket or not is_partial:
            self._clear_deadline()
        elif self._deadline is None:
            self._set_deadline()

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        self._clear_deadline()
        super().connection_lost(exc)

    def _set_deadline(self) -> None:
        self._deadline = self.loop.call_later(BODY_WITHIN, self.transport.abort)

    def _clear_deadline(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None


class GuardedSocket(WebSocketsSansIOProtocol):
    """A WebSocket that is closed when its client does not read, or sends an endless message."""

    def handle_ping(self) -> None:
        """Answer a ping, unless too many answers wait unread."""
        super().handle_ping()
        self._close_if_owed()

    def handle_cont(self, event: Frame) -> None:
        """Take a part of a message."""
        super().handle_cont(event)
        if len(self.frames) > MOST_FRAGMENTS:
            self.transport.abort()

    def keepalive_timeout(self) -> None:
        """Close at once: the client will not read what waits."""
        super().keepalive_timeout()
        self.transport.abort()

    async def send(self, message: Any) -> None:
        """Send; a client that is to be closed gets some seconds to close."""
        await super().send(message)
        if message["type"] == "websocket.close":
            self.loop.call_later(BODY_WITHIN, self.transport.abort)

    def _close_if_owed(self) -> None:
        if self.transport.get_write_buffer_size() > UNSENT:
            self.transport.abort()
