"""Work in the background: the newest of each kind; what the disk refuses is told and retried."""

import errno
import threading
from collections.abc import Callable
from functools import partial

import pytest
import rospy
from fixtures.waiting import wait_until

from roomba_ros.runtime import background as module
from roomba_ros.runtime.background import Background

FULL = OSError(errno.ENOSPC, "No space left on device")


class Disk:
    """Refuses, or keeps, what is written."""

    def __init__(self) -> None:
        self.is_full = True
        self.tries = 0
        self.kept: list[str] = []

    def write(self, text: str) -> Callable[[], None]:
        def work() -> None:
            self.tries += 1
            if self.is_full:
                raise FULL
            self.kept.append(text)

        return work


@pytest.fixture
def lines(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What is logged."""
    found: list[str] = []

    def log(text: str, *values: object) -> None:
        found.append(text % values)

    for level in ("logwarn", "logerr"):
        monkeypatch.setattr(rospy, level, log)
    monkeypatch.setattr(module, "RETRY", 0.02)
    return found


def test_of_each_kind_the_newest_is_done_in_order() -> None:
    done: list[str] = []
    background = Background()
    for name, text in (("a", "a 1"), ("b", "b 1"), ("a", "a 2"), ("c", "c 1"), ("b", "b 2")):
        background.do(name, partial(done.append, text))
    background.work_off()
    assert done == ["a 2", "c 1", "b 2"]
    assert background.wait(0.0)


def test_what_the_disk_refuses_is_told_once_and_done_when_there_is_room(lines: list[str]) -> None:
    background, disk = Background(), Disk()
    background.start()
    background.do("no map is kept", disk.write("map"))
    wait_until(lambda: disk.tries > 5, 10.0, "it is tried again")
    assert background.trouble == "no map is kept: [Errno 28] No space left on device"
    disk.is_full = False
    wait_until(lambda: disk.kept == ["map"], 10.0, "it is kept")
    wait_until(lambda: background.trouble == "", 10.0, "all is well")
    assert lines == [
        "no map is kept: [Errno 28] No space left on device; it is tried again",
        "this is over: no map is kept",
    ]


def test_newer_work_takes_the_place_of_what_was_refused(lines: list[str]) -> None:
    background, disk = Background(), Disk()
    background.start()
    background.do("no map is kept", disk.write("old"))
    wait_until(lambda: disk.tries > 1, 10.0, "it is tried again")
    background.do("no map is kept", disk.write("new"))
    background.do("other work", lambda: None)
    disk.is_full = False
    wait_until(lambda: disk.kept, 10.0, "it is kept")
    wait_until(lambda: background.trouble == "", 10.0, "all is well")
    assert disk.kept[-1] == "new"
    assert len(lines) == 2


def test_other_faults_are_told_and_not_tried_again(lines: list[str]) -> None:
    background, tries = Background(), [0]

    def work() -> None:
        tries[0] += 1
        raise ValueError("no such thing")

    background.do("no plan is shown", work)
    background.work_off()
    assert (lines, tries, background.trouble) == (["no plan is shown: no such thing"], [1], "")


def test_what_is_forgotten_does_not_come_back_when_there_is_room(lines: list[str]) -> None:
    background, disk, kept = Background(), Disk(), ["errand"]
    background.start()
    background.do("it is not kept", disk.write("errand"), subject="errand")
    wait_until(lambda: disk.tries > 1, 10.0, "it is tried again")
    background.do("it is not forgotten", kept.clear, subject="errand")
    wait_until(lambda: not kept, 10.0, "it is forgotten")
    wait_until(lambda: background.trouble == "", 10.0, "nothing is left to be tried again")
    disk.is_full = False
    assert background.wait(10.0)
    assert disk.kept == []


@pytest.mark.parametrize("error", [MemoryError, ValueError])
def test_work_that_was_refused_and_then_fails_is_given_up(
    lines: list[str], error: type[Exception]
) -> None:
    tries = list[Exception]([FULL, error("no such thing")])

    def work() -> None:
        raise tries.pop(0)

    background = Background()
    background.start()
    background.do("no map is kept", work)
    wait_until(lambda: not tries, 10.0, "it is tried again")
    wait_until(lambda: background.trouble == "", 10.0, "it is given up")
    assert background.wait(10.0)
    assert len(lines) == 2


@pytest.mark.parametrize("error", [MemoryError, ZeroDivisionError])
def test_a_fault_of_the_program_is_told_and_ends_no_other_work(
    lines: list[str], error: type[Exception]
) -> None:
    def fail() -> None:
        raise error

    background, done = Background(), threading.Event()
    background.start()
    background.do("no plan is shown", fail)
    background.do("other work", done.set)
    assert done.wait(10.0)
    (line,) = lines
    assert line.startswith("no plan is shown: Traceback")
    assert error.__name__ in line


def test_one_that_waits_is_woken(lines: list[str]) -> None:
    background, done = Background(), threading.Event()
    background.start()
    background.do("nothing", done.set)
    assert done.wait(10.0)
    assert lines == []
