"""Planning on a growing map: away from walls, and yet through narrow places."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.planned_rooms import RADIUS, SAGITTA, TIGHT, room, samples, two_rooms

from roomba.geometry import Point
from roomba.grid import OccupancyMap
from roomba.planning.path.careful import CarefulPathPlanner
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.planner import NoPathError, NoPathReason, Path, PathPlanner

WANTED, CAREFUL = 0.2, 0.08
CORNER = room((0.5, -2.0, 1.5, 1.35))
"""Between a block and the wall ahead is room for the careful clearance, not for the wanted one."""


def careful_for(map: OccupancyMap) -> CarefulPathPlanner:
    return CarefulPathPlanner(map, RADIUS, WANTED, CAREFUL, TIGHT)


def least_room(map: OccupancyMap, path: Path, beyond: float = 0.0) -> float:
    """The least distance, m, between the path's body and what is solid, ``beyond`` m along it."""
    fit = FitMap.build(map, RADIUS, WANTED)
    points = [path.point_at(s) for s in np.arange(beyond, path.length, 0.004).tolist()]
    return min(fit.room_along(point, point) for point in points) - RADIUS


@pytest.mark.parametrize("ends", [((0.0, 0.0), (2.0, 0.0)), ((2.2, -1.0), (-0.5, 1.6))])
def test_where_there_is_some_room_it_keeps_away(ends: tuple[Point, Point]) -> None:
    """Around a corner through a passage: the shortest of the tight ways lies along the corner."""
    careful = careful_for(CORNER).plan(*ends)
    tight = PathPlanner(CORNER, RADIUS, WANTED, TIGHT).plan(*ends)
    assert least_room(CORNER, careful) >= CAREFUL - SAGITTA - 1e-6
    assert least_room(CORNER, tight) < CAREFUL - SAGITTA
    assert careful.length < 1.1 * tight.length


def test_a_gap_that_leaves_no_more_is_passed_tightly() -> None:
    map, ends = two_rooms(0.45), ((0.0, -1.5), (2.0, -1.5))
    path = careful_for(map).plan(*ends)
    assert path.length == PathPlanner(map, RADIUS, WANTED, TIGHT).plan(*ends).length
    assert TIGHT - SAGITTA - 1e-6 <= least_room(map, path) < CAREFUL


def test_from_beside_a_wall_it_leaves_that_first() -> None:
    map = room((0.5, -1.0, 1.5, 1.0))
    start = (0.5 - RADIUS - TIGHT, 0.0)
    path = careful_for(map).plan(start, (0.2, 1.5))
    assert tuple(path.points[0]) == start
    assert least_room(map, path, beyond=2.0 * CAREFUL) >= CAREFUL - SAGITTA - 1e-6


def test_beside_a_wall_it_comes_to_a_goal() -> None:
    goal = (0.5 - RADIUS - TIGHT, 0.0)
    path = careful_for(room((0.5, -1.0, 1.5, 1.0))).plan((0.0, 1.0), goal)
    assert tuple(path.points[-1]) == goal


def test_things_in_the_way_count() -> None:
    things = [(1.0, 1.9, 0.05)]
    path = careful_for(CORNER).plan((0.0, 0.0), (2.0, 0.0), things)
    nearest = min(math.dist(point, things[0][:2]) for point in samples(path)) - RADIUS - 0.05
    assert nearest >= TIGHT - 1e-6
    with pytest.raises(NoPathError) as refused:
        careful_for(CORNER).plan((0.0, 0.0), (2.0, 0.0), [(1.0, 1.72, 0.1)])
    assert refused.value.reason is NoPathReason.GOAL_UNREACHABLE


@pytest.mark.parametrize("careful", [0.3, 0.005, -0.1, math.nan])
def test_clearances_that_are_not_in_order_are_refused(careful: float) -> None:
    with pytest.raises(ValueError, match="expected a careful_clearance of"):
        CarefulPathPlanner(room(), RADIUS, WANTED, careful, TIGHT)
