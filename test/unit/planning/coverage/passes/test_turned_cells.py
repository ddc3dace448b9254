"""Grids that are turned against the floor's, cell by cell."""

from __future__ import annotations

import math

import numpy as np
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.planning.coverage.passes.turned_cells import TurnedCells, turned_mask


@given(
    st.integers(1, 30),
    st.integers(1, 30),
    st.floats(-0.7, 0.7),
    st.floats(0.9, 1.0),
    st.integers(0, 2**32 - 1),
)
@settings(max_examples=examples(40))
def test_cells_cover_the_window_and_are_what_is_nearest_to_their_middles(
    rows: int, columns: int, angle: float, cell: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    left, top = random.integers(0, 5, 2).tolist()
    mask = random.random((top + rows + 3, left + columns + 3)) < 0.5
    cells = TurnedCells.over(rows, columns, angle, cell)
    column, row = np.meshgrid(np.arange(cells.columns), np.arange(cells.rows))
    places = cells.places(np.stack((column, row), axis=-1).astype(np.float64))
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    away = np.hypot(
        places[:, :, 0].ravel() - x.reshape(-1, 1), places[:, :, 1].ravel() - y.reshape(-1, 1)
    )
    assert away.min(axis=1).max() <= cell * math.sqrt(0.5) + 1e-9
    found = turned_mask(mask, cells, left, top)
    for at_row, at_column in np.ndindex(found.shape):
        at_x, at_y = places[at_row, at_column] + (left, top)
        if abs(at_x % 1.0 - 0.5) < 1e-6 or abs(at_y % 1.0 - 0.5) < 1e-6:
            continue
        near_x, near_y = round(at_x), round(at_y)
        is_inside = 0 <= near_x < mask.shape[1] and 0 <= near_y < mask.shape[0]
        assert found[at_row, at_column] == (is_inside and mask[near_y, near_x])


def test_rows_run_along_the_angle() -> None:
    cells = TurnedCells.over(20, 30, math.radians(30.0), 0.98)
    begin, along, aside = cells.places(np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]]))
    assert np.allclose(along - begin, 9.8 * np.array([math.cos(math.pi / 6), 0.5]))
    assert np.allclose(aside - begin, 9.8 * np.array([-0.5, math.cos(math.pi / 6)]))
