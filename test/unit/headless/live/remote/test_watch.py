"""A robot is observed until the end, and it is reported when the observation fails."""

from __future__ import annotations

import threading
from collections.abc import Callable

import numpy as np
import pytest
from fixtures.waiting import wait_until
from numpy.typing import NDArray

from roomba.drivers.line import LineError
from roomba.headless.live.remote.watch import RemoteWatch
from roomba.robot.remote import RemoteState, RemoteWish
from roomba.vocabulary import Phase

DEADLINE = 20.0
"""s of wall time."""


class Seen:
    """A robot that is looked at by ``see``."""

    def __init__(self, see: Callable[[], RemoteState]) -> None:
        self.see = see

    def look(self) -> RemoteState:
        return self.see()

    def scan(self) -> NDArray[np.float32]:
        raise LineError("no scan")

    def tell(self, wish: RemoteWish) -> None:
        raise AssertionError


def state() -> RemoteState:
    return RemoteState(Phase.IDLE, 0.5, is_charging=False)


def nothing() -> None:
    """Do nothing before a look."""


def test_a_look_that_fails_in_an_unknown_way_is_told_as_the_end() -> None:
    def fail() -> RemoteState:
        raise OverflowError("too large")

    watch = RemoteWatch(Seen(fail), lambda: 0.0, nothing)
    assert watch.ending == ""
    watch.start()
    wait_until(lambda: "too large" in watch.ending, DEADLINE, lambda: watch.ending)
    watch.end()


def test_it_is_looked_at_until_the_end() -> None:
    watch = RemoteWatch(Seen(state), lambda: 0.0, nothing)
    assert watch.lost == "the robot was not asked yet"
    watch.start()
    wait_until(lambda: watch.state is not None, DEADLINE, "a look")
    assert (watch.ending, watch.lost, watch.moves) == ("", "", False)
    watch.end()
    assert watch.ending != ""


def test_what_was_told_long_ago_is_no_news() -> None:
    time, may_look, looks = [0.0], threading.Event(), list[int]()

    def see() -> RemoteState:
        looks.append(1)
        if len(looks) > 1:
            assert may_look.wait(DEADLINE)
        return state()

    watch = RemoteWatch(Seen(see), lambda: time[0], nothing)
    watch.start()
    wait_until(lambda: watch.state is not None, DEADLINE, "a look")
    watch.hurry()
    wait_until(lambda: len(looks) == 2, DEADLINE, "one more begins")
    time[0] = 9.0
    assert watch.lost == ""
    time[0] = 11.0
    assert watch.lost == "expected news of the robot within 10 s, got none"
    may_look.set()
    wait_until(lambda: watch.lost == "", DEADLINE, "it is told again")
    watch.end()


def test_what_fails_before_a_look_does_not_keep_it_from_being_looked_at() -> None:
    def fail() -> None:
        raise LineError("the stop is refused")

    watch = RemoteWatch(Seen(state), lambda: 0.0, fail)
    watch.start()
    wait_until(lambda: watch.state is not None, DEADLINE, "a look")
    assert watch.lost == ""
    watch.end()


@pytest.mark.parametrize("phase", [Phase.CLEANING, Phase.RETURNING])
def test_a_robot_that_moves_and_tells_no_scan_is_not_lost(phase: Phase) -> None:
    watch = RemoteWatch(
        Seen(lambda: RemoteState(phase, 0.5, is_charging=False)), lambda: 0.0, nothing
    )
    watch.start()
    wait_until(lambda: watch.state is not None, DEADLINE, "a look")
    watch.hurry()
    wait_until(lambda: watch.scan_trouble == "no scan", DEADLINE, "a scan")
    assert (watch.lost, watch.moves, len(watch.scan)) == ("", True, 0)
    watch.end()
