"""When a sweep was measured that the robot sends without a time."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.drivers.neato.sweeps import SweepClock

TURN = 0.25
"""s; of the lidar, as it is told."""


def errors(first_end: float, turn: float, questions: list[float]) -> list[float]:
    """Return by how much each sweep's end was told wrong, s; asked after these times, s."""
    clock, found, before, now = SweepClock(), [], -1, 0.0
    for passed in questions:
        now += passed
        number = math.floor((now - first_end) / turn)
        told = clock.ended(now, TURN, is_other=number != before)
        if told is not None:
            found.append(told - (first_end + number * turn))
        before = number
    return found


@given(st.floats(0.0, TURN), st.lists(st.floats(0.05, 0.12), min_size=60, max_size=60))
def test_asked_often_it_is_known_to_some_hundredths(phase: float, asked: list[float]) -> None:
    assert max(map(abs, errors(phase, TURN, asked)[-5:])) < 0.04


@given(st.floats(0.0, TURN), st.floats(0.996, 1.004))
def test_a_lidar_that_turns_a_little_faster_than_it_says_is_followed(
    phase: float, share: float
) -> None:
    asked = [0.08 + 0.03 * (i % 3) for i in range(400)]
    assert max(map(abs, errors(phase, share * TURN, asked)[-20:])) < 0.06


@given(st.floats(0.0, TURN))
def test_asked_seldom_it_is_known_to_a_turn_and_mostly_to_half_of_it(phase: float) -> None:
    found = np.abs(errors(phase, TURN, [0.61] * 50))
    assert found.max() <= TURN + 0.01
    assert np.median(found) <= 0.5 * TURN + 1e-6


def test_the_first_sweep_ended_within_the_last_turn() -> None:
    assert SweepClock().ended(10.0, TURN, is_other=True) == pytest.approx(10.0 - 0.5 * TURN)


def test_sweeps_that_all_look_the_same_are_told_once_a_turn() -> None:
    clock = SweepClock()
    told = [clock.ended(0.05 * i, TURN, is_other=i == 0) for i in range(100)]
    ends = [each for each in told if each is not None]
    assert len(ends) == pytest.approx(5.0 / TURN, abs=2)
    assert all(0.0 < later - end < 1.5 * TURN for end, later in pairwise(ends))
