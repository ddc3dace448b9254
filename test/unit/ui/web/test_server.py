"""Ports, and the life of the server."""

from __future__ import annotations

import socket
import urllib.request

import pytest
from fastapi import FastAPI

from roomba.ui.web.server import PageServer, ServerError, listen


def taken_port() -> tuple[socket.socket, int]:
    taken = socket.socket()
    taken.bind(("127.0.0.1", 0))
    taken.listen()
    return taken, taken.getsockname()[1]


def test_the_next_free_port_is_taken() -> None:
    taken, port = taken_port()
    with taken, listen("127.0.0.1", port, is_fixed=False) as bound:
        assert port < bound.getsockname()[1] < port + 20


def test_a_port_that_was_asked_for_and_is_not_free_is_refused() -> None:
    taken, port = taken_port()
    with taken, pytest.raises(ServerError, match=f"port {port}.*--port"):
        listen("127.0.0.1", port, is_fixed=True)


def test_who_comes_before_it_serves_waits_and_is_answered() -> None:
    app = FastAPI()

    @app.get("/")
    def hello() -> str:
        return "hello"

    with listen("127.0.0.1", 0, is_fixed=True) as bound:
        early = socket.create_connection(bound.getsockname(), timeout=5.0)
        server = PageServer(app, bound)
        server.start()
        with early:
            early.sendall(b"GET / HTTP/1.0\r\nHost: localhost\r\n\r\n")
            assert early.recv(100).startswith(b"HTTP/1.1 200")
        server.stop()


def test_it_answers_at_its_address_until_it_is_stopped() -> None:
    app = FastAPI()

    @app.get("/")
    def hello() -> str:
        return "hello"

    server = PageServer(app, listen("127.0.0.1", 0, is_fixed=True))
    server.start()
    with urllib.request.urlopen(server.address, timeout=5.0) as answer:
        assert answer.read() == b'"hello"'
    server.stop()
    with pytest.raises(OSError, match="refused"):
        urllib.request.urlopen(server.address, timeout=5.0)


def test_an_address_of_another_machine_is_refused() -> None:
    with pytest.raises(ServerError, match="an address of this machine, got 203"):
        listen("203.0.113.9", 0, is_fixed=True)


def test_it_serves_without_a_standard_output(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdout", None)  # as a shell closes it by >&-
    with listen("127.0.0.1", 0, is_fixed=True) as bound:
        server = PageServer(FastAPI(), bound)
        server.start()
        server.stop()
