"""How ends are joined to centres, against distances to every solid cell, one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from roomba.arrays import Mask
from roomba.geometry import Point, RoundObstacle
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.joining import join_goal, join_start
from roomba.planning.path.search.any_angle import Joints

CELL, REACH = 0.1, 0.13
SURE = 1e-6
"""m; places that are nearer than this to a limit may be taken either way."""

FLOORS = arrays(
    np.bool_,
    st.tuples(st.integers(3, 9), st.integers(3, 9)),
    elements=st.integers(0, 7).map(lambda number: number == 0),
    fill=st.just(False),
)
SOMEWHERE = st.tuples(st.integers(-3, 100), st.integers(-3, 100)).map(
    lambda at: (at[0] / 100 + 0.0007, at[1] / 100 + 0.0003)
)
OBSTACLES = st.lists(
    st.tuples(st.integers(0, 9), st.integers(0, 9), st.integers(1, 9)).map(
        lambda at: (at[0] / 10, at[1] / 10 + 0.03, at[2] / 50)
    ),
    max_size=1,
)


class Room:
    """A floor with all that is solid as shapes."""

    def __init__(self, solid: Mask, obstacles: list[RoundObstacle]) -> None:
        frame = GridFrame(CELL, 0.0, 0.0, *solid.shape)
        values = np.where(solid, OCCUPIED, FREE).astype(np.int8)
        self.fit = FitMap.build(OccupancyMap(frame, values), 0.1, REACH - 0.1, obstacles)
        self.obstacles = obstacles
        high_y, high_x = (CELL * cells for cells in solid.shape)
        floor = shapely.box(0.0, 0.0, high_x, high_y)
        squares = [
            shapely.box(CELL * x, CELL * y, CELL * (x + 1), CELL * (y + 1))
            for y, x in np.argwhere(solid).tolist()
        ]
        self.solid = shapely.union_all([shapely.box(-9, -9, 9, 9) - floor, *squares])
        self.centres = [
            (frame.centre_of(row, column), (row, column)) for row, column in np.ndindex(solid.shape)
        ]

    def room(self, start: Point, end: Point) -> float:
        """How far the straight way between two points is from all that is solid, m."""
        way = shapely.LineString([start, end])
        rooms = [
            float(way.distance(shapely.Point(x, y))) - radius for x, y, radius in self.obstacles
        ]
        return min([float(self.solid.distance(way)), *rooms])

    def fitting(self) -> list[tuple[Point, tuple[int, int]]]:
        """Centres at which the body fits, with their cells."""
        rooms = [self.room(centre, centre) for centre, _ in self.centres]
        assume(all(abs(room - REACH) > SURE for room in rooms))
        return [each for each, room in zip(self.centres, rooms, strict=True) if room > REACH]


def cells_of(joints: Joints) -> set[tuple[int, int]]:
    return {(row, column) for row, column in joints.cells.tolist()}


def assert_nearest_first(room: Room, joints: Joints, point: Point) -> None:
    away = [
        math.dist(room.fit.map.frame.centre_of(row, column), point) / CELL
        for row, column in joints.cells.tolist()
    ]
    assert joints.legs.tolist() == pytest.approx(away)
    assert away == sorted(away)


@given(FLOORS, OBSTACLES, SOMEWHERE)
@settings(max_examples=examples(120))
def test_a_goal_is_joined_to_all_near_centres_to_which_the_body_can_go_straight(
    solid: Mask, obstacles: list[RoundObstacle], goal: Point
) -> None:
    room = Room(solid, obstacles)
    fitting = room.fitting()
    joints = join_goal(room.fit, goal)
    around = {
        cell for (x, y), cell in fitting if abs(x - goal[0]) < CELL and abs(y - goal[1]) < CELL
    }
    here = room.room(goal, goal)
    assume(abs(here - REACH) > SURE)
    if len(around) == 4:
        expected = around
    elif here < REACH:
        assert joints is None
        return
    else:
        near = [
            (room.room(goal, centre), cell)
            for centre, cell in fitting
            if max(abs(centre[0] - goal[0]), abs(centre[1] - goal[1])) <= 2 * CELL
        ]
        assume(all(abs(least - REACH) > SURE for least, _ in near))
        expected = {cell for least, cell in near if least > REACH}
    assert joints is not None
    assert cells_of(joints) == expected
    assert_nearest_first(room, joints, goal)


@given(FLOORS, st.data())
@settings(max_examples=examples(40))
def test_a_goal_on_a_centre_is_joined_to_it_alone(solid: Mask, data: st.DataObject) -> None:
    room = Room(solid, [])
    fitting = room.fitting()
    assume(fitting)
    centre, cell = data.draw(st.sampled_from(fitting))
    for joints in (join_goal(room.fit, centre), join_start(room.fit, centre)):
        assert joints is not None
        assert joints.cells.tolist() == [list(cell)]
        assert joints.legs.tolist() == pytest.approx([0.0], abs=1e-9)


@given(FLOORS, OBSTACLES, SOMEWHERE)
@settings(max_examples=examples(120))
def test_a_start_that_does_not_fit_leaves_by_the_shortest_way_that_comes_no_nearer(
    solid: Mask, obstacles: list[RoundObstacle], start: Point
) -> None:
    room = Room(solid, obstacles)
    fitting = room.fitting()
    goal_joints = join_goal(room.fit, start)
    joints = join_start(room.fit, start)
    if not room.fit.map.frame.contains(*start):
        assert not len(joints.legs)
        return
    if goal_joints is not None and len(goal_joints.legs):
        assert np.array_equal(joints.cells, goal_joints.cells)
        return
    here = min(room.room(start, start), REACH)
    ways = [(math.dist(centre, start), room.room(start, centre) - here) for centre, _ in fitting]
    most = REACH + 2 * CELL
    # In what is solid all ways have as little room as the start itself.
    assume(all(nearer < -SURE or nearer > -1e-10 for _, nearer in ways))
    legal = [way for way, nearer in ways if nearer > -1e-10 and way <= most]
    if not legal:
        assert not len(joints.legs)
        return
    assert joints.legs.tolist() == pytest.approx([min(legal) / CELL])
    ((row, column),) = joints.cells.tolist()
    assert room.fit.fits[row, column]
    assert room.room(start, room.fit.map.frame.centre_of(row, column)) >= here - 1e-9


@pytest.mark.parametrize("start", [(0.45, 0.92), (0.92, 0.45), (-0.02, 0.45), (0.45, -0.02)])
def test_a_start_just_off_the_map_is_joined_to_nothing(start: Point) -> None:
    """On the map it would be joined: all of the floor but its rim is free."""
    room = Room(np.zeros((9, 9), np.bool_), [])
    assert not len(join_start(room.fit, start).legs)
    inside = min(max(start[0], 0.01), 0.89), min(max(start[1], 0.01), 0.89)
    assert len(join_start(room.fit, inside).legs)
