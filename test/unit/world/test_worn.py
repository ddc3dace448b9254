"""Worn wheels, gyro and lidar are off by what the seed draws, and carpets pull."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import IDEAL, NOISY

from roomba.geometry import Pose, Twist
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

WORN = IDEAL.with_wheels("worn")
WEAR = WORN.simulation.wear
BASE = WORN.body.wheel_separation
START = Pose(2.0, 2.0, 0.4)


def simulator(seed: int, home: Home | None = None) -> Simulator:
    return Simulator(home or room_home(8.0, 6.0), WORN, seed=seed, start=START)


def test_errors_stay_within_what_the_configuration_says_and_differ() -> None:
    drawn = []
    for seed in range(12):
        told = simulator(seed).numbers
        drawn.append(
            [
                (told["roll_left"] - 1.0) / WEAR.wheel,
                (told["roll_right"] - 1.0) / WEAR.wheel,
                (told["track"] / BASE - 1.0) / WEAR.base,
                (told["gyro_scale"] - 1.0) / WEAR.gyro,
                told["lidar_x"] / WEAR.lidar_shift,
                told["lidar_y"] / WEAR.lidar_shift,
                math.degrees(told["lidar_turn"]) / WEAR.lidar_turn,
            ]
        )
    assert np.abs(drawn).max() <= 1.0
    assert np.abs(drawn).max(axis=0).min() > 0.5
    assert np.std(drawn, axis=0).min() > 0.3


def test_a_robot_from_the_factory_has_none() -> None:
    told = Simulator(room_home(4.0, 4.0), NOISY, seed=3, start=Pose(2.0, 2.0, 0.0)).numbers
    assert (told["roll_left"], told["roll_right"], told["track"]) == (1.0, 1.0, BASE)
    assert (told["lidar_x"], told["lidar_y"], told["lidar_turn"]) == (0.0, 0.0, 0.0)


def test_wheels_turn_as_told_and_the_robot_goes_where_they_lead() -> None:
    for seed in range(3):
        world = simulator(seed)
        world.advance(Twist(0.2, 0.1), 0.025, 400)
        seen, told = world.observe(), world.numbers
        left, right = told["wheel_left"] * 0.036, told["wheel_right"] * 0.036
        over = left * told["roll_left"], right * told["roll_right"]
        turned = (over[1] - over[0]) / told["track"]
        assert seen.pose.theta - START.theta == pytest.approx(turned, abs=1e-6)
        assert told["distance"] == pytest.approx(0.5 * sum(over), abs=1e-6)
        assert seen.odometry.theta == pytest.approx((right - left) / BASE, abs=1e-6)
        assert abs(seen.odometry.theta - turned) > 1e-3


def test_the_gyro_is_off_by_its_scale() -> None:
    world = simulator(1)
    world.advance(Twist(0.0, 1.0), 0.025, 40)
    before = world.observe().pose.theta
    world.advance(Twist(0.0, 1.0), 0.025, 1)
    turned = (world.observe().pose.theta - before) / 0.025
    scale = world.numbers["gyro_scale"]
    assert world.observe().angular_velocity == pytest.approx(scale * turned, rel=1e-6)
    assert abs(scale - 1.0) > 1e-4


def test_the_lidar_sees_from_where_it_sits() -> None:
    world = simulator(2)
    world.advance(Twist(), 0.025, 8)
    told = world.numbers
    beside = START.compose(Pose(told["lidar_x"], told["lidar_y"], told["lidar_turn"]))
    plain = Simulator(room_home(8.0, 6.0), IDEAL, seed=2, start=beside)
    plain.advance(Twist(), 0.025, 8)
    assert world.ranges == pytest.approx(plain.ranges, abs=2e-4)
    other = Simulator(room_home(8.0, 6.0), IDEAL, seed=2, start=START)
    other.advance(Twist(), 0.025, 8)
    assert np.abs(world.ranges - other.ranges).max() > 2e-3
