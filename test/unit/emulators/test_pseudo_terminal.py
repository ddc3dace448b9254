"""The line of an emulator, and the name that it is found by."""

import contextlib
import os
from pathlib import Path

import pytest

from roomba.emulators.pseudo_terminal import PseudoTerminal
from roomba.errors import RoombaError


def test_the_link_of_a_later_line_outlives_the_one_before(tmp_path: Path) -> None:
    link = tmp_path / "neato"
    before = PseudoTerminal(link)
    with contextlib.closing(PseudoTerminal(link)) as later:
        before.close()
        assert os.readlink(link) == later.name
    assert not link.is_symlink()


def test_a_link_to_something_else_is_not_replaced(tmp_path: Path) -> None:
    link = tmp_path / "by_id"
    link.symlink_to(os.devnull)
    with pytest.raises(RoombaError, match="a file is there"):
        PseudoTerminal(link)
    assert os.readlink(link) == os.devnull
