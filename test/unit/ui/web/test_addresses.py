"""From where a page is reached, and by which addresses."""

from __future__ import annotations

import json
import socket
import urllib.error
import urllib.request

import pytest
from fixtures.households.written_robot import WrittenRobot

from roomba.client.address import outside_address
from roomba.ui.web.addresses import ALL, addresses_of, guard_for, hosts_of, is_host
from roomba.ui.web.app import create_app
from roomba.ui.web.server import PageServer, listen

NUMBER = "127.0.0.9"
"""Of this machine as well, and not how its page is called by default."""


@pytest.mark.parametrize(
    ("text", "is_one"),
    [("127.0.0.1", True), (ALL, True), ("home.example", False), ("1.2.3", False), ("::1", False)],
)
def test_a_host_is_an_address_in_numbers(text: str, is_one: bool) -> None:
    assert is_host(text) is is_one


def test_on_loopback_no_other_name_counts() -> None:
    guard = guard_for("t", "127.0.0.1")
    assert guard.is_host("localhost:8400")
    assert not guard.is_host("192.0.2.7:8400")
    assert not guard.is_host(f"{socket.gethostname()}x")
    assert hosts_of("127.0.0.1") == ["127.0.0.1"]
    assert guard_for("t", NUMBER).is_host(NUMBER)


def test_opened_to_the_network_it_is_called_by_the_machine_s_name_too() -> None:
    guard = guard_for("t", ALL)
    name = socket.gethostname()
    assert guard.is_host(f"{name}:8400")
    assert guard.is_host(f"{name}.local")
    assert not guard.is_host("evil.example:8400")
    assert hosts_of(ALL) == ["127.0.0.1", outside_address() or name]
    assert hosts_of(ALL, "192.0.2.7") == ["127.0.0.1", "192.0.2.7"]


def test_without_a_network_there_is_no_outside_address(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(socket, "socket", lambda *_: _Unconnected())
    assert outside_address() == ""


class _Unconnected:
    def __enter__(self) -> _Unconnected:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def connect(self, _: object) -> None:
        raise OSError("Network is unreachable")


def status_of(address: str, path: str, **headers: str) -> int:
    request = urllib.request.Request(address.partition("#")[0] + path, headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=10.0) as answer:
            json.load(answer)
            return int(answer.status)
    except urllib.error.HTTPError as refusal:
        return refusal.code


@pytest.mark.parametrize("host", ["127.0.0.1", NUMBER])
def test_a_page_answers_at_each_address_that_is_printed(host: str) -> None:
    bound = listen(host, 0, is_fixed=True)
    server = PageServer(create_app(WrittenRobot(), guard_for("t", host)), bound)
    server.start()
    try:
        (address,) = addresses_of(bound, "t")
        assert address == f"{server.address}#token=t"
        assert status_of(address, "api/v1/state") == 200
        assert status_of(address, "api/v1/state", Host="evil.example") == 421
        assert status_of(address, "api/v1/state", Origin="http://evil.example") == 403
    finally:
        server.stop()
