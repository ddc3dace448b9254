"""Serving the page on a port of this machine, until it is told to end."""

from __future__ import annotations

import asyncio
import errno
import socket
import threading
from typing import Final

import uvicorn
from fastapi import FastAPI

from roomba.client.ports import PORTS
from roomba.errors import RoombaError
from roomba.ui.web.addresses import ALL, addresses_of
from roomba.ui.web.bounded.connections import GuardedConnection, GuardedSocket
from roomba.ui.web.bounded.limits import BACKLOG, MOST_BODY, PING, SENT_AHEAD

_START: Final = 10.0
"""s of wall time within which the server must be up."""


class ServerError(RoombaError):
    """The page cannot be served; the message says why."""


def listen(host: str, port: int, *, is_fixed: bool) -> socket.socket:
    """Return a socket that listens at ``port``, or at one of the next that is free.

    Raises ServerError when there is none.
    """
    last = port if is_fixed or port == 0 else port + len(PORTS) - 1
    for tried in range(port, last + 1):
        bound = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        # Inherited by each connection: the system would queue megabytes for a slow viewer,
        # outdated.
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SENT_AHEAD)
        try:
            bound.bind((host, tried))
            # A browser that opens the address before the server runs waits, and is not refused.
            bound.listen()
        except OSError as error:
            bound.close()
            if error.errno == errno.EADDRNOTAVAIL:
                raise ServerError(
                    f"expected an address of this machine, got {host}; {ALL} stands for all of them"
                ) from error
            reason = error
        else:
            return bound
    wanted = f"port {port}" if port == last else f"one of the ports {port} to {last}"
    raise ServerError(
        f"expected {wanted} of {host} to be free: {reason}; choose another: "
        "--port N, or page_port:=N of run"
    )


class PageServer:
    """Serves an application in a thread of its own."""

    def __init__(self, app: FastAPI, bound: socket.socket) -> None:
        """Serve nothing yet."""
        self._socket = bound
        self.address = addresses_of(bound)[0]
        """The address at which the page is reached."""
        self._server = uvicorn.Server(
            uvicorn.Config(
                app,
                http=GuardedConnection,
                ws=GuardedSocket,
                # uvicorn's own set-up asks standard output whether it is a terminal, and that may
                # be closed.
                log_config=None,
                # Neither senseless requests nor addresses with tokens belong in the log.
                log_level="error",
                access_log=False,
                ws_max_size=MOST_BODY,
                # Loopback is fast, and compression would have to be done for each viewer.
                ws_per_message_deflate=False,
                ws_ping_interval=PING,
                ws_ping_timeout=PING,
                backlog=BACKLOG,
                timeout_graceful_shutdown=1,
                lifespan="on",
            )
        )
        self._thread: threading.Thread | None = None
        # An event, as an interrupted Thread.join makes Python take a running thread for ended.
        self._ended = threading.Event()
        self._broken: BaseException | None = None

    @property
    def connections(self) -> int:
        """How many connections there are."""
        return len(self._server.server_state.connections)

    def start(self) -> None:
        """Serve in a thread; returns when it answers. Raises ServerError when it does not."""
        self._thread = threading.Thread(target=self._serve, name="page", daemon=True)
        self._thread.start()
        for _ in range(int(_START / 0.02)):
            if self._server.started:
                return
            if self._ended.wait(0.02):
                break
        self._tell_if_broken()
        raise ServerError(f"expected the page to be served within {_START:g} s; it was not")

    def has_ended(self, within: float) -> bool:
        """Return whether it serves no more ``within`` s; raises ServerError when it broke."""
        has_ended = self._ended.wait(within)
        self._tell_if_broken()
        return has_ended

    def stop(self) -> None:
        """End the thread that serves."""
        self._server.should_exit = True
        # Ctrl-C may have interrupted the thread's start: it may not have run yet.
        if self._thread in threading.enumerate():
            self._ended.wait(_START)

    def _tell_if_broken(self) -> None:
        if self._broken is not None:
            raise ServerError(f"the page's server ended: {self._broken}") from self._broken

    def _serve(self) -> None:
        try:
            asyncio.run(self._server.serve(sockets=[self._socket]))
        except BaseException as error:  # SystemExit, too: it would silently end this thread alone
            self._broken = error
        finally:
            self._ended.set()
