"""The token's file: its owner's alone, and the same after a start anew."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from roomba.client.token import read_token, token_file
from roomba.ui.web.kept_token import kept_token


def test_it_is_long_readable_by_its_owner_alone_and_stays(tmp_path: Path) -> None:
    file = tmp_path / "state" / "token"
    token = kept_token(file)
    assert len(token) * 6 >= 128
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert stat.S_IMODE(file.parent.stat().st_mode) == 0o700
    assert kept_token(file) == token == read_token(file)


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o620, 0o666])
def test_one_that_others_can_read_or_write_is_replaced(tmp_path: Path, mode: int) -> None:
    file = tmp_path / "token"
    token = kept_token(file)
    file.chmod(mode)
    assert read_token(file) is None
    assert kept_token(file) != token
    assert stat.S_IMODE(file.stat().st_mode) == 0o600


@pytest.mark.parametrize("text", ["", "short", "x" * 21, "with space " * 4, "é" * 30, "x" * 500])
def test_what_is_no_token_is_replaced(tmp_path: Path, text: str) -> None:
    file = tmp_path / "token"
    file.write_text(text, encoding="utf-8")
    file.chmod(0o600)
    assert read_token(file) is None
    assert read_token(file) is None
    assert kept_token(file) == read_token(file) is not None


def test_links_and_pipes_are_not_followed(tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    kept_token(elsewhere)
    before = elsewhere.read_bytes()
    link, pipe = tmp_path / "link", tmp_path / "pipe"
    link.symlink_to(elsewhere)
    os.mkfifo(pipe, 0o600)
    for file in (link, pipe):
        assert read_token(file) is None
        assert kept_token(file) == read_token(file)
    assert elsewhere.read_bytes() == before
    assert not link.is_symlink()


def test_without_a_place_for_it_there_is_one_for_this_server(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    first, second = (kept_token(tmp_path / "file" / "token") for _ in range(2))
    assert len(first) >= 22
    assert first != second


def test_where_it_is(tmp_path: Path) -> None:
    assert token_file({"ROOMBA_TOKEN_FILE": "/a/b"}) == Path("/a/b")
    assert token_file({"XDG_STATE_HOME": "/a"}) == Path("/a/roomba_robot/token")
    assert token_file({"ROS_HOME": "/b", "XDG_STATE_HOME": "/a"}) == Path("/b/roomba_robot/token")
    assert token_file({"ROOMBA_TOKEN_FILE": "relative"}).name == "token"
