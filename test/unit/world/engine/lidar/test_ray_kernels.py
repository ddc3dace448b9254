"""Single rays among cells, against plain geometry; boxes and discs are tested with whole sweeps.

What is compiled here is kept nowhere: outside of the package it would stay as its parts change.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.references.slow_lidar import ranges_to_cells
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.grid import GridFrame
from roomba.world.engine.lidar import ray_kernels
from roomba.world.engine.lidar.free_squares import QUADRANTS, free_squares
from roomba.world.engine.state.arrays import HOME, Rows

Squares = NDArray[np.uint8]

SIZE = 0.05
REACH = 30.0


@compiled()
def ray(
    squares: Squares, homes: Rows, x: float, y: float, angle: float, reach: float
) -> tuple[float, float]:
    return ray_kernels.ray_to_cells(
        squares, homes[0], x, y, math.cos(angle), math.sin(angle), reach
    )


@compiled()
def straight(
    squares: Squares, homes: Rows, x: float, y: float, cosine: float, sine: float
) -> tuple[float, float]:
    return ray_kernels.ray_to_cells(squares, homes[0], x, y, cosine, sine, REACH)


def home_of(solid: NDArray[np.bool_], left: float, bottom: float) -> tuple[Squares, Rows]:
    """The free squares and the row of a home."""
    homes = np.zeros(1, HOME)
    homes["rows"], homes["columns"] = solid.shape
    homes["resolution"], homes["left"], homes["bottom"] = SIZE, left, bottom
    return free_squares(solid).reshape(QUADRANTS, -1), homes.view(np.recarray)


@settings(max_examples=examples(60))
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.01, 0.1, 0.4]))
def test_a_ray_ends_where_plain_geometry_has_it(seed: int, density: float) -> None:
    """Each beam of all around, turned by chance; also along the axes and the diagonals."""
    random = np.random.default_rng(seed)
    solid = random.random((31, 43)) < density
    row, column = random.integers(31), random.integers(43)
    solid[row, column] = False
    frame = GridFrame(SIZE, -1.0, 0.5, 31, 43)
    x = frame.origin_x + SIZE * (column + random.uniform(0.01, 0.99))
    y = frame.origin_y + SIZE * (row + random.uniform(0.01, 0.99))
    turn = random.choice([0.0, random.uniform(-math.pi, math.pi)])
    expected = ranges_to_cells(solid, frame, x, y, turn, 64)
    squares, homes = home_of(solid, -1.0, 0.5)
    for beam, way in enumerate(expected.tolist()):
        found, facing = ray(squares, homes, x, y, turn + beam * math.pi / 32.0, REACH)
        assert found == pytest.approx(way, abs=1e-6)
        assert 0.0 <= facing <= 1.0


def test_squares_larger_than_a_byte_tells_are_gone_through_piece_by_piece() -> None:
    squares, homes = home_of(np.zeros((600, 600), np.bool_), 0.0, 0.0)
    for angle, expected in ((0.0, 29.0), (0.25 * math.pi, 29.0 * math.sqrt(2.0))):
        assert ray(squares, homes, 1.0, 1.0, angle, 50.0)[0] == pytest.approx(expected)


def test_it_tells_how_squarely_it_meets_a_wall() -> None:
    squares, homes = home_of(np.zeros((20, 20), np.bool_), 0.0, 0.0)
    for angle in (0.3, math.pi - 0.3, math.pi + 0.3, -0.3):
        assert ray(squares, homes, 0.5, 0.5, angle, REACH)[1] == pytest.approx(math.cos(0.3))
        assert ray(squares, homes, 0.5, 0.5, angle + math.pi / 2, REACH)[1] == pytest.approx(
            math.cos(0.3)
        )


@pytest.mark.parametrize("is_across", [False, True])
def test_a_ray_on_a_line_between_cells_is_in_those_above_it_or_right_of_it(is_across: bool) -> None:
    for wall, expected in ((9, 0.5), (10, 0.0)):
        solid = np.zeros((20, 20), np.bool_)
        solid[wall, 12:] = True
        squares, homes = home_of(solid.T if is_across else solid, 0.0, 0.0)
        cosine, sine = (0.0, 1.0) if is_across else (1.0, 0.0)
        found, _ = straight(squares, homes, 0.5, 0.5, cosine, sine)
        assert found == pytest.approx(expected if expected else 0.1)


def test_what_is_beyond_its_reach_is_not_met() -> None:
    squares, homes = home_of(np.zeros((20, 20), np.bool_), 0.0, 0.0)
    assert ray(squares, homes, 0.5, 0.5, 0.0, 0.49) == (math.inf, 1.0)
    assert ray(squares, homes, 0.5, 0.5, 0.0, 0.51)[0] == pytest.approx(0.5)


@pytest.mark.parametrize("place", [(-0.1, 0.5), (0.5, 1.1), (0.5, 0.5)])
def test_outside_and_in_what_is_solid_it_ends_at_once(place: tuple[float, float]) -> None:
    squares, homes = home_of(np.ones((20, 20), np.bool_), 0.0, 0.0)
    assert ray(squares, homes, *place, 0.3, REACH)[0] == 0.0


@settings(max_examples=examples(60))
@given(st.integers(0, 7), st.integers(0, 400), st.integers(1, 400), st.integers(0, 3))
def test_through_corners_of_cells_it_comes_to_an_end(
    eighth: int, first: int, size: int, nudge: int
) -> None:
    """From corners, along diagonals and axes, where rounding may take it to either side."""
    squares, homes = home_of(np.zeros((20, 20), np.bool_), -first / 7.0, size / 3.0)
    angle = eighth * math.pi / 4.0 + nudge * 1e-16
    x, y = -first / 7.0 + 10 * SIZE, size / 3.0 + 10 * SIZE
    found, _ = ray(squares, homes, x, y, angle, REACH)
    assert found == pytest.approx(0.5 * (math.sqrt(2.0) if eighth % 2 else 1.0), abs=1e-6)
