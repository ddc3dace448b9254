"""Requests to a bridge: where it is, and what comes of another program there."""

from __future__ import annotations

import pytest
from fixtures.bridges.openneato_mock import openneato_mock

from roomba.drivers.line import LineError
from roomba.drivers.neato.bridge_requests import BridgeAddress, MissingError, asked, told


@pytest.mark.parametrize(
    ("text", "host", "port"),
    [("neato.local", "neato.local", 80), ("192.168.1.5:8080", "192.168.1.5", 8080)],
)
def test_an_address_is_a_name_and_a_port(text: str, host: str, port: int) -> None:
    place = BridgeAddress.of(text)
    assert (place.host, place.port) == (host, port)
    assert str(place) == text


@pytest.mark.parametrize("text", ["", "/dev/ttyACM0", "http://neato.local", "neato:x", "a@b"])
def test_what_is_no_address_is_refused(text: str) -> None:
    with pytest.raises(LineError, match=r"such as neato\.local"):
        BridgeAddress.of(text)


def test_objects_of_json_are_told() -> None:
    with openneato_mock() as mock:
        place = BridgeAddress.of(mock.address)
        assert told(place, "/api/charger")["fuelPercent"] == 85
        mock.error = [1]
        with pytest.raises(LineError, match="expected an object of JSON at /api/error"):
            told(place, "/api/error")


def test_an_address_that_is_not_there_is_another_error() -> None:
    with openneato_mock() as mock:
        place = BridgeAddress.of(mock.address)
        with pytest.raises(MissingError, match="has no /api/nothing"):
            asked(place, "GET", "/api/nothing?a=b")
    with pytest.raises(LineError, match="Is the robot switched on") as caught:
        asked(place, "GET", "/api/state")
    assert not isinstance(caught.value, MissingError)
