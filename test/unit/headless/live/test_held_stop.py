"""The emergency stop of a live robot, with a robot that notes what it is told."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from roomba.client.protocol import RequestRefusedError
from roomba.headless.live.held_stop import HeldStop

Told = list[str]


def stop_of(robot: Told) -> HeldStop[Told]:
    """The stop of a robot that carries out commands at once."""

    def obey(command: Callable[[Told], None]) -> None:
        command(robot)

    def free(robot: Told) -> None:
        robot.append("free")

    return HeldStop(obey, Told.append, free)


def test_the_drive_is_held_with_the_reason_until_it_is_released() -> None:
    robot: Told = []
    stop = stop_of(robot)
    assert stop.reason == ""
    stop.engage(" child in the way ")
    assert (robot, stop.reason) == (["child in the way"], "child in the way")
    stop.engage(" ")
    assert (robot[1:], stop.reason) == (["no reason was given"], "no reason was given")
    stop.release()
    assert (robot[2:], stop.reason) == (["free"], "")


def test_one_that_was_kept_holds_the_robot_of_that_name_alone(tmp_path: Path) -> None:
    stop = stop_of([])
    stop.keep_in(tmp_path, "studio", [])
    stop.engage("smoke")
    robot: Told = []
    again = stop_of(robot)
    again.keep_in(tmp_path, "studio", robot)
    assert (robot, again.reason) == (["smoke"], "smoke")
    other = stop_of([])
    other.keep_in(tmp_path, "flat", [])
    assert other.reason == ""
    again.release()
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_refuses_is_told_and_changes_nothing(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"")
    robot: Told = []
    stop = stop_of(robot)
    stop.keep_in(file, "studio", robot)
    stop.engage("smoke")
    assert robot[0] == "smoke"
    assert robot[-1].startswith("smoke; but it is forgotten if the robot is killed, ")
    assert stop.reason == robot[-1]
    stop.release()
    assert (robot[-1], stop.reason) == ("free", "")


def test_what_is_kept_and_damaged_holds_and_frees_the_drive_all_the_same(tmp_path: Path) -> None:
    (tmp_path / "studio.txt").mkdir()
    robot: Told = []
    stop = stop_of(robot)
    stop.keep_in(tmp_path, "studio", robot)
    assert "it counts as held" in stop.reason
    with pytest.raises(RequestRefusedError, match="the drive is free; but it holds again"):
        stop.release()
    assert (robot[-1], stop.reason) == ("free", "")
