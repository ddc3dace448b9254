"""The line of an emulator, and the name that it is found by."""

import contextlib
import os
from pathlib import Path

import pytest

from roomba.emulators.pseudo_terminal import PseudoTerminal
from roomba.errors import RoombaError

DEAD_LINE = "/dev/pts/999999999"


def test_a_link_that_leads_elsewhere_by_now_is_not_removed(tmp_path: Path) -> None:
    link = tmp_path / "neato"
    terminal = PseudoTerminal(link)
    link.unlink()
    link.symlink_to(DEAD_LINE)
    terminal.close()
    assert os.readlink(link) == DEAD_LINE


def test_what_a_killed_emulator_left_is_replaced(tmp_path: Path) -> None:
    link = tmp_path / "neato"
    link.symlink_to(DEAD_LINE)
    with contextlib.closing(PseudoTerminal(link)) as terminal:
        assert os.readlink(link) == terminal.name
    assert not link.is_symlink()


@pytest.mark.parametrize("target", [os.devnull, "/dev/serial/by-id/unplugged", "a line in use"])
def test_a_link_to_anything_else_is_not_replaced(tmp_path: Path, target: str) -> None:
    link = tmp_path / "by_id"
    with contextlib.closing(PseudoTerminal()) as other:
        leads_to = other.name if target == "a line in use" else target
        link.symlink_to(leads_to)
        with pytest.raises(RoombaError, match=f"a link to {leads_to} is there; end the program"):
            PseudoTerminal(link)
        assert os.readlink(link) == leads_to


def test_a_file_is_not_replaced(tmp_path: Path) -> None:
    file = tmp_path / "line"
    file.touch()
    with pytest.raises(RoombaError, match="a file is there"):
        PseudoTerminal(file)
    assert file.is_file()
