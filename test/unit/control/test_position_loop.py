import itertools
import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.robot import RobotConfig
from roomba.control.position_loop import PositionLoop
from roomba.geometry import Pose, Twist
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator

CONFIG = RobotConfig()
DT = 0.025


def loop() -> PositionLoop:
    return PositionLoop(CONFIG.control, CONFIG.body)


def drive(start: Pose, target: tuple[float, float], seconds: float) -> list[Observation]:
    """Close the loop with the simulated body: the loop at 20 Hz, a tick late, the body at 40."""
    world = Simulator(room_home(), start=start)
    position_loop = loop()
    seen = [world.observe()]
    late = Twist()
    for step in range(int(seconds / DT)):
        if step % 2 == 0:
            command, late = late, position_loop.tick(seen[-1].pose, target, 0.5)
        seen.append(world.step(command, DT))
    return seen


@settings(max_examples=examples(40))
@given(st.floats(0.4, 4.6), st.floats(0.4, 3.6), st.floats(-3.1, 3.1))
def test_it_arrives_and_stands(x: float, y: float, theta: float) -> None:
    seen = drive(Pose(2.5, 2.0, theta), (x, y), 14.0)
    assert seen[-1].pose.distance_to(x, y) < 0.03
    assert seen[-1].twist.linear == pytest.approx(0.0, abs=1e-3)
    assert not any(observation.bumper.pressed for observation in seen)


def test_it_drives_nearly_straight() -> None:
    seen = drive(Pose(0.5, 0.5, 0.0), (4.0, 3.0), 14.0)
    way = sum(
        before.pose.distance_to(after.pose.x, after.pose.y)
        for before, after in itertools.pairwise(seen)
    )
    assert way < 1.01 * math.hypot(3.5, 2.5)


def test_it_turns_on_the_spot_for_what_lies_behind() -> None:
    twist = loop().tick(Pose(), (-1.0, 0.1), 0.5)
    assert twist.linear == 0.0
    assert twist.angular > 1.0


def test_the_speed_given_is_not_exceeded() -> None:
    assert loop().tick(Pose(), (5.0, 0.0), 0.2).linear == pytest.approx(0.2)


def test_near_its_setpoint_it_is_slow() -> None:
    assert loop().tick(Pose(), (0.05, 0.0), 0.5).linear < 0.25


def test_having_arrived_it_does_not_dance() -> None:
    position_loop = loop()
    assert position_loop.tick(Pose(), (0.01, 0.0), 0.5) == Twist()
    assert position_loop.arrived
    assert position_loop.tick(Pose(-0.018, 0.0, 0.0), (0.01, 0.0), 0.5) == Twist()
    assert position_loop.tick(Pose(-0.04, 0.0, 0.0), (0.01, 0.0), 0.5).linear > 0.0


def test_a_robot_that_rolled_on_after_it_arrived_goes_back_until_a_walk_arrives() -> None:
    position_loop = loop()
    for rolled in np.arange(0.0, 0.1, 0.005):
        position_loop.tick(Pose(), (0.01, 0.0), 0.5)
        assert position_loop.arrived
        pose = Pose(0.01, rolled, 1.0)
        stands = position_loop.tick(pose, (0.01, 0.0), 0.5) == Twist()
        assert not stands or pose.distance_to(0.01, 0.0) <= CONFIG.walk.arrival_tolerance


def test_a_new_wish_counts_however_near() -> None:
    position_loop = loop()
    position_loop.tick(Pose(), (0.01, 0.0), 0.5)
    assert position_loop.arrived
    assert position_loop.tick(Pose(), (0.06, 0.0), 0.5).linear > 0.0
