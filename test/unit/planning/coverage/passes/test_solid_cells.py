"""The nearest point of what is solid, against a look at every cell."""

from __future__ import annotations

import math

import numpy as np
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.compilation import compiled
from roomba.planning.coverage.passes import solid_cells
from roomba.planning.coverage.passes.solid_cells import Beside, SolidCells

ROWS, COLUMNS = 12, 19
COLUMN, ROW = 4, 2
"""Where cell (0, 0) of the outlines lies."""


@compiled()
def nearest(beside: Beside, x: float, y: float, far: float) -> tuple[float, float, float]:
    return solid_cells.nearest_solid(beside, x, y, far)


@settings(max_examples=examples(150))
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.0, 0.02, 0.2, 1.0]),
    st.sampled_from([0.4, 3.0, 30.0]),
)
def test_the_nearest_point_is_that_of_the_nearest_square(
    seed: int, density: float, far: float
) -> None:
    """From the grid and from a little outside, where outlines may be."""
    random = np.random.default_rng(seed)
    solid = random.random((ROWS, COLUMNS)) < density
    cells = SolidCells(solid, COLUMN, ROW, 1.0, np.zeros((0, 3)))
    x, y = random.uniform(-6.0, COLUMNS), random.uniform(-4.0, ROWS)
    rows, columns = np.nonzero(solid)
    to_x = np.clip(x, columns - COLUMN - 0.5, columns - COLUMN + 0.5)
    to_y = np.clip(y, rows - ROW - 0.5, rows - ROW + 0.5)
    least = np.hypot(to_x - x, to_y - y).min(initial=math.inf)
    found_x, found_y, away = nearest(cells.beside, x, y, far)
    if least > far:
        assert away == math.inf
        return
    assert math.isclose(away, least, abs_tol=1e-12)
    assert math.isclose(math.hypot(found_x - x, found_y - y), away, abs_tol=1e-12)
    is_there = np.isclose(to_x, found_x) & np.isclose(to_y, found_y)
    assert is_there.any()
