"""Connections to the page's server, guarded: none lasts that says nothing, and none is owed much.

uvicorn waits for a request as long as it takes, answers pings of a client that does not read, and
waits for such a client before it closes. There are no settings for that, so its protocols are
derived from here.
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
"""Bytes below which a sender that waited for its reader goes on."""


def most_connections() -> int:
    """Return how many connections there may be, after asking the system for as many files."""
    wanted = MOST_CONNECTIONS + OWN_FILES
    allowed, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    if allowed == resource.RLIM_INFINITY or allowed >= wanted:
        return MOST_CONNECTIONS
    asked_for = wanted if most == resource.RLIM_INFINITY else min(wanted, most)
    # A service may be forbidden to ask.
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (asked_for, most))
        allowed = asked_for
    return max(1, allowed - OWN_FILES)


class GuardedConnection(H11Protocol):
    """A connection that must bring each request whole within some seconds."""

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
        """Take what came; a request that is whole, or a WebSocket, needs no deadline any more."""
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
    """A WebSocket that is closed when its client does not read, or sends without end."""

    def handle_ping(self) -> None:
        """Answer, unless answers are not read."""
        super().handle_ping()
        self._close_if_owed()

    def handle_cont(self, event: Frame) -> None:
        """Take a part of a message."""
        super().handle_cont(event)
        if len(self.frames) > MOST_FRAGMENTS:
            self.transport.abort()

    def keepalive_timeout(self) -> None:
        """Close at once: what was not read will not be read."""
        super().keepalive_timeout()
        self.transport.abort()

    async def send(self, message: Any) -> None:
        """Send; of a client that is to be closed nothing is waited for."""
        await super().send(message)
        if message["type"] == "websocket.close":
            self.loop.call_later(BODY_WITHIN, self.transport.abort)

    def _close_if_owed(self) -> None:
        if self.transport.get_write_buffer_size() > UNSENT:
            self.transport.abort()
