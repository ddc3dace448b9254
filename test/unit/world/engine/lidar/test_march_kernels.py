"""Bundles of beams among cells, against single rays: the same to the last bit."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.engine.lidar import march_kernels, ray_kernels
from roomba.world.engine.lidar.bundle_kernels import BEAMS, BUNDLE
from roomba.world.engine.lidar.free_squares import QUADRANTS, free_squares
from roomba.world.engine.state.arrays import HOME, Rows

Squares = NDArray[np.uint8]

SIZE = 0.05
ROWS, COLUMNS = 31, 43
LEFT, BOTTOM = -1.0, 0.5


@compiled()
def marched(beams: Rows, squares: Squares, homes: Rows, reach: float) -> None:
    march_kernels.march(beams[0], squares, homes[0], reach)


@compiled()
def alone(
    squares: Squares, homes: Rows, x: float, y: float, cosine: float, sine: float, reach: float
) -> tuple[float, float]:
    return ray_kernels.ray_to_cells(squares, homes[0], x, y, cosine, sine, reach)


def home_of(solid: NDArray[np.bool_], cells_before: int) -> tuple[Squares, Rows]:
    """The free squares and the row of a home; squares of other homes stand before them."""
    homes = np.zeros(1, HOME)
    homes["rows"], homes["columns"] = solid.shape
    homes["squares_at"], homes["resolution"] = cells_before, SIZE
    homes["left"], homes["bottom"] = LEFT, BOTTOM
    own = free_squares(solid).reshape(QUADRANTS, -1)
    others = np.full((QUADRANTS, cells_before), 7, np.uint8)
    return np.hstack([others, own]), homes.view(np.recarray)


def bundle_of(random: np.random.Generator) -> Rows:
    """Beams from anywhere, a little outside too, and from where lines of the grid cross.

    Every other one points along an axis or a diagonal.
    """
    beams = np.zeros(1, BEAMS)
    column = random.uniform(-2.0, COLUMNS + 2.0, BUNDLE)
    row = random.uniform(-2.0, ROWS + 2.0, BUNDLE)
    is_on_line = random.random(BUNDLE) < 0.3
    beams["x"] = LEFT + SIZE * np.where(is_on_line, np.round(column), column)
    beams["y"] = BOTTOM + SIZE * np.where(is_on_line, np.round(row), row)
    eighth = 0.25 * math.pi * random.integers(0, 8, BUNDLE)
    angle = np.where(np.arange(BUNDLE) % 2, eighth, random.uniform(-math.pi, math.pi, BUNDLE))
    beams["cosine"], beams["sine"] = np.cos(angle), np.sin(angle)
    return beams.view(np.recarray)


@settings(max_examples=examples(100))
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.0, 0.01, 0.1, 0.4, 1.0]),
    st.sampled_from([0.0, 0.3, 30.0]),
)
def test_each_beam_ends_where_a_single_ray_does(seed: int, density: float, reach: float) -> None:
    random = np.random.default_rng(seed)
    squares, homes = home_of(random.random((ROWS, COLUMNS)) < density, cells_before=100)
    beams = bundle_of(random)
    marched(beams, squares, homes, reach)
    for number in range(BUNDLE):
        x, y, cosine, sine, way, facing = (
            float(beams[name][0, number]) for name in ("x", "y", "cosine", "sine", "way", "facing")
        )
        assert (way, facing) == alone(squares, homes, x, y, cosine, sine, reach)


def test_a_bundle_may_march_again_from_elsewhere() -> None:
    """Nothing of where it was is left."""
    squares, homes = home_of(np.zeros((ROWS, COLUMNS), np.bool_), cells_before=0)
    beams = np.zeros(1, BEAMS).view(np.recarray)
    beams["cosine"] = 1.0
    for column in (30.5, 2.5):
        beams["x"], beams["y"] = LEFT + SIZE * column, BOTTOM + SIZE * 3.5
        marched(beams, squares, homes, 30.0)
        assert beams["way"] == pytest.approx(SIZE * (COLUMNS - column))
        assert beams["facing"] == pytest.approx(1.0)
