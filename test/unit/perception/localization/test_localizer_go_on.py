"""Another map on which the place is known: nothing is searched for, unless the map is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import FURNISHED, MOVED, SQUARE, START, TWO_ROOMS, Located, steps

from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.estimate import Knowledge
from roomba.world.home.home import Home

DEVIATION = (0.05, 0.05)
AWAY = Pose(3.0, -1.0, 0.0)
"""Where the frame of a map lies in that of the other one."""


def other_frame(home: Home = FURNISHED) -> OccupancyMap:
    """Return the map of a home with its zero elsewhere."""
    frame, values = home.map.frame, home.map.values
    moved = replace(frame, origin_x=frame.origin_x + AWAY.x, origin_y=frame.origin_y + AWAY.y)
    return OccupancyMap(moved, values.copy())


def settled(home: Home = FURNISHED) -> Located:
    """Return a robot that knows where it is, in a home that is a little other than its map."""
    robot = Located(home, START)
    for x, y in ((2.2, 0.6), (1.0, 2.7), (3.6, 2.6), (3.4, 1.2)):
        robot.world.place_obstacle(x, y, 0.12)
    for _ in steps(3.0):
        robot.look()
    assert robot.estimate.knowledge is Knowledge.KNOWN
    return robot


def knowledge_of(robot: Located, seconds: float = 2.0) -> set[Knowledge]:
    """Let it look around; return what it says of its place meanwhile."""
    found = {robot.estimate.knowledge}
    for _ in steps(seconds):
        robot.look()
        found.add(robot.estimate.knowledge)
    return found


def test_on_a_map_that_was_changed_it_is_where_it_was() -> None:
    robot = settled(MOVED)
    before, badly = robot.estimate.pose, robot.estimate.agreement
    true = OccupancyMap(MOVED.map.frame, np.where(MOVED.solid, 100, 0).astype(np.int8))
    robot.localizer.go_on(true, None)
    assert robot.estimate.pose == before
    assert knowledge_of(robot) == {Knowledge.KNOWN}
    assert robot.error < 0.02
    assert robot.estimate.agreement > badly


@pytest.mark.parametrize("off", [Pose(), Pose(0.04, -0.03, 0.04)])
def test_on_a_map_of_another_frame_it_is_where_it_was_put(off: Pose) -> None:
    robot = settled()
    put = AWAY.compose(robot.world.pose).compose(off)
    robot.localizer.go_on(other_frame(), (put, DEVIATION))
    assert robot.estimate.pose == put
    assert knowledge_of(robot) == {Knowledge.KNOWN}
    expected = AWAY.compose(robot.world.pose)
    assert robot.estimate.pose.distance_to(expected.x, expected.y) < 0.02

    # A reported pose alone is compared with all other places: here it fits but fairly.
    robot.localizer.told(AWAY.compose(robot.world.pose), DEVIATION)
    assert Knowledge.ROUGH in knowledge_of(robot)


def test_on_the_map_of_another_home_it_knows_no_place() -> None:
    robot = settled()
    robot.localizer.go_on(TWO_ROOMS.map, (Pose(5.5, 1.2, 1.0), DEVIATION))
    robot.stay(0.3)
    assert robot.estimate.knowledge is Knowledge.SEARCHING


def test_who_is_searched_for_is_searched_for_on_the_new_map() -> None:
    """On the old one all four sides look alike."""
    home = room_home(3.0, 3.0, ((1.0, 2.6, 1.6, 3.0), (2.5, 0.4, 3.0, 0.7)))
    robot = Located(replace(home, map=SQUARE.map), Pose(1.2, 1.1, 0.4))
    robot.localizer.forget("a test")
    robot.stay(1.0)
    assert robot.estimate.knowledge is Knowledge.SEARCHING
    robot.localizer.go_on(other_frame(home), None)
    assert robot.estimate.reason == "a test"
    assert Knowledge.KNOWN in knowledge_of(robot, 6.0)
    expected = AWAY.compose(robot.world.pose)
    assert robot.estimate.pose.distance_to(expected.x, expected.y) < 0.03
    # Unless its place is told at once.
    robot.localizer.forget("a test")
    robot.localizer.go_on(home.map, (robot.world.pose, DEVIATION))
    assert knowledge_of(robot) == {Knowledge.KNOWN}
