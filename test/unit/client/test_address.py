"""Addresses of pages, and whose programs are told this user's token."""

from __future__ import annotations

import os
import socket
from pathlib import Path

import pytest

from roomba.client.address import PageAddress, listeners_of, page_address, token_for
from roomba.errors import RoombaError

KEPT = "a-kept-token-of-this-user"


@pytest.fixture(autouse=True)
def _kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "token"
    file.touch(0o600)
    file.write_text(KEPT)
    monkeypatch.setenv("ROOMBA_TOKEN_FILE", str(file))


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("", PageAddress()),
        ("8401", PageAddress("127.0.0.1", 8401)),
        ("http://127.0.0.1:8400/#token=abc", PageAddress("127.0.0.1", 8400, "abc")),
        ("http://192.0.2.7:80", PageAddress("192.0.2.7", 80)),
    ],
)
def test_an_address_is_read_as_it_is_printed(text: str, address: PageAddress) -> None:
    assert page_address(text) == address


@pytest.mark.parametrize("text", ["0", "99999", "here", "http://here/", "http://here:x/", "::"])
def test_what_is_no_address_is_refused(text: str) -> None:
    with pytest.raises(RoombaError, match="expected a port up to 65535, or the address"):
        page_address(text)


def test_a_program_of_this_user_is_told_the_kept_token() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert listeners_of(port) == {os.geteuid()}
        assert token_for(PageAddress(port=port), port) == KEPT
        assert token_for(PageAddress("localhost", port), port) == KEPT
        assert token_for(PageAddress("127.0.0.1", port, "given"), port) == "given"
        assert token_for(PageAddress("192.0.2.7", port), port) == ""
    assert token_for(PageAddress(port=port), port) == ""


def test_a_program_of_another_user_is_told_none(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        other = os.geteuid() + 7
        for users in ({other}, {other, os.geteuid()}):
            monkeypatch.setattr("roomba.client.address.listeners_of", lambda _, them=users: them)
            assert token_for(PageAddress(port=port), port) == ""


def test_sockets_that_only_speak_or_cannot_be_read_are_no_listeners(tmp_path: Path) -> None:
    table = tmp_path / "tcp"
    row = "{}: 0100007F:20D0 00000000:0000 {} 00000000:00000000 00:00000000 00000000 {} 0 1\n"
    table.write_text(
        "head\n" + row.format(0, "01", 5) + row.format(1, "0A", 6) + row.format(2, "0A", 7)
    )
    assert listeners_of(0x20D0, table) == {6, 7}
    assert listeners_of(0x20D1, table) == set()
    assert listeners_of(0x20D0, tmp_path / "none") == set()
    table.write_text("head\nsomething else\n")
    assert listeners_of(0x20D0, table) == set()
