"""How far a drive came: along its path, by legs, and by what is left of a turn on the spot."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from roomba.mission.driving.progress_kernels import PROGRESS, Rows, is_held

TIMEOUT, LEAST, LEAST_TURN = 5.0, 0.02, 0.2


def progress() -> Rows:
    rows = np.zeros(1, PROGRESS)
    rows["timeout"], rows["least"], rows["least_turn"] = TIMEOUT, LEAST, LEAST_TURN
    rows["leaves_trouble"], rows["to_turn"] = 0.5, math.inf
    return rows


def test_it_is_held_when_it_comes_no_farther_for_too_long() -> None:
    rows = progress()
    assert not is_held(rows, 0.0, 0, math.inf, TIMEOUT)
    assert is_held(rows, 0.5 * LEAST, 0, math.inf, TIMEOUT + 0.1)


def test_way_and_legs_are_progress() -> None:
    rows = progress()
    assert not is_held(rows, 1.5 * LEAST, 0, math.inf, 2.0 * TIMEOUT)
    assert not is_held(rows, 1.5 * LEAST, 1, math.inf, 4.0 * TIMEOUT)
    assert is_held(rows, 1.5 * LEAST, 1, math.inf, 5.0 * TIMEOUT + 0.1)


def test_less_of_a_turn_is_progress_and_after_more_way_another_turn_is_as_well() -> None:
    rows = progress()
    assert not is_held(rows, 0.0, 0, 3.0, 2.0 * TIMEOUT)
    assert not is_held(rows, 0.0, 0, 2.7, 3.0 * TIMEOUT)
    assert is_held(rows, 0.0, 0, 2.6, 4.0 * TIMEOUT + 0.1)
    assert not is_held(rows, 1.0, 0, math.inf, 5.0 * TIMEOUT)
    assert not is_held(rows, 1.0, 0, 3.0, 6.0 * TIMEOUT)


@given(st.lists(st.floats(0.0, math.pi), min_size=1, max_size=200))
def test_at_one_place_no_turning_goes_on_for_ever(turns: list[float]) -> None:
    rows, times = progress(), set()
    for n, turn in enumerate(turns):
        is_held(rows, 0.0, 0, turn, float(n))
        times.add(float(rows["at"][0]))
    assert len(times) <= math.pi / LEAST_TURN + 2.0
