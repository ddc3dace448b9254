"""The measured errors of the robot: a part of the belief's row that kernels read and write.

Seven errors, in this order (after Censi, Franchi, Marchionni and Oriolo, "Simultaneous calibration
of odometry and sensor parameters for mobile robots", 2013, but with the wheels' radii and distance
expressed as the errors of odometry that they cause):

==========  =====================================================================================
``WAY``     share by which a way is longer than odometry tells
``TURN``    share by which a turn is larger
``DRIFT``   rad/m by which the robot turns left while odometry tells that it goes straight ahead
``GYRO``    share by which a turn is larger than the gyro tells
``AHEAD``   m by which the lidar sits farther ahead than is told
``LEFT``    m by which it sits farther left
``TURNED``  rad by which its mount, place and heading, is turned to the left about the robot
==========  =====================================================================================
"""

from __future__ import annotations

import math
from typing import Any, Final, TypeAlias

import numpy as np

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.sensors import GyroConfig

Row: TypeAlias = Any
"""A CALIBRATION in a kernel."""

WAY, TURN, DRIFT, GYRO, AHEAD, LEFT, TURNED = range(7)
ERRORS: Final = 7
OF_WHEELS: Final = 3
"""The first errors are those of the wheels."""

CALIBRATION: Final = np.dtype(
    [
        ("errors", "f8", (ERRORS,)),  # as measured
        ("covariance", "f8", (ERRORS, ERRORS)),
        ("applied", "f8", (ERRORS,)),  # those that dead reckoning and the lidar are corrected by
        ("is_applied", "?"),  # whether any of the wheels' or the gyro's errors is
        ("is_lidar_due", "?"),  # whether errors of the lidar are to be applied anew
        ("base", "f8"),  # m; between the wheels, 0: not known
        ("windows", "i8"),  # measured so far
        ("outliers", "i8"),  # numbers that fitted badly, of four in a window (three without gyro)
        ("gyro_bias", "f8"),  # rad/s; of the gyro, besides what it showed while the robot stood
        ("gyro_bias_variance", "f8"),  # rad2/s2
        # the window under way
        ("is_open", "?"),
        ("begin", "f8", (3,)),  # pose of the lidar, less its configured mount
        ("begin_variance", "f8", (2,)),  # of that: m2, rad2
        ("moved", "f8", (3,)),  # motion since then by the wheels, less their errors
        ("slopes", "f8", (3, OF_WHEELS)),  # derivatives of that by the wheels' errors
        ("gyro", "f8"),  # rad; turned by the gyro as it tells
        ("has_gyro", "?"),
        ("way", "f8"),  # m
        ("turned", "f8"),  # rad, either way
        ("time", "f8"),  # s
        ("newest_turn", "f8"),  # rad; of the newest step, by the wheels
        ("turning", "f8"),  # rad/s; in that step, either way
        # what does not change
        ("prior", "f8", (ERRORS,)),  # variances
        ("least", "f8", (ERRORS,)),
        ("sure", "f8"),
        ("window_way", "f8"),
        ("window_turn", "f8"),
        ("forgetting_way", "f8"),
        ("way_variance", "f8"),  # as of roomba.perception.localization.belief.belief.NUMBERS
        ("side_variance", "f8"),
        ("wheel_variance", "f8"),
        ("turn_variance", "f8"),
        ("drift_variance", "f8"),
        ("bias", "f8"),  # rad/s; deviation of the gyro's at the start
        ("bias_walk", "f8"),  # rad2/s3; by which its variance grows
        ("work", "f8", (8, ERRORS)),  # what the kernel works in; means nothing between two calls
    ],
    align=True,
)


def forget_wheels(row: Row, localization: LocalizationConfig) -> None:
    """Forget the errors of the wheels, as odometry has another source now; keep lidar and gyro."""
    wheels = slice(OF_WHEELS)
    row["errors"][wheels] = row["applied"][wheels] = 0.0
    row["covariance"][wheels] = row["covariance"][:, wheels] = 0.0
    row["covariance"][wheels, wheels] = np.diag(row["prior"][wheels])
    row["is_applied"] = row["applied"][GYRO] != 0.0
    row["is_open"] = False
    _set_noise(row, localization)


def begin_calibration(row: Row, localization: LocalizationConfig, gyro: GyroConfig) -> None:
    """Begin with priors and noise from the configuration, and with nothing measured."""
    config = localization.calibration
    turn, least_turn = math.radians(config.turn), math.radians(config.least_turn)
    prior = [config.scale] * 2 + [config.drift, config.scale] + [config.shift] * 2 + [turn]
    least = [config.least_scale] * 2 + [config.least_drift, config.least_gyro]
    least += [config.least_shift] * 2 + [least_turn]
    row["prior"], row["least"] = np.square(prior), least
    row["errors"] = row["applied"] = 0.0
    row["covariance"] = np.diag(row["prior"])
    row["sure"] = config.sure
    for name in ("window_way", "window_turn", "forgetting_way"):
        row[name] = getattr(config, name)
    _set_noise(row, localization)
    row["bias"] = gyro.bias
    row["gyro_bias"], row["gyro_bias_variance"] = 0.0, gyro.bias**2
    row["bias_walk"] = gyro.bias**2 / config.bias_time


def _set_noise(row: Row, localization: LocalizationConfig) -> None:
    row["way_variance"] = localization.way_noise**2
    row["side_variance"] = localization.side_noise**2
    row["wheel_variance"] = localization.wheel_turn_noise**2
    row["turn_variance"] = localization.turn_noise**2
    row["drift_variance"] = localization.gyro_drift**2
