"""Whether a newer map shows something new on a way."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.planned_rooms import RADIUS, TIGHT, room
from numpy.typing import NDArray

from roomba.geometry import Point
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.planning.path.new_walls import is_walled

WAY = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 0.8)])
BEFORE = room()


def shows(*cells: Point, before: OccupancyMap = BEFORE, way: NDArray[np.float64] = WAY) -> bool:
    """Whether something new is on the way when there are occupied cells at these points, m."""
    values = before.values.copy()
    for point in cells:
        values[before.frame.cell_of(*point)] = OCCUPIED
    return is_walled(way, OccupancyMap(before.frame, values), before, RADIUS, TIGHT)


@pytest.mark.parametrize("cell", [(0.52, 0.02), (1.02, 0.92), (-0.12, -0.08), (1.17, 0.42)])
def test_what_stands_on_it_is_told(cell: Point) -> None:
    assert shows(cell)
    assert shows((2.5, 1.5), cell)


@pytest.mark.parametrize("cell", [(0.52, 0.28), (1.02, 1.08), (-0.28, 0.02), (1.28, 0.42)])
def test_what_stands_beside_it_is_not(cell: Point) -> None:
    assert not shows(cell)


def test_by_the_body_it_is_exact() -> None:
    """The cell's side is at 0.20 m: the body with its clearance is a little less or more."""
    way, cell = np.array([(0.0, 0.0), (1.0, 0.0)]), (0.52, 0.22)
    for beside, is_told in ((0.001, False), (-0.001, True)):
        moved = way + np.array((0.0, 0.2 - RADIUS - TIGHT - beside))
        assert shows(cell, way=moved) is is_told


def test_what_was_there_before_is_not_new() -> None:
    """Nor is what was unknown: no way was planned over that."""
    values = BEFORE.values.copy()
    values[BEFORE.frame.cell_of(0.52, 0.02)] = OCCUPIED
    values[BEFORE.frame.cell_of(0.62, 0.02)] = UNKNOWN
    before = OccupancyMap(BEFORE.frame, values)
    assert not shows((0.52, 0.02), (0.62, 0.02), before=before)
    assert shows((0.52, 0.02), (0.72, 0.02), before=before)


def test_a_map_that_grew_to_all_sides_is_compared_where_both_are() -> None:
    frame, size = BEFORE.frame, BEFORE.frame.resolution
    corner = frame.origin_x - 7 * size, frame.origin_y - 3 * size
    larger = GridFrame(size, *corner, frame.rows + 12, frame.columns + 20)
    values = np.full(larger.shape, UNKNOWN, np.int8)
    values[3 : 3 + frame.rows, 7 : 7 + frame.columns] = BEFORE.values
    assert not is_walled(WAY, OccupancyMap(larger, values), BEFORE, RADIUS, TIGHT)
    values[larger.cell_of(0.52, 0.02)] = OCCUPIED
    assert is_walled(WAY, OccupancyMap(larger, values), BEFORE, RADIUS, TIGHT)
    # What it shows where the other one has nothing is not new.
    values[larger.cell_of(0.52, 0.02)] = FREE
    beyond = np.array([(2.8, 0.0), (3.3, 0.0)])
    values[larger.cell_of(3.2, 0.02)] = OCCUPIED
    assert not is_walled(beyond, OccupancyMap(larger, values), BEFORE, RADIUS, TIGHT)
