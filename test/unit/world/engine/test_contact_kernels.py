"""Arcs, directions, and distances to what is solid: the parts as plain Python."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.world.engine.contact_kernels import (
    LEFT,
    RIGHT,
    arc,
    halves,
    near_cells,
    room_at,
    way_to_box,
)
from roomba.world.engine.layout import room_around
from roomba.world.engine.state.arrays import BOX, CELL, HOME

angles = st.floats(-20.0, 20.0)


@given(angles, st.floats(-2.0, 2.0), st.floats(-3.0, 3.0), st.floats(0.0, 1.0))
def test_an_arc_may_be_driven_in_two_parts(
    theta: float, length: float, turn: float, share: float
) -> None:
    x, y = arc(1.0, 2.0, theta, length * share, turn * share)
    x, y = arc(x, y, theta + turn * share, length * (1 - share), turn * (1 - share))
    assert (x, y) == pytest.approx(arc(1.0, 2.0, theta, length, turn), abs=1e-6)


@pytest.mark.parametrize("turn", [2e-9, 0.9e-9, 0.0, -0.9e-9])
def test_an_arc_of_hardly_any_turn_is_a_line(turn: float) -> None:
    expected = 1.0 + 0.8 * math.cos(0.7), 2.0 + 0.8 * math.sin(0.7)
    assert arc(1.0, 2.0, 0.7, 0.8, turn) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(
    ("degrees", "expected"),
    [
        (0.0, LEFT | RIGHT),
        (17.0, LEFT | RIGHT),
        (-17.0, LEFT | RIGHT),
        (18.0, LEFT),
        (89.0, LEFT),
        (-18.0, RIGHT),
        (-89.0, RIGHT),
        (91.0, 0),
        (-91.0, 0),
        (180.0, 0),
    ],
)
@pytest.mark.parametrize("theta", [0.0, 3.0, -1.5])
def test_the_bumpers_halves_overlap_ahead_and_end_beside_the_body(
    degrees: float, expected: int, theta: float
) -> None:
    direction = theta + math.radians(degrees)
    assert halves(math.cos(direction), math.sin(direction), theta) == expected


@settings(max_examples=examples(60))
@given(
    st.integers(0, 2**32 - 1),
    st.floats(0.0, 0.3),
    st.floats(-0.3, 1.3),
    st.floats(-0.3, 1.3),
    st.floats(0.05, 0.4),
)
def test_the_nearest_cell_is_found_and_the_rooms_bound_is_never_too_large(
    seed: int, density: float, x: float, y: float, reach: float
) -> None:
    resolution, left, bottom = 0.05, -0.1, 0.1
    random = np.random.default_rng(seed)
    solid = random.random((20, 16)) < density
    home = np.zeros(1, HOME).view(np.recarray)[0]
    home.resolution, home.left, home.bottom = resolution, left, bottom
    home.rows, home.columns = solid.shape
    cells = np.zeros(solid.size, CELL)
    cells["solid"] = solid.ravel()
    cells["room"] = room_around(solid, resolution).ravel()
    cells = cells.view(np.recarray)
    # Plain: the distance to every solid square, those of a wide frame all around included.
    padded = np.pad(solid, 30, constant_values=True)
    rows, columns = np.nonzero(padded)
    dx = np.abs(left + (columns - 30 + 0.5) * resolution - x) - 0.5 * resolution
    dy = np.abs(bottom + (rows - 30 + 0.5) * resolution - y) - 0.5 * resolution
    nearest = float(np.hypot(np.maximum(dx, 0.0), np.maximum(dy, 0.0)).min())
    found, pressed = near_cells(cells, home, x, y, reach, -1.0, 0.0)
    assert found == pytest.approx(min(nearest, reach), abs=1e-9)
    assert pressed == 0
    assert room_at(cells, home, x, y) <= nearest + 1e-7


@settings(max_examples=examples(60))
@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), angles)
def test_the_way_to_a_turned_box_ends_at_its_nearest_point(x: float, y: float, turn: float) -> None:
    box = np.zeros(1, BOX).view(np.recarray)[0]
    box.x, box.y, box.theta, box.half_length, box.half_width = 0.3, -0.2, turn, 0.5, 0.2
    away, to_x, to_y = way_to_box(box, x, y)
    assert math.hypot(to_x, to_y) == pytest.approx(away, abs=1e-12)
    steps = np.linspace(-1.0, 1.0, 201)
    along, across = np.meshgrid(0.5 * steps, 0.2 * steps)
    points = (0.3 - 0.2j) + (along + 1j * across) * np.exp(1j * turn)
    assert away == pytest.approx(float(np.abs(points - (x + 1j * y)).min()), abs=6e-3)
    assert float(np.abs(points - (x + to_x + 1j * (y + to_y))).min()) < 6e-3
