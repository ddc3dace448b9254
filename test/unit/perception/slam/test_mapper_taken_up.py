"""A map that is being made, taken up by another mapper: it knows what the first one knew."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.mapped import AROUND, CIRCLE, FURNISHED, Mapped, driven_around, wrong_cells

from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose, Twist
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.mapper_state import MapperState

WORST = 0.03


def state_of(robot: Mapped) -> MapperState:
    state = robot.mapper.state()
    assert state is not None
    return state


def taken_up(robot: Mapped, here: Pose, state: MapperState | None = None) -> Mapped:
    """Let another mapper go on, which takes the robot to be ``here``."""
    config = robot.world.config
    robot.mapper = Mapper.taken_up(
        MappingConfig(), config.localization, config.gyro, state or state_of(robot), here
    )
    robot.worst = 0.0
    return robot


def test_before_the_first_scan_there_is_nothing_to_keep() -> None:
    assert Mapped().mapper.state() is None


@pytest.mark.parametrize("seconds", [0.5, 9.0, 25.0])
def test_it_knows_what_the_first_one_knew(seconds: float) -> None:
    robot = driven_around(1, seconds)
    first, here = robot.mapper, robot.mapper.pose
    second = taken_up(robot, here).mapper
    assert second.version > first.version
    assert second.pose == here
    assert (second.trajectory == first.trajectory).all()
    grown, before = second.occupancy(), first.occupancy()
    assert grown.frame.extent == pytest.approx(before.frame.extent, abs=0.11)
    assert grown.free_area == pytest.approx(before.free_area, rel=0.01)
    assert wrong_cells(grown, FURNISHED) == (0, 0)
    assert robot.knowledge is Knowledge.ROUGH, "no scan has told yet"
    # Of the same keyframes and links the same becomes, bit for bit.
    finished, other = first.finish(), second.finish()
    assert finished.frame == other.frame
    assert (finished.values == other.values).all()


@pytest.mark.parametrize(
    "off", [Pose(), Pose(0.2, -0.05, 0.0), Pose(-0.1, 0.15, 0.1), Pose(0.05, 0.1, -0.12)]
)
@pytest.mark.parametrize("seconds", [4.0, 14.0])
def test_off_by_the_wheels_it_finds_back_and_goes_on(off: Pose, seconds: float) -> None:
    robot = driven_around(0, seconds)
    taken_up(robot, robot.mapper.pose.compose(off))
    version = robot.mapper.version
    robot.drive(Twist(), 0.3)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.error < WORST
    assert robot.turn_error < math.radians(1.0)
    robot.worst = 0.0
    robot.drive(CIRCLE, AROUND)
    assert robot.mapper.version > version + 20
    assert robot.worst < WORST
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)


def test_what_was_driven_since_is_made_up_for() -> None:
    """It was saved 3 s before the robot was followed no more, and that took another second."""
    robot = driven_around(2, 12.0)
    old = state_of(robot)
    robot.drive(CIRCLE, 3.0)
    odometry = robot.world.observe().odometry
    map_to_odometry = robot.mapper.map_to_odometry
    assert (
        map_to_odometry.compose(odometry).distance_to(robot.mapper.pose.x, robot.mapper.pose.y)
        < 0.01
    )
    for _ in range(100):
        robot.world.step(CIRCLE, 0.01)
    here = map_to_odometry.compose(robot.world.observe().odometry)
    taken_up(robot, here, old).drive(Twist(), 0.3)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.error < WORST
    robot.drive(CIRCLE, AROUND)
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)


def test_far_from_what_it_saw_last_it_knows_what_it_saw_there_before() -> None:
    """It drove on to the last of three rooms; while no mapper ran it came to the first."""
    home = room_home(10.0, 2.4, ((3.3, 0.0, 3.4, 1.6), (6.6, 0.8, 6.7, 2.4), (8.0, 2.0, 8.6, 2.4)))
    robot = Mapped(home, Pose(9.0, 0.4, math.pi)).drive(Twist(0.3, 0.0), 13.5)
    robot.drive(Twist(0.0, -0.5), math.pi).drive(Twist(0.3, 0.0), 5.2)
    robot.drive(Twist(0.0, 0.5), math.pi).drive(Twist(0.3, 0.0), 11.0)
    assert robot.worst < WORST
    assert robot.world.pose.x < 2.0
    back = Pose(9.1, 1.2, 2.5)
    robot.world.put(back)
    taken_up(robot, back.compose(Pose(0.05, 0.05, 0.03))).drive(Twist(), 0.3)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.error < WORST


def test_put_elsewhere_meanwhile_it_draws_nothing_wrong() -> None:
    robot = driven_around(1, 8.0)
    here = robot.mapper.pose
    robot.world.put(Pose(1.0, 3.2, 2.0))
    taken_up(robot, here)
    version = robot.mapper.version
    for _ in range(5):
        robot.drive(Twist(0.0, 0.3), 0.2)
        assert robot.knowledge is Knowledge.ROUGH
    assert robot.mapper.version == version


def test_who_was_lost_is_lost_until_told() -> None:
    robot = driven_around(0, 8.0)
    robot.mapper.lift(True)
    state = state_of(robot)
    assert state.is_lost
    taken_up(robot, robot.mapper.pose, state).drive(Twist(), 0.3)
    assert "was lifted" in robot.mapper.estimate.reason
    robot.mapper.told(robot.world.pose)
    robot.drive(CIRCLE, 3.0)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.worst < WORST


def test_a_state_is_of_its_moment() -> None:
    """What comes later does not change it: another thread may be saving it."""
    robot = driven_around(0, 6.0)
    state = state_of(robot)
    frames = [len(submap.keyframes) for submap in state.submaps]
    poses, links = state.poses.copy(), len(state.links)
    robot.drive(CIRCLE, AROUND)
    robot.mapper.finish()
    assert [len(submap.keyframes) for submap in state.submaps] == frames
    assert np.array_equal(state.poses, poses)
    assert len(state.links) == links
