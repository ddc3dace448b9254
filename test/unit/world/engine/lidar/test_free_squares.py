"""Free squares that rays go through: every cell in them is free, and one more is not."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.world.engine.lidar.free_squares import LARGEST, MARGIN, RIGHT, UP, free_squares

QUADRANTS = [(0, -1, -1), (RIGHT, 1, -1), (UP, -1, 1), (RIGHT + UP, 1, 1)]
"""Number, and where the square extends to: columns and rows."""


def is_free(
    solid: NDArray[np.bool_], row: int, column: int, to: tuple[int, int], side: int
) -> bool:
    """Whether a square within the grid that begins with a cell has no solid cell."""
    rows = row + to[1] * np.arange(side)
    columns = column + to[0] * np.arange(side)
    inside = rows.min() >= 0 <= columns.min()
    inside &= rows.max() < solid.shape[0] and columns.max() < solid.shape[1]
    return bool(inside and not solid[np.ix_(rows, columns)].any())


def within(squares: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Those of the grid itself, a view."""
    return squares[..., MARGIN:-MARGIN, MARGIN:-MARGIN]


@settings(max_examples=examples(60))
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.3), st.integers(1, 20), st.integers(1, 20))
def test_they_are_the_largest(seed: int, density: float, rows: int, columns: int) -> None:
    solid = np.random.default_rng(seed).random((rows, columns)) < density
    squares = free_squares(solid)
    assert squares.dtype == np.uint8
    for quadrant, to_column, to_row in QUADRANTS:
        sides = within(squares[quadrant])
        assert not sides[solid].any()
        for row, column in np.argwhere(~solid).tolist():
            side = int(sides[row, column])
            assert is_free(solid, row, column, (to_column, to_row), side)
            assert not is_free(solid, row, column, (to_column, to_row), side + 1)


@pytest.mark.parametrize(("quadrant", "corner"), [(0, -1), (RIGHT + UP, 0)])
def test_a_byte_holds_the_largest(quadrant: int, corner: int) -> None:
    sides = within(free_squares(np.zeros((300, 310), np.bool_))[quadrant])
    assert sides[corner, corner] == LARGEST == sides.max()


def test_around_the_grid_all_is_solid() -> None:
    squares = free_squares(np.zeros((5, 7), np.bool_))
    assert squares.shape == (4, 5 + 2 * MARGIN, 7 + 2 * MARGIN)
    within(squares)[:] = 0
    assert not squares.any()
