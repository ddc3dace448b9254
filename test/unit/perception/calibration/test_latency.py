"""How late scans are is learned from the robot's turns."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from roomba.perception.calibration.latency import learn_latency, no_latency
from roomba.perception.matching.reckoned_path import ReckonedPath, remember


def heading(time: float) -> float:
    """A robot that turns to and fro, rad."""
    return 0.8 * math.sin(1.3 * time) + 0.3 * math.sin(4.1 * time)


class Scans:
    """Scans that come each 0.1 s, and odometry each 0.02 s, or with each n-th scan alone."""

    def __init__(self, seldom: int = 0) -> None:
        self.seldom, self.count = seldom, 0
        self.path, self.latency, self.now = ReckonedPath.empty(), no_latency(), 10.0

    def come(self, turn: float, heading: Callable[[float], float] = heading) -> None:
        """Let 0.1 s pass; the scan then is turned by so much against the one before, rad."""
        self.count += 1
        for step in range(5):
            self.now += 0.02
            is_told = self.count % self.seldom == step == 0 if self.seldom else True
            if is_told:
                remember(self.path, self.now, np.array([0.0, 0.0, heading(self.now)]))
        learn_latency(self.latency, turn, self.now, self.path)

    @property
    def seconds(self) -> float:
        return float(self.latency[0]["seconds"])


def learned(late: float, seconds: float = 30.0, *, error: float = 0.0) -> float:
    """What is learned of scans that show the robot as it was ``late`` s before."""
    scans = Scans()
    for index in range(int(seconds / 0.1)):
        then = scans.now + 0.1 - late
        scans.come(heading(then) - heading(then - 0.1) + error * (-1) ** index)
    return scans.seconds


@pytest.mark.parametrize("late", [0.05, 0.1, 0.15, 0.3, 0.4])
def test_late_scans_are_noticed(late: float) -> None:
    assert learned(late) == pytest.approx(late, abs=1e-9)


@pytest.mark.parametrize("error", [0.0, 0.01, 0.05])
def test_scans_in_time_are_left_as_they_are(error: float) -> None:
    assert learned(0.0, error=error) == 0.0


def test_a_robot_that_does_not_turn_says_nothing() -> None:
    scans = Scans()
    for _ in range(300):
        scans.come(0.001, lambda now: 0.0)
    assert scans.seconds == 0.0


def test_what_is_not_known_is_left_out() -> None:
    """Of half of the turns it is not known how far they were; the others are as if in time."""
    scans = Scans()
    for index in range(600):
        then = scans.now + 0.1 - 0.2
        scans.come(math.nan if index % 2 else heading(then) - heading(then - 0.1))
    assert scans.seconds == pytest.approx(0.2, abs=1e-9)


def test_odometry_that_is_told_seldom_says_nothing() -> None:
    """Between two of its poses nothing tells when the robot turned."""
    scans = Scans(seldom=10)
    for _ in range(600):
        then = scans.now + 0.1
        scans.come(heading(then) - heading(then - 0.1))
    assert (scans.seconds, float(scans.latency[0]["turned"])) == (0.0, 0.0)


def test_without_odometry_of_that_time_nothing_is_learned() -> None:
    latency, path = no_latency(), ReckonedPath.empty()
    for index in range(300):
        learn_latency(latency, 0.1, 0.1 * index, path)
    assert (latency[0]["seconds"], latency[0]["turned"]) == (0.0, 0.0)


def test_what_is_believed_does_not_change_to_and_fro() -> None:
    """Scans that are 30 ms late lie between two latencies that are compared."""
    scans, seen = Scans(), []
    random = np.random.default_rng(3)
    for _ in range(900):
        then = scans.now + 0.1 - 0.03
        scans.come(heading(then) - heading(then - 0.1) + random.normal(0.0, 0.01))
        seen.append(scans.seconds)
    assert np.count_nonzero(np.diff(seen[100:])) <= 1
