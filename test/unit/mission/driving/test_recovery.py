"""Attempts to get free: each ends, each differs, and it is noticed whether they helped."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.mission import DrivingConfig
from roomba.geometry import Pose, Twist
from roomba.mission.driving.recovery import Recovery
from roomba.mission.inputs.senses import Senses

CONFIG = DrivingConfig()
TICK = 0.05


def twists(number: int, began: float = 0.0) -> list[Twist]:
    """Return all that an attempt wants."""
    recovery = Recovery(number, CONFIG, Senses(began, Pose()))
    made: list[Twist] = []
    for tick in range(1000):
        twist = recovery.tick(Senses(began + tick * TICK, Pose()))
        if twist is None:
            return made
        made.append(twist)
    raise AssertionError("no end")


@given(st.integers(1, 50), st.floats(-1e6, 1e6))
def test_each_attempt_ends_and_is_careful(number: int, began: float) -> None:
    made = twists(number, began)
    assert 1.0 < len(made) * TICK < 8.0
    assert all(twist.is_finite for twist in made)
    assert max(abs(twist.linear) for twist in made) == pytest.approx(CONFIG.backing_speed)
    assert max(abs(twist.angular) for twist in made) <= 2.0
    assert any(twist.angular != 0.0 for twist in made)


def test_the_first_backs_off_before_anything_else() -> None:
    assert twists(1)[0] == Twist(-CONFIG.backing_speed, 0.0)


def test_one_after_the_other_they_try_something_else() -> None:
    attempts = [twists(number) for number in range(1, 6)]
    for index, one in enumerate(attempts):
        assert one not in attempts[:index]
    everything = [twist for attempt in attempts for twist in attempt]
    assert min(twist.linear for twist in everything) < 0.0 < max(t.linear for t in everything)
    assert min(twist.angular for twist in everything) < 0.0 < max(t.angular for t in everything)


def test_a_clock_that_is_set_back_ends_it() -> None:
    recovery = Recovery(1, CONFIG, Senses(100.0, Pose()))
    assert recovery.tick(Senses(100.5, Pose())) is not None
    assert recovery.tick(Senses(50.0, Pose())) is None


@pytest.mark.parametrize(
    ("pose", "expected"),
    [
        (Pose(1.0, 2.0, 3.1), False),
        (Pose(1.02, 2.0, 3.1), False),
        (Pose(1.05, 2.0, 3.1), True),
        (Pose(1.0, 1.95, 3.1), True),
        (Pose(1.0, 2.0, 3.1 - math.tau + 0.2), False),
        (Pose(1.0, 2.0, -2.6), True),
        (Pose(1.0, 2.0, 2.6), True),
    ],
)
def test_whether_it_moved_is_told(pose: Pose, expected: bool) -> None:
    recovery = Recovery(1, CONFIG, Senses(0.0, Pose(1.0, 2.0, 3.1)))
    assert recovery.moved(Senses(1.0, pose)) is expected
