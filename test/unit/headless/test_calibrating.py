"""A robot with worn wheels finds out by how much they are off while it cleans or explores."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.worlds import NOISY
from fixtures.robots.missions import TWO_ROOMS
from numpy.typing import NDArray

from roomba.clean_request import CleanRequest
from roomba.configuration.mapping import MappingConfig
from roomba.headless.mission import HeadlessMission
from roomba.headless.odometry import odometry_error
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.calibration.state import DRIFT

WORN = NOISY.with_wheels("worn")
NEAR = np.array([0.007, 0.007, 0.015, 0.002, 0.004, 0.004, 0.006])
"""Of each error, what is near enough; wheels always slip a little."""


def true_errors(robot: HeadlessMission) -> NDArray[np.float64]:
    told = robot.simulator.numbers
    left = told["roll_left"] / told["wheel_left_size"]
    right = told["roll_right"] / told["wheel_right_size"]
    way, base = 0.5 * (left + right), told["track"] / WORN.body.wheel_separation
    drift = (right - left) / told["track"]
    gyro = 1.0 / told["gyro_scale"] - 1.0
    lidar = told["lidar_x"], told["lidar_y"], told["lidar_turn"]
    return np.array([way - 1.0, way / base - 1.0, drift, gyro, *lidar])


def measured(robot: HeadlessMission) -> Calibration:
    return Calibration.of(robot.brain.keeper.place.belief)


@pytest.mark.parametrize("seed", [1, 2])
def test_it_finds_them_while_it_cleans(seed: int) -> None:
    robot = HeadlessMission(TWO_ROOMS, WORN, seed=seed)
    robot.mission.clean(CleanRequest(), robot.senses())
    while robot.seen.time < 400.0:
        robot.advance()
    known, true = measured(robot), true_errors(robot)
    assert known.windows > 40
    assert np.all(np.abs(known.errors - true) < NEAR)
    assert known.applied.any()
    if abs(true[DRIFT]) < 2.0 * WORN.localization.calibration.least_drift:
        return  # too little for its wheels to be corrected
    before = odometry_error(robot.passed, WORN, None, has_gyro=False)
    after = odometry_error(robot.passed, WORN, known, has_gyro=False)
    assert before is not None
    assert after is not None
    assert after < 0.5 * before


def test_it_finds_them_while_it_makes_its_map_and_keeps_them_after() -> None:
    robot = HeadlessMission(TWO_ROOMS, WORN, seed=1, known=MappingConfig())
    robot.mission.clean(CleanRequest(), robot.senses())
    windows = 0
    while robot.seen.time < 400.0:
        robot.advance()
        assert measured(robot).windows >= windows
        windows = measured(robot).windows
    assert np.all(np.abs(measured(robot).errors - true_errors(robot)) < 2.0 * NEAR)


def test_one_from_the_factory_drives_as_before() -> None:
    robot = HeadlessMission(TWO_ROOMS, NOISY, seed=1)
    robot.mission.clean(CleanRequest(), robot.senses())
    while robot.seen.time < 300.0:
        robot.advance()
    assert measured(robot).windows > 30
    assert not measured(robot).applied.any()
