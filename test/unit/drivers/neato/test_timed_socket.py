"""A connection is of use until its deadline, also where bytes come all the time."""

from __future__ import annotations

import socket
import time

import pytest

from roomba.drivers.neato.timed_socket import connected


def port_of(server: socket.socket) -> int:
    return int(server.getsockname()[1])


def test_what_comes_in_time_is_received() -> None:
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        connected("127.0.0.1", port_of(server), time.monotonic() + 10.0) as line,
        server.accept()[0] as other,
    ):
        line.sendall(b"ask")
        assert other.recv(10) == b"ask"
        other.sendall(b"answer")
        assert line.makefile("rb").read(6) == b"answer"


def test_after_the_deadline_nothing_is_sent_received_or_connected() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = port_of(server)
        with connected("127.0.0.1", port, time.monotonic() + 10.0) as line:
            line.deadline = time.monotonic() - 1.0
            with pytest.raises(TimeoutError):
                line.sendall(b"ask")
            with pytest.raises(TimeoutError):
                line.recv_into(bytearray(1))
        with pytest.raises(TimeoutError):
            connected("127.0.0.1", port, time.monotonic() - 1.0)


def test_an_address_that_refuses_gives_way_to_the_next(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        place = server.getsockname()
        kind = socket.AF_INET, socket.SOCK_STREAM, 0, ""
        found = [(*kind, ("127.0.0.2", place[1])), (*kind, place)]
        monkeypatch.setattr(socket, "getaddrinfo", lambda *_, **__: found)
        with connected("neato.local", place[1], time.monotonic() + 10.0) as line:
            assert line.getpeername() == place
        monkeypatch.setattr(socket, "getaddrinfo", lambda *_, **__: found[:1])
        with pytest.raises(ConnectionRefusedError):
            connected("neato.local", place[1], time.monotonic() + 10.0)
