"""The emergency stop on the disk: kept until it is released, and held when in doubt."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from roomba.files import kept
from roomba.files.kept import sealed
from roomba.storage import kept_stop
from roomba.storage.kept_stop import FOLDER, KeptStop


def stopped(folder: Path, reason: str) -> KeptStop:
    """Return a stop that was kept for a reason."""
    stop = KeptStop(folder, "robot")
    assert stop.keep(lambda: reason) == ""
    return stop


def test_it_is_kept_until_it_is_released(tmp_path: Path) -> None:
    folder = tmp_path / FOLDER
    assert FOLDER == "emergency_stop"
    assert KeptStop(folder, "robot").reason() == ""
    stop = stopped(folder, "child in the way")
    assert (folder / "robot.txt").read_bytes() == sealed(b"child in the way")
    assert KeptStop(folder, "robot").reason() == "child in the way"
    assert stop.keep(lambda: "smoke") == ""
    assert KeptStop(folder, "robot").reason() == "smoke"
    assert stop.keep(lambda: "") == ""
    assert KeptStop(folder, "robot").reason() == ""
    assert list(folder.iterdir()) == []
    assert stop.keep(lambda: "") == ""


def test_robots_have_their_own(tmp_path: Path) -> None:
    stopped(tmp_path, "smoke")
    for other in ("other", "home/robot"):
        assert KeptStop(tmp_path, other).reason() == ""
    inner = KeptStop(tmp_path, "home/robot")
    assert inner.keep(lambda: "fire") == ""
    assert inner.reason() == "fire"


@pytest.mark.parametrize(
    ("content", "trouble"),
    [
        (b"", "damaged: expected a reason, got none"),
        (sealed(b" \n"), "damaged: expected a reason, got none"),
        (sealed(b"smoke")[:-1], "expected what its checksum says"),
        (sealed(b"smoke", 2), "expected version 1 or older, got 2"),
        (b"\xff", "can't decode byte 0xff"),
        (10_001 * b"a", "expected at most 10000 bytes, got 10001"),
    ],
)
def test_one_that_is_damaged_holds_and_says_so(
    tmp_path: Path, content: bytes, trouble: str
) -> None:
    path = tmp_path / "robot.txt"
    path.write_bytes(content)
    stop = KeptStop(tmp_path, "robot")
    for _ in range(2):
        assert stop.reason().startswith(f"it counts as held, as {path} is damaged: ")
        assert trouble in stop.reason()
    assert stop.keep(lambda: "") == ""
    assert KeptStop(tmp_path, "robot").reason() == ""


def test_one_that_cannot_be_read_holds(tmp_path: Path) -> None:
    (tmp_path / "robot.txt").mkdir()
    assert "is damaged" in KeptStop(tmp_path, "robot").reason()


def test_one_that_a_person_wrote_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "robot.txt").write_bytes("  für\n  immer ".encode())
    assert KeptStop(tmp_path, "robot").reason() == "für immer"


@pytest.mark.parametrize(
    ("reason", "found"),
    [(501 * "a", 500 * "a"), ("\udcff", "?"), (500 * "\U0001f9f9", 500 * "\U0001f9f9")],
)
def test_no_reason_is_too_long_or_too_odd(tmp_path: Path, reason: str, found: str) -> None:
    assert stopped(tmp_path, reason).reason() == found


def test_a_disk_that_refuses_is_told_and_nothing_there_holds_nothing(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"")
    stop = KeptStop(file, "robot")
    told = stop.keep(lambda: "smoke")
    assert told.startswith("it is forgotten if the robot is killed, as the disk refused: ")
    assert os.strerror(20) in told
    assert stop.reason() == ""
    assert stop.keep(lambda: "") == ""


def test_one_that_cannot_be_removed_is_told_and_holds_again(tmp_path: Path) -> None:
    (tmp_path / "robot.txt").mkdir()
    stop = KeptStop(tmp_path, "robot")
    told = stop.keep(lambda: "")
    assert told.startswith("it holds again if the robot is killed, as the disk refused: ")
    assert stop.reason()


def test_a_link_that_leads_nowhere_is_removed(tmp_path: Path) -> None:
    (tmp_path / "robot.txt").symlink_to(tmp_path / "none")
    assert KeptStop(tmp_path, "robot").keep(lambda: "") == ""
    assert list(tmp_path.iterdir()) == []


def test_of_changes_at_once_the_newest_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While the disk is slow to keep the stop, it is released: the file is gone in the end."""
    state = ["smoke"]
    writes, may_write = threading.Event(), threading.Event()
    write = kept.write_kept

    def slow(path: Path, content: bytes) -> None:
        writes.set()
        assert may_write.wait(10.0)
        write(path, content)

    monkeypatch.setattr(kept_stop, "write_kept", slow)
    stop = KeptStop(tmp_path, "robot")
    engaging = threading.Thread(target=stop.keep, args=(lambda: state[0],))
    engaging.start()
    assert writes.wait(10.0)
    state[0] = ""
    releasing = threading.Thread(target=stop.keep, args=(lambda: state[0],))
    releasing.start()
    releasing.join(0.1)
    assert releasing.is_alive()
    may_write.set()
    for thread in (engaging, releasing):
        thread.join(10.0)
    assert stop.reason() == ""
