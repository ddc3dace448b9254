"""The emergency stop of a live robot, with a robot that notes its commands."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

import pytest

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.headless.live import held_stop
from roomba.headless.live.held_stop import HeldStop
from roomba.storage.kept_stop import KeptStop

Told = list[str]


def free(robot: Told) -> None:
    robot.append("free")


def stop_of(robot: Told) -> HeldStop[Told]:
    """The stop of a robot that carries out commands at once."""
    return HeldStop(Thread(robot, is_busy=False).put, Told.append, free)


class Thread:
    """A robot's thread, which carries out commands unless it is busy."""

    def __init__(self, robot: Told, *, is_busy: bool) -> None:
        self.robot, self._is_busy = robot, is_busy
        self._waiting: list[tuple[Callable[[Told], None], Future[None]]] = []

    def put(self, command: Callable[[Told], None]) -> Future[None]:
        answer: Future[None] = Future()
        self._waiting.append((command, answer))
        if not self._is_busy:
            self.come_free()
        return answer

    def come_free(self) -> None:
        """Carry out what was put and not taken back, and each command from now on."""
        self._is_busy = False
        for command, answer in self._waiting:
            if answer.set_running_or_notify_cancel():
                command(self.robot)
                answer.set_result(None)
        self._waiting = []


@pytest.fixture
def busy(monkeypatch: pytest.MonkeyPatch) -> Thread:
    monkeypatch.setattr(held_stop, "ANSWER", 0.01)
    return Thread([], is_busy=True)


@pytest.fixture
def stop_of_busy(busy: Thread, tmp_path: Path) -> HeldStop[Told]:
    stop = HeldStop(busy.put, Told.append, free)
    stop.keep_in(tmp_path, "studio", busy.robot)
    return stop


def is_late(ask: Callable[[], None], told: str) -> None:
    with pytest.raises(RobotUnavailableError, match=rf"within 0\.01 s, got none; .*{told}"):
        ask()


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


def test_a_busy_robot_holds_as_soon_as_it_is_free_and_its_stop_is_kept_at_once(
    busy: Thread, stop_of_busy: HeldStop[Told], tmp_path: Path
) -> None:
    is_late(lambda: stop_of_busy.engage("child in the way"), "holds as soon as it answers")
    assert (busy.robot, stop_of_busy.reason) == ([], "")
    assert KeptStop(tmp_path, "studio").reason() == "child in the way"
    busy.come_free()
    assert (busy.robot, stop_of_busy.reason) == (["child in the way"], "child in the way")


def test_a_release_that_a_busy_robot_did_not_hear_is_taken_back(
    busy: Thread, stop_of_busy: HeldStop[Told], tmp_path: Path
) -> None:
    is_late(lambda: stop_of_busy.engage("child in the way"), "holds as soon")
    is_late(stop_of_busy.release, "may still hold")
    busy.come_free()
    assert stop_of_busy.reason == "child in the way"
    assert KeptStop(tmp_path, "studio").reason() == "child in the way"


def test_of_a_stop_and_a_release_the_one_that_was_asked_for_last_counts(
    busy: Thread, stop_of_busy: HeldStop[Told], tmp_path: Path
) -> None:
    is_late(lambda: stop_of_busy.engage("child in the way"), "holds as soon")
    is_late(lambda: stop_of_busy.engage("smoke"), "holds as soon")
    assert KeptStop(tmp_path, "studio").reason() == "smoke"
    busy.come_free()
    stop_of_busy.release()
    assert (busy.robot, stop_of_busy.reason) == (["child in the way", "smoke", "free"], "")
    assert KeptStop(tmp_path, "studio").reason() == ""
    stop_of_busy.engage("a cat")
    assert KeptStop(tmp_path, "studio").reason() == stop_of_busy.reason == "a cat"
