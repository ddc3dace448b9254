"""Where a shortest path can bend, against the floor as a shape."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from roomba.planning.path.search.floor_kernels import BEND, CROSSING, SIDE_X, SIDE_Y, survey

Mask = NDArray[np.bool_]
FLOORS = arrays(np.bool_, st.tuples(st.integers(1, 6), st.integers(1, 6)))


def surveyed(fits: Mask) -> tuple[Mask, NDArray[np.uint8]]:
    padded = np.pad(fits.astype(np.uint8), 1)
    squares, flags = np.zeros_like(padded), np.zeros_like(padded)
    survey(padded, squares, flags)
    return squares.astype(np.bool_), flags


def floor_around(fits: Mask, x: int, y: int) -> shapely.Geometry:
    """The floor within one cell of a centre: squares of four centres, steps between two."""
    columns, rows = range(x - 1, x + 2), range(y - 1, y + 2)
    parts = [
        shapely.box(left, low, left + 1, low + 1)
        for left in columns[:-1]
        for low in rows[:-1]
        if fits[low : low + 2, left : left + 2].all()
    ]
    for to_x, to_y in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
        if fits[to_y, to_x]:
            parts.append(shapely.LineString([(x, y), (to_x, to_y)]))
    return shapely.union_all(parts)


@given(FLOORS)
@settings(max_examples=examples(100))
def test_a_square_is_open_when_its_four_corners_fit(fits: Mask) -> None:
    padded = np.pad(fits, 1)
    squares, _ = surveyed(fits)
    for y, x in np.ndindex(padded.shape):
        corners = [(y, x), (y, x + 1), (y + 1, x), (y + 1, x + 1)]
        inside = y + 1 < padded.shape[0] and x + 1 < padded.shape[1]
        assert squares[y, x] == (inside and all(padded[corner] for corner in corners))


@given(FLOORS)
@settings(max_examples=examples(100))
def test_flags_tell_corners_of_the_floor_and_where_it_is_thin(fits: Mask) -> None:
    padded = np.pad(fits, 1)
    squares, flags = surveyed(fits)
    for y, x in np.ndindex(padded.shape):
        if not padded[y, x]:
            assert flags[y, x] == 0
            continue
        parts = list(shapely.get_parts(floor_around(padded, x, y)))
        areas = [part for part in parts if part.area > 0.0]
        is_thin = len(parts) > 1 or len(parts) > len(areas)
        assert bool(flags[y, x] & CROSSING) == is_thin
        for side in range(4):
            # A square is named by its lowest centre: that of the centre's NE is its own.
            column, other_column = (x, x - 1) if SIDE_X[side] > 0 else (x - 1, x)
            row, other_row = (y, y - 1) if SIDE_Y[side] > 0 else (y - 1, y)
            beside = squares[row, other_column] and squares[other_row, column]
            bends = beside and not squares[row, column]
            assert bool(flags[y, x] & BEND[side]) == bends


@pytest.mark.parametrize(
    ("rows", "bend"),
    [(["110", "111", "111"], 0), (["011", "111", "111"], 1), (["111", "111", "110"], 3)],
)
def test_a_path_bends_around_the_one_closed_square(rows: list[str], bend: int) -> None:
    """Drawn with the highest row first."""
    fits = np.array([[cell == "1" for cell in row] for row in reversed(rows)])
    _, flags = surveyed(fits)
    assert flags[2, 2] == BEND[bend]


def test_open_floor_and_a_lone_centre_have_no_flags() -> None:
    for fits in (np.ones((5, 6), np.bool_), np.ones((1, 1), np.bool_)):
        assert not surveyed(fits)[1][1:-1, 1:-1].any()
