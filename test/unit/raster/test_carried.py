"""Values of cells are carried over to another map of the same home."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.raster.carried import carried

FRAME = GridFrame(0.05, -0.4, 0.2, 30, 40)
PATCH = np.zeros(FRAME.shape, np.uint8)
PATCH[8:20, 10:25] = 7


@given(st.integers(-20, 20), st.integers(-20, 20))
def test_on_a_grid_that_lies_elsewhere_each_cell_keeps_its_place(rows: int, columns: int) -> None:
    after = GridFrame(0.05, -0.4 + 0.05 * columns, 0.2 + 0.05 * rows, 50, 60)
    over = carried(PATCH, FRAME, after, Pose())
    for row, column in np.argwhere(over).tolist():
        x, y = after.centre_of(row, column)
        assert PATCH[FRAME.cell_of(x, y)] == over[row, column]
    shown = [FRAME.centre_of(*cell) for cell in np.argwhere(PATCH).tolist()]
    assert np.count_nonzero(over) == sum(after.contains(x, y) for x, y in shown)


@given(st.floats(-3.0, 3.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_turned_it_lies_where_its_corners_went(theta: float, x: float, y: float) -> None:
    moved = Pose(x, y, theta)
    after = GridFrame(0.05, -5.0, -5.0, 200, 200)
    over = carried(PATCH, FRAME, after, moved)
    rows, columns = np.nonzero(over)
    middle = after.centre_of(round(rows.mean()), round(columns.mean()))
    at = moved.compose(Pose(-0.4 + 17.5 * 0.05, 0.2 + 14.0 * 0.05))
    assert math.dist(middle, (at.x, at.y)) < 0.06
    assert np.count_nonzero(over) == pytest.approx(12 * 15, rel=0.06)


def test_where_there_was_nothing_it_says_so() -> None:
    learned = np.full(FRAME.shape, 2.0, np.float32)
    over = carried(learned, FRAME, GridFrame(0.05, 1.4, 0.2, 2, 8), Pose(), math.nan)
    assert over.dtype == np.float32
    assert np.array_equal(over[0], [2.0] * 4 + [math.nan] * 4, equal_nan=True)


def test_values_of_another_grid_are_refused() -> None:
    with pytest.raises(ValueError, match=r"expected values of shape \(30, 40\), got \(3, 4\)"):
        carried(np.zeros((3, 4)), FRAME, FRAME, Pose())
