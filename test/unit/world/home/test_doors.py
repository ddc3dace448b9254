"""Leaves of doors: where they are, and that a shut one stops the robot and its lidar."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import IDEAL

from roomba.errors import HomeError
from roomba.geometry import Pose, Twist
from roomba.world.home.doors import with_leaves
from roomba.world.home.home import Door, Home, MovingKind, Rectangle
from roomba.world.simulator import Simulator

OPENING = Rectangle(2.4, 1.5, 2.5, 2.5)
AHEAD = Pose(1.5, 2.0, 0.0)


def two_rooms(*, is_open: bool = True) -> Home:
    """Return a room that a wall with a door at (2.45, 2.0) parts."""
    home = room_home(blocks=((2.4, 0.0, 2.5, 1.5), (2.4, 2.5, 2.5, 4.0)))
    return replace(home, doors=(Door("door", OPENING, is_open),))


def test_each_open_door_gets_a_leaf_that_is_out_of_the_way() -> None:
    (leaf,) = with_leaves(two_rooms()).moving
    assert (leaf.name, leaf.kind, leaf.is_present) == ("door", MovingKind.DOOR, False)
    assert (leaf.pose.x, leaf.pose.y) == pytest.approx((2.45, 2.0))
    assert (leaf.boxes[0].length, leaf.boxes[0].width) == pytest.approx((0.1, 1.0))


def test_a_door_that_is_shut_for_good_stays_so_and_no_leaf_is_made_twice() -> None:
    assert with_leaves(two_rooms(is_open=False)).moving == ()
    once = with_leaves(two_rooms())
    assert with_leaves(once).moving == once.moving


def test_a_shut_door_stops_the_robot_and_an_open_one_lets_it_through() -> None:
    world = Simulator(with_leaves(two_rooms()), IDEAL, start=AHEAD)
    world.set_door("door", is_shut=True)
    for _ in range(100):
        seen = world.step(Twist(0.3, 0.0), 0.05)
    assert world.pose.x < OPENING.x_min
    assert seen.bumper.pressed
    assert world.ranges.min() < 0.5
    world.set_door("door", is_shut=False)
    for _ in range(100):
        world.step(Twist(0.3, 0.0), 0.05)
    assert world.pose.x > OPENING.x_max


def test_a_door_waits_for_the_robot_that_stands_in_it() -> None:
    world = Simulator(with_leaves(two_rooms()), IDEAL, start=Pose(2.45, 2.0, 0.0))
    world.set_door("door", is_shut=True)
    for _ in range(20):
        world.step(Twist(), 0.05)
    assert world.things[0, 3] == 0.0
    for _ in range(60):
        world.step(Twist(0.3, 0.0), 0.05)
    assert world.things[0, 3] == 1.0
    with pytest.raises(HomeError):
        world.put(Pose(2.45, 2.0, 0.0))


def test_a_door_that_is_not_there_is_named() -> None:
    world = Simulator(with_leaves(two_rooms()), IDEAL, start=AHEAD)
    with pytest.raises(ValueError, match="a door of: door; got 'gate'"):
        world.set_door("gate", is_shut=True)
    assert np.array_equal(world.things[:, 3], [0.0])
