"""How walls lie to the axes and to the cells: told exactly, or left alone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.robots.mapped import Floats
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.mapping import MappingConfig
from roomba.perception.slam.finishing.axis_alignment import phase_of_walls, turn_of_walls
from roomba.perception.slam.submaps.submap import moved

OBLIQUE = math.radians(MappingConfig().oblique)
CELL = 0.05


def walls(width: float = 4.0, height: float = 3.0, noise: float = 0.005) -> Floats:
    """Points on the walls of a room from (0, 0) on, with the lidar's noise in depth and facing."""
    random = np.random.default_rng(3)
    sides = []
    for x, y, facing, length in (
        (0.0, None, (1.0, 0.0), height),
        (width, None, (-1.0, 0.0), height),
        (None, 0.0, (0.0, 1.0), width),
        (None, height, (0.0, -1.0), width),
    ):
        along = np.arange(0.0, length, 0.008)
        depth = random.normal(0.0, noise, len(along))
        turn = random.normal(0.0, 4.0 * noise, len(along))
        places = (
            np.column_stack((x + depth, along))
            if x is not None
            else np.column_stack((along, (y or 0.0) + depth))
        )
        cosine, sine = np.cos(turn), np.sin(turn)
        normals = np.column_stack(
            (cosine * facing[0] - sine * facing[1], sine * facing[0] + cosine * facing[1])
        )
        sides.append(np.column_stack((places, normals)))
    return np.concatenate(sides)


@given(st.floats(-0.05, 0.05))
def test_a_small_turn_is_told(turn: float) -> None:
    turned = moved(walls(), np.array([1.0, -2.0, turn]))
    assert turn_of_walls(turned, OBLIQUE) == pytest.approx(turn, abs=0.0015)


@given(st.floats(-0.05, 0.05), st.sampled_from([1, 2, 3]))
def test_a_quarter_of_a_turn_is_none(turn: float, quarters: int) -> None:
    turned = moved(walls(), np.array([0.0, 0.0, turn + quarters * math.pi / 2.0]))
    assert turn_of_walls(turned, OBLIQUE) == pytest.approx(turn, abs=0.0015)


@pytest.mark.parametrize("degrees", [10.0, 30.0, 45.0, 80.0])
def test_a_home_that_lies_across_is_left_alone(degrees: float) -> None:
    turned = moved(walls(), np.array([0.0, 0.0, math.radians(degrees)]))
    assert turn_of_walls(turned, OBLIQUE) == 0.0


def test_it_is_the_same_to_the_last_bit_wherever_the_points_lie_in_memory() -> None:
    cloud = moved(walls(), np.array([0.3, 0.2, 0.01]))
    kept, turns, phases = [], set(), set()
    for size in range(1, 400):
        kept.append(np.empty(37 * size, np.uint8))
        here = cloud.copy()
        turns.add(turn_of_walls(here, OBLIQUE))
        phases.add(phase_of_walls(here, CELL))
    assert (len(turns), len(phases)) == (1, 1)


def test_walls_across_do_not_turn_the_others() -> None:
    """A bay window at 45 degrees, and a cupboard that stands 7 degrees aslant."""
    across = moved(walls(1.0, 1.0), np.array([1.0, 1.0, math.radians(45.0)]))
    aslant = moved(walls(0.6, 0.6), np.array([2.0, 1.0, math.radians(7.0)]))
    cloud = np.concatenate((moved(walls(), np.array([0.0, 0.0, 0.02])), across, aslant))
    assert turn_of_walls(cloud, OBLIQUE) == pytest.approx(0.02, abs=0.0015)


def test_too_little_says_nothing() -> None:
    assert turn_of_walls(np.zeros((0, 4)), OBLIQUE) == 0.0
    assert turn_of_walls(moved(walls(), np.array([0.0, 0.0, 0.03]))[:150], OBLIQUE) == 0.0
    assert phase_of_walls(np.zeros((0, 4)), CELL) == (0.0, 0.0)
    assert phase_of_walls(walls()[:150], CELL) == (0.0, 0.0)


@given(st.floats(0.0, CELL), st.floats(0.0, CELL))
def test_where_walls_lie_between_cells_is_told(x: float, y: float) -> None:
    found = phase_of_walls(moved(walls(), np.array([x, y, 0.0])), CELL)
    for got, wanted in zip(found, (x, y), strict=True):
        assert 0.0 <= got <= CELL
        off = (got - wanted + CELL / 2.0) % CELL - CELL / 2.0
        assert off == pytest.approx(0.0, abs=0.001)


def test_walls_that_lie_anyhow_have_no_phase() -> None:
    """Two walls half a cell out of step: any choice is wrong for one of them."""
    cloud = walls(4.025, 3.0)
    x, y = phase_of_walls(cloud, CELL)
    assert x == 0.0
    assert y == pytest.approx(0.0, abs=0.001) or y == pytest.approx(CELL, abs=0.001)
