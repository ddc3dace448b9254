"""Walls free of the grid: their outlines, and the cells that they touch and fill."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.homes.free_walls import straight_wall
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.grid import GridFrame
from roomba.world.home.free_wall import (
    LONGEST_PIECE,
    ROUND_ERROR,
    arc_outline,
    arc_points,
    counter_clockwise,
    filled_cells,
    inside,
    line_outline,
    touched_cells,
)

FRAME = GridFrame(0.05, -0.4, -0.3, 30, 40)
places = st.tuples(st.floats(-0.3, 1.5), st.floats(-0.2, 1.1))


@settings(max_examples=examples(50))
@given(st.floats(0.1, 6.0), st.floats(-4.0, 4.0), st.floats(0.05, 6.2))
def test_a_round_wall_is_off_the_circle_by_less_than_a_millimetre(
    radius: float, first: float, turn: float
) -> None:
    points = np.array(arc_points((1.0, -2.0), radius, first, first + turn)) - (1.0, -2.0)
    assert np.hypot(*points.T) == pytest.approx(radius)
    middles = 0.5 * (points[1:] + points[:-1])
    off = radius - np.hypot(*middles.T)
    assert (off >= 0.0).all()
    assert off.max() <= ROUND_ERROR + 1e-12 < 1e-3
    assert np.hypot(*(points[1:] - points[:-1]).T).max() <= LONGEST_PIECE + 1e-9
    assert points[0] == pytest.approx((radius * math.cos(first), radius * math.sin(first)))
    end = first + turn
    assert points[-1] == pytest.approx((radius * math.cos(end), radius * math.sin(end)))


def test_a_round_wall_is_a_part_of_a_ring() -> None:
    whole = arc_outline((0.0, 0.0), 1.5, 0.0, math.pi, 0.2)
    assert whole.is_valid
    assert whole.area == pytest.approx(0.5 * math.pi * (1.6**2 - 1.4**2), rel=1e-3)


def test_a_wall_along_a_line_is_mitred_at_its_corner_and_square_at_its_ends() -> None:
    whole = line_outline([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)], 0.2)
    expected = shapely.union(shapely.box(0.0, -0.1, 1.1, 0.1), shapely.box(0.9, -0.1, 1.1, 1.0))
    assert whole.symmetric_difference(expected).area == pytest.approx(0.0, abs=1e-12)


def test_corners_go_round_counter_clockwise() -> None:
    square = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]
    for ring in (square, square[::-1]):
        corners = counter_clockwise(shapely.Polygon(ring))
        assert len(corners) == 4
        assert shapely.LinearRing(corners).is_ccw


@settings(max_examples=examples(30), deadline=None)
@given(places, places, st.floats(0.01, 0.4))
def test_cells_are_touched_filled_or_neither(
    start: tuple[float, float], end: tuple[float, float], thickness: float
) -> None:
    if math.dist(start, end) < 0.05:
        return
    wall = straight_wall([start, end], thickness=thickness)
    touched, filled = touched_cells(FRAME, [wall]), filled_cells(FRAME, [wall])
    assert not (filled & ~touched).any()
    for row in range(FRAME.rows):
        for column in range(FRAME.columns):
            x, y = FRAME.centre_of(row, column)
            square = shapely.box(x - 0.025, y - 0.025, x + 0.025, y + 0.025)
            share = square.intersection(wall.polygon).area / square.area
            if share > 1e-6:
                assert touched[row, column]
            if filled[row, column]:
                assert share == pytest.approx(1.0, abs=1e-6)


def test_points_are_inside_of_any_wall() -> None:
    walls = [straight_wall([(0.0, 0.0), (1.0, 0.0)]), straight_wall([(0.0, 1.0), (1.0, 1.0)])]
    x, y = np.array([[0.5, 0.5], [0.5, 2.0]]), np.array([[0.0, 1.01], [0.5, 0.0]])
    assert inside(walls, x, y).tolist() == [[True, True], [False, False]]
