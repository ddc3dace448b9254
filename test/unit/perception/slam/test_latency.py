"""How late scans are is learned from the robot's turns."""

from __future__ import annotations

import math

import pytest

from roomba.geometry import Pose
from roomba.perception.slam.latency import Latency


def heading(time: float) -> float:
    """A robot that turns to and fro, rad."""
    return 0.8 * math.sin(1.3 * time) + 0.3 * math.sin(4.1 * time)


def learned(late: float, seconds: float = 30.0, *, error: float = 0.0) -> float:
    """What is learned of scans that come each 0.1 s and show the robot ``late`` s before."""
    latency = Latency()
    for index in range(int(seconds / 0.1)):
        now = 10.0 + 0.1 * index
        turn = heading(now - late) - heading(now - 0.1 - late) + error * (-1) ** index
        latency.learn(turn, now, lambda time: Pose(0.0, 0.0, heading(time)))
    return latency.seconds


@pytest.mark.parametrize("late", [0.05, 0.1, 0.15, 0.3, 0.4])
def test_late_scans_are_noticed(late: float) -> None:
    assert learned(late) == pytest.approx(late, abs=1e-9)


@pytest.mark.parametrize("error", [0.0, 0.01, 0.05])
def test_scans_in_time_are_left_as_they_are(error: float) -> None:
    assert learned(0.0, error=error) == 0.0


def test_a_robot_that_does_not_turn_says_nothing() -> None:
    latency = Latency()
    for index in range(300):
        latency.learn(0.001, 0.1 * index, lambda time: Pose(time, 0.0, 0.0))
    assert latency.seconds == 0.0


def test_what_is_not_known_is_left_out() -> None:
    latency = Latency()
    for index in range(300):
        latency.learn(0.1, 0.1 * index, lambda time: None)
    latency.interrupted()
    assert latency.seconds == 0.0
