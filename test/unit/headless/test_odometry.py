"""How far wheels and gyro alone are off, on drives of which the truth is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.worn import BASE, TICK, Worn, drive, rooms
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.headless.odometry import PIECE, odometry_error
from roomba.headless.tick_rows import BIAS, GYRO, ODOMETRY, PASSED, TIME, TRUE
from roomba.perception.calibration.calibration import Calibration

ROBOT = RobotConfig()
PLAIN = Calibration(np.zeros(7), np.eye(7), np.zeros(7), 1, BASE)


def rows_of(worn: Worn, legs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the ticks of a drive of which all but the noise is as in a run."""
    told = drive(worn, legs, np.random.default_rng(0), noise=0.0)
    rows = np.zeros((len(told.gyro), PASSED))
    rows[:, TIME] = TICK * np.arange(1, len(rows) + 1)
    pose = np.zeros(3)
    for row, (ahead, aside, turn) in zip(rows, told.steps.tolist(), strict=True):
        cosine, sine = np.cos(pose[2]), np.sin(pose[2])
        pose += np.array([cosine * ahead - sine * aside, sine * ahead + cosine * aside, turn])
        row[ODOMETRY] = pose
    rows[:, TRUE] = told.lidar
    # A sample is the mean over the step before; between two of them it is the mean of both.
    rows[:, GYRO] = told.gyro / TICK
    return rows


def test_a_way_that_is_longer_is_off_by_that() -> None:
    rows = rows_of(Worn(0.01, 0.01), np.array([[20.0, 0.0]]))
    assert odometry_error(rows, ROBOT, None) == pytest.approx(0.01, rel=0.03)


def test_what_is_applied_is_taken_out() -> None:
    random, worn = np.random.default_rng(2), Worn(0.015, 0.005, 0.01, 0.012)
    rows = rows_of(worn, rooms(random))
    before = odometry_error(rows, ROBOT, None)
    after = odometry_error(rows, ROBOT, replace(PLAIN, applied=worn.errors))
    assert before is not None
    assert after is not None
    assert before > 0.008
    assert after < 0.3 * before


def test_a_short_way_tells_nothing() -> None:
    rows = rows_of(Worn(), np.array([[0.9 * PIECE, 0.0]]))
    assert odometry_error(rows, ROBOT, None) is None


def test_what_was_known_of_the_bias_is_taken_out() -> None:
    rows = rows_of(Worn(), rooms(np.random.default_rng(3)))
    exact = odometry_error(rows, ROBOT, None)
    bias = np.linspace(0.002, -0.001, len(rows))
    rows[:, GYRO] += bias
    rows[:, BIAS] = bias
    off = odometry_error(rows, ROBOT, None)
    assert exact is not None
    assert off is not None
    assert off > 1.5 * exact
    assert odometry_error(rows, ROBOT, None, knows_bias=True) == pytest.approx(exact, abs=1e-6)
