"""The pace that a follower goes on with where no odometry tells it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from roomba.perception.slam.following import follow_kernels

BETWEEN_SCANS = 0.1
"""s."""


def pace_after(places: list[float], before: float) -> list[float]:
    """Return the pace ahead, m/s, after each of the places, m, at which scans put the robot."""
    learn: Any = getattr(follow_kernels._learn_pace, "py_func", follow_kernels._learn_pace)
    follower = SimpleNamespace(here=np.zeros(3), pace=np.array([before, 0.0, 0.0]))
    paces, last = [], 0.0
    for place in places:
        follower.here[0] = place
        learn(follower, last, 0.0, 0.0, BETWEEN_SCANS)
        paces.append(float(follower.pace[0]))
        last = place
    return paces


def test_it_is_how_fast_scans_show_that_the_robot_moves() -> None:
    steady = pace_after([0.05, 0.10, 0.15], 0.5)
    assert steady == pytest.approx([0.5, 0.5, 0.5])
    assert pace_after([0.01, 0.03, 0.06, 0.10], 0.0) == pytest.approx([0.1, 0.2, 0.3, 0.4])


def test_a_jump_along_a_corridor_is_no_pace() -> None:
    """What would be 10 m/s; the robot goes on about as before, and is not thrown back."""
    there, after = pace_after([1.0, 1.05], 0.5)
    assert there == pytest.approx(0.65)
    assert after == pytest.approx(0.5)
