"""Surface is where points are, and between neighbours on one plane; coarser grids bound it."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.mapped import Floats
from hypothesis import given
from hypothesis import strategies as st

from roomba.perception.slam.scan_matching.likelihood_field import (
    FULL,
    LikelihoodField,
    likelihood_field,
)

LOOKS_DOWN = (0.0, -1.0)
UNKNOWN = (0.0, 0.0)


def wall(along: Floats, y: float = 2.0, normal: tuple[float, float] = LOOKS_DOWN) -> Floats:
    """Points [n, 4] of a wall along x, at so many m."""
    return np.column_stack((along, np.full(len(along), y), np.full((len(along), 2), normal)))


def likelihood_at(field: LikelihoodField, x: float, y: float) -> float:
    """How likely a surface is at a place, m."""
    column, row = np.floor((np.array([x, y]) - field.corner) / field.cell).astype(int)
    rows, columns = field.levels[0].shape
    is_inside = 0 <= row < rows and 0 <= column < columns
    return float(field.levels[0][row, column]) / FULL if is_inside else 0.0


def test_surface_is_where_a_point_is_and_nowhere_else() -> None:
    field = likelihood_field(wall(np.array([1.0])))
    assert likelihood_at(field, 1.0, 2.0) > 0.8
    assert likelihood_at(field, 1.1, 2.0) < 0.5
    assert likelihood_at(field, 1.5, 2.0) == 0.0
    assert likelihood_at(field, 1.0, 2.5) == 0.0


@pytest.mark.parametrize(("normal", "is_joined"), [(LOOKS_DOWN, True), (UNKNOWN, False)])
def test_between_neighbours_on_one_surface_there_is_surface(
    normal: tuple[float, float], *, is_joined: bool
) -> None:
    """However few beams there are: those of the next scan end between them."""
    field = likelihood_field(wall(np.arange(-3.0, 2.9, 0.4), normal=normal))
    between = [likelihood_at(field, x, 2.0) > 0.8 for x in np.arange(-2.8, 2.5, 0.4)]
    assert between == [is_joined] * len(between)


def test_a_door_between_two_walls_stays_open() -> None:
    left, right = wall(np.arange(-3.0, -0.9, 0.1)), wall(np.arange(0.0, 2.1, 0.1))
    field = likelihood_field(np.concatenate((left, right)))
    assert all(likelihood_at(field, x, 2.0) == 0.0 for x in np.arange(-0.8, -0.2, 0.1))


def test_a_step_between_two_surfaces_is_not_joined() -> None:
    near, far = wall(np.arange(-3.0, 0.1, 0.2)), wall(np.arange(0.2, 3.3, 0.2), y=2.4)
    field = likelihood_field(np.concatenate((near, far)))
    assert likelihood_at(field, 0.1, 2.2) < 0.1


def test_a_corner_is_not_cut() -> None:
    front = wall(np.arange(0.0, 2.1, 0.2))
    side = np.column_stack(
        (np.full(5, 2.3), np.arange(1.7, 0.6, -0.25), np.full((5, 2), (-1.0, 0.0)))
    )
    assert likelihood_at(likelihood_field(np.concatenate((front, side))), 2.15, 1.85) < 0.1


@given(st.integers(0, 10_000))
def test_each_coarser_grid_holds_the_greatest_of_its_blocks(seed: int) -> None:
    points = np.random.default_rng(seed).uniform(-2.0, 2.0, (20, 4))
    levels = likelihood_field(points).levels
    _, rows, columns = levels.shape
    for level, grid in enumerate(levels):
        size = 1 << level
        for row, column in ((0, 0), (rows // 2, columns // 3), (rows - 1, columns - 1)):
            block = levels[0][row : row + size, column : column + size]
            assert grid[row, column] == block.max()
