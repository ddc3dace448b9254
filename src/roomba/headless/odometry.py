"""The error of dead reckoning over a run, with and without the robot's calibration."""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.robot import RobotConfig
from roomba.headless.odometry_kernels import reckon_rows
from roomba.headless.tick_rows import BIAS, GYRO, ODOMETRY, TIME, TRUE
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.localization.dead_reckoning import DeadReckoning

PIECE: Final = 5.0
"""m; the way over which errors gather."""


def odometry_error(
    rows: Floats,
    robot: RobotConfig,
    calibration: Calibration | None,
    *,
    has_gyro: bool = True,
    knows_bias: bool = False,
) -> float | None:
    """Return the mean error of dead reckoning after each :data:`PIECE` of way, m per m.

    ``rows`` is float64 [n, PASSED], as of :mod:`roomba.headless.tick_rows`. The error of a piece is
    the distance between the true position at its end and the one by wheels and gyro, both seen from
    where the piece began; the mean is divided by the length of a piece. None if the way is shorter
    than a piece. ``calibration`` None: without any; ``has_gyro`` False: by the wheels alone.
    ``knows_bias``: the gyro's bias that the robot knew at each tick is taken out first.
    """
    true = rows[:, TRUE]
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(true[:, :2], axis=0).T))))
    ends = np.flatnonzero(np.diff(np.floor(way / PIECE), prepend=0.0))
    ends = np.concatenate(([0], ends))
    if len(ends) < 2:
        return None
    told = rows.copy()
    if not has_gyro:
        told[:, GYRO] = np.nan
    elif knows_bias:
        told[:, GYRO] -= rows[:, BIAS]
    poses = reckoned(told, robot, calibration)
    off = _moved(poses[ends]) - _moved(true[ends])
    return float(np.hypot(off[:, 0], off[:, 1]).mean() / PIECE)


def reckoned(rows: Floats, robot: RobotConfig, calibration: Calibration | None) -> Floats:
    """Return where dead reckoning has the robot at each tick, float64 [n, 3], in its own frame."""
    reckoning = DeadReckoning(robot.localization, robot.gyro)
    if calibration is not None:
        calibration.take_up(reckoning.belief)
    reckoning.belief["calibration"]["base"] = robot.body.wheel_separation
    told = np.column_stack((rows[:, TIME], rows[:, ODOMETRY], rows[:, GYRO]))
    poses = np.empty((len(rows), 3))
    reckon_rows(reckoning.belief, reckoning.numbers, told, poses)
    return poses


def _moved(poses: Floats) -> Floats:
    """Return how each pose sees the next one, float64 [n - 1, 2]: ahead and left, m."""
    off = np.diff(poses[:, :2], axis=0)
    cosine, sine = np.cos(poses[:-1, 2]), np.sin(poses[:-1, 2])
    return np.column_stack(
        (cosine * off[:, 0] + sine * off[:, 1], cosine * off[:, 1] - sine * off[:, 0])
    )
