"""Making room for what stands in the way."""

from __future__ import annotations

import math

import numpy as np
from fixtures.homes.obstacles import Standing
from fixtures.robots.missions import TWO_ROOMS, WALL_X
from numpy.typing import NDArray

from roomba.configuration.mission import GivingWayConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, RoundObstacle
from roomba.grid import FREE, OccupancyMap
from roomba.mission.driving.give_way import way_aside
from roomba.mission.driving.trail import Trail
from roomba.mission.inputs.senses import Senses
from roomba.planning.path.planner import PathPlanner

RADIUS, CONFIG = RobotConfig().body.radius, GivingWayConfig()
PLANNER = PathPlanner(TWO_ROOMS.map, RADIUS, 0.04, 0.0025)
IN_THE_DOOR = Senses(0.0, Pose(WALL_X + 0.05, 1.2, math.pi))
PERSON: list[RoundObstacle] = [(WALL_X - 0.45, 1.2 + 0.05 * step, 0.02) for step in range(-5, 6)]


def off(points: NDArray[np.float64], things: list[RoundObstacle]) -> float:
    """How far the end of a way is from the nearest of some things, m."""
    x, y = points[-1]
    return min(math.dist((x, y), (thing[0], thing[1])) for thing in things)


def test_it_goes_back_from_a_person_that_wants_to_pass() -> None:
    points = way_aside(PLANNER, IN_THE_DOOR, Standing(PERSON), Trail(), CONFIG)
    assert points is not None
    assert points[0].tolist() == [IN_THE_DOOR.pose.x, IN_THE_DOOR.pose.y]
    assert off(points, PERSON) > 1.1
    # Into the room behind it.
    assert (points[:, 0] > WALL_X).all()


def test_it_does_not_go_past_the_person() -> None:
    here = Senses(0.0, Pose(WALL_X + 0.6, 1.2, math.pi))
    points = way_aside(PLANNER, here, Standing(PERSON), Trail(), CONFIG)
    assert points is not None
    assert (points[:, 0] > WALL_X).all()
    assert off(points, PERSON) > 1.1


def test_where_no_person_is_known_to_stand_it_leaves_the_place() -> None:
    points = way_aside(PLANNER, IN_THE_DOOR, Standing([]), Trail(), CONFIG)
    assert points is not None
    assert off(points, [(IN_THE_DOOR.pose.x, IN_THE_DOOR.pose.y, 0.0)]) > 1.0


def test_hemmed_in_it_drives_back_as_it_came() -> None:
    ring = [
        (IN_THE_DOOR.pose.x + 0.19 * math.cos(turn), 1.2 + 0.19 * math.sin(turn), 0.02)
        for turn in np.arange(math.pi / 2, 3 * math.pi / 2, 0.2).tolist()
    ]
    beside = [(IN_THE_DOOR.pose.x + 0.02, 1.2 + side, 0.03) for side in (-0.2, 0.2)]
    things = ring + beside
    assert way_aside(PLANNER, IN_THE_DOOR, Standing(things), Trail(), CONFIG) is None
    trail = Trail()
    for step in range(20):
        trail.add(WALL_X + 1.05 - 0.05 * step, 1.2)
    points = way_aside(PLANNER, IN_THE_DOOR, Standing(things), trail, CONFIG)
    assert points is not None
    assert off(points, things) > 1.1


def test_off_the_map_there_is_no_way_aside() -> None:
    frame = TWO_ROOMS.map.frame
    values = np.full(frame.shape, FREE, np.int8)
    planner = PathPlanner(OccupancyMap(frame, values), RADIUS, 0.04, 0.0025)
    beyond = frame.origin_y + frame.rows * frame.resolution + 0.02
    here = Senses(0.0, Pose(1.0, beyond, 0.5 * math.pi))
    assert way_aside(planner, here, Standing([(1.0, beyond - 0.3, 0.02)]), Trail(), CONFIG) is None
