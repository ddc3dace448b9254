"""Whether dirty floor may be close by, against a slow check of all cells."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.mission.cleaning.dirty.watch_kernels import WATCH, may_be_dirty
from roomba.perception.swept.dirt_map import CELL, LEAST_WAY

Floats = NDArray[np.float32]
CORNER = -1.0
SIDE = 12
"""Cells."""
PLACE = np.array([CORNER, CORNER, CELL])
LOOK, MEASURE = 5.0, 30.0
DIRTY = 500.0


def watch(looked_at: float = 0.0, measured_at: float = 0.0, reach: float = 0.5) -> NDArray[np.void]:
    """The row of a clean that looked, and measured, then."""
    rows = np.zeros(1, WATCH)
    rows[0] = looked_at, measured_at, DIRTY, LOOK, MEASURE, reach
    return rows


def dirty_within(
    grains: Floats, way: Floats, done: NDArray[np.bool_], x: float, y: float, reach: float
) -> bool:
    """Whether a cell that is dirty and not done has a part in a square around a place."""
    for row, column in np.argwhere(~done & (way > LEAST_WAY)).tolist():
        left, bottom = CORNER + column * CELL, CORNER + row * CELL
        is_in = left <= x + reach and left + CELL > x - reach
        is_in = is_in and bottom <= y + reach and bottom + CELL > y - reach
        if is_in and grains[row, column] / (float(way[row, column]) * CELL) >= DIRTY:
            return True
    return False


places = st.floats(CORNER, CORNER + SIDE * CELL)


@given(seed=st.integers(0, 1000), x=places, y=places, reach=st.floats(0.1, 1.0))
def test_it_is_told_as_by_a_look_over_all_cells(
    seed: int, x: float, y: float, reach: float
) -> None:
    random = np.random.default_rng(seed)
    grains = (random.random((SIDE, SIDE)) * 130.0 * (random.random((SIDE, SIDE)) < 0.05)).astype(
        np.float32
    )
    way = (random.random((SIDE, SIDE)) * 0.4).astype(np.float32)
    done = random.random((SIDE, SIDE)) < 0.2
    rows = watch(reach=reach)
    told = may_be_dirty(rows, grains, way, done, PLACE, x, y, LOOK)
    assert told == dirty_within(grains, way, done, x, y, reach)
    # Dirty floor is for the mission to look at closer; nothing dirty was a look.
    assert rows[0]["looked_at"] == (0.0 if told else LOOK)


def test_times_decide_and_a_clock_that_was_set_back_is_a_reason_to_look() -> None:
    empty = np.zeros((SIDE, SIDE), np.float32)
    done = np.zeros((SIDE, SIDE), np.bool_)

    def tells(now: float, looked_at: float = 0.0, measured_at: float = 0.0) -> bool:
        rows = watch(looked_at, measured_at)
        return bool(may_be_dirty(rows, empty, empty, done, PLACE, 0.0, 0.0, now))

    assert not tells(0.99 * LOOK, measured_at=-math.inf)
    assert tells(LOOK, measured_at=-math.inf)
    assert not tells(0.99 * MEASURE)
    assert tells(MEASURE)
    assert tells(-1.0)
