"""Requests to a bridge: where it is, and what comes of another program there."""

from __future__ import annotations

import socket
import threading
import time

import pytest
from fixtures.bridges.openneato_mock import openneato_mock

from roomba.drivers.line import LineError
from roomba.drivers.neato.bridge_requests import BridgeAddress, MissingError, json_at, request


@pytest.mark.parametrize(
    ("text", "host", "port"),
    [("neato.local", "neato.local", 80), ("192.168.1.5:8080", "192.168.1.5", 8080)],
)
def test_an_address_is_a_name_and_a_port(text: str, host: str, port: int) -> None:
    place = BridgeAddress.of(text)
    assert (place.host, place.port) == (host, port)
    assert str(place) == text


@pytest.mark.parametrize(
    "text",
    [
        "",
        "/dev/ttyACM0",
        "http://neato.local",
        "neato:x",
        "a@b",
        "neato..local",
        f"{64 * 'a'}.local",
        "neato\udc80.local",
    ],
)
def test_what_is_no_address_is_refused(text: str) -> None:
    with pytest.raises(LineError, match=r"such as neato\.local"):
        BridgeAddress.of(text)


def test_objects_of_json_are_told() -> None:
    with openneato_mock() as mock:
        place = BridgeAddress.of(mock.address)
        assert json_at(place, "/api/charger")["fuelPercent"] == 85
        mock.error = [1]
        with pytest.raises(LineError, match="expected an object of JSON at /api/error"):
            json_at(place, "/api/error")


def test_an_address_that_is_not_there_is_another_error() -> None:
    with openneato_mock() as mock:
        place = BridgeAddress.of(mock.address)
        with pytest.raises(MissingError, match="has no /api/nothing"):
            request(place, "GET", "/api/nothing?a=b")
    with pytest.raises(LineError, match="Is the robot switched on") as caught:
        request(place, "GET", "/api/state")
    assert not isinstance(caught.value, MissingError)


def test_json_that_nests_deeply_or_is_not_finite_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    deep = 100_000 * "["
    with openneato_mock() as mock:
        place = BridgeAddress.of(mock.address)
        for text in (deep, '{"a": NaN}', '{"a": 1e999}', "\xff"):
            monkeypatch.setattr(mock, "text", text)
            with pytest.raises(LineError, match="expected an object of JSON"):
                json_at(place, "/api/state")
        monkeypatch.setattr(mock, "has_faults", True)
        with pytest.raises(LineError, match="no reason is told"):
            request(place, "POST", "/api/clean?action=house")


def test_an_answer_that_comes_byte_by_byte_ends_at_the_deadline(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("roomba.drivers.neato.bridge_requests._DEADLINE", 0.3)
    is_over = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as server:

        def drip() -> None:
            connection, _ = server.accept()
            with connection:
                connection.sendall(b"HTTP/1.1 200 OK\r\nContent-Length: 1000\r\n\r\n")
                for _ in range(100):
                    if is_over.wait(0.05):
                        return
                    connection.sendall(b"1")

        thread = threading.Thread(target=drip)
        thread.start()
        began = time.monotonic()
        with pytest.raises(LineError, match="timed out"):
            request(BridgeAddress("127.0.0.1", server.getsockname()[1]), "GET", "/api/state")
        assert time.monotonic() - began < 2.0
        is_over.set()
        thread.join(5.0)
