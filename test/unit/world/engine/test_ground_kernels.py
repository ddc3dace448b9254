"""Cliff sensors and wheel drops at stairs."""

from __future__ import annotations

import math

import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import drive
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.world.observation import Cliff
from roomba.world.simulator import Simulator

CONFIG = SimulatedRobotConfig()
EDGE = 3.0
HOME = room_home(stairs=((EDGE, 0.0, 5.0, 4.0),))
HALF_TRACK = 0.5 * CONFIG.body.wheel_separation


@settings(max_examples=examples(60))
@given(st.floats(0.3, 4.7), st.floats(0.3, 3.7), st.floats(-3.1, 3.1))
def test_each_sensor_tells_whether_floor_is_under_it(x: float, y: float, theta: float) -> None:
    world = Simulator(HOME, start=Pose(1.0, 2.0, 0.0))
    world.put(Pose(x, y, theta))
    seen = world.step(Twist(), 0.025)
    expected = [
        x + CONFIG.cliff.radius * math.cos(theta + math.radians(angle)) >= EDGE
        for angle in CONFIG.cliff.angles
    ]
    assert seen.cliff == Cliff(*expected)
    assert seen.cliff.any == any(expected)
    assert seen.wheels.dropped_left == (x - HALF_TRACK * math.sin(theta) >= EDGE)
    assert seen.wheels.dropped_right == (x + HALF_TRACK * math.sin(theta) >= EDGE)


def test_the_cliff_is_seen_before_a_wheel_drops() -> None:
    world = Simulator(HOME, start=Pose(2.0, 2.0, 0.0))
    for _ in range(200):
        seen = world.step(Twist(0.3, 0.0), 0.025)
        if seen.cliff.any:
            break
    assert seen.cliff.front_left or seen.cliff.front_right
    assert not seen.cliff.left
    assert not seen.cliff.right
    assert not seen.wheels.dropped_left
    brake = 0.3**2 / (2.0 * CONFIG.body.max_deceleration)
    assert seen.pose.x + brake < EDGE
    assert not drive(world, 0.0, 0.0, 1.0).wheels.dropped_left


def test_who_drives_over_the_edge_hangs_there_and_his_wheels_turn_in_the_air() -> None:
    world = Simulator(HOME, start=Pose(2.0, 2.0, 0.0))
    hanging = drive(world, 0.3, 0.0, 5.0)
    assert hanging.wheels.dropped_left
    assert hanging.wheels.dropped_right
    assert EDGE <= hanging.pose.x <= EDGE + 0.31 * 0.025
    later = drive(world, -0.3, 1.0, 3.0)
    assert later.pose == hanging.pose
    assert later.wheels.left < hanging.wheels.left
    assert later.odometry != hanging.odometry


def test_a_wheel_in_the_air_has_no_grip_while_the_other_turns_the_body() -> None:
    world = Simulator(HOME, start=Pose(2.6, 2.0, math.radians(-60.0)))
    for _ in range(400):
        seen = world.step(Twist(0.2, 0.0), 0.025)
        if seen.wheels.dropped_left:
            break
    assert seen.wheels.dropped_left
    assert not seen.wheels.dropped_right
    turned = drive(world, 0.2, 0.0, 0.1)
    # Only the right wheel drives: the body turns to the left, and goes half as far. Its way is off
    # by the slip, some 0.5 %.
    assert turned.pose.theta == pytest.approx(
        seen.pose.theta + 0.2 * 0.1 / CONFIG.body.wheel_separation, abs=3e-3
    )
    assert turned.pose.distance_to(seen.pose.x, seen.pose.y) == pytest.approx(0.01, abs=3e-4)
    assert turned.twist.linear == pytest.approx(0.1, rel=0.03)


def test_where_no_stairs_are_nothing_is_felt() -> None:
    world = Simulator(room_home())
    seen = drive(world, 0.3, 0.4, 5.0)
    assert not seen.cliff.any
    assert not seen.wheels.dropped_left
    assert not seen.wheels.dropped_right
