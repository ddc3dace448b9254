"""Compiled: dead reckoning over the ticks of a run, once more."""

from __future__ import annotations

from roomba.arrays import Floats
from roomba.compilation import entry
from roomba.perception.localization.belief.belief import Rows
from roomba.perception.localization.belief.reckon_kernels import reckon


@entry
def reckon_rows(beliefs: Rows, numbers: Rows, told: Floats, poses: Floats) -> None:
    """Fill ``poses`` [n, 3] with where dead reckoning has the robot at each tick.

    ``told`` is [n, 5]: time, s, odometry's x, y, m, and theta, rad, and the gyro's speed, rad/s.
    """
    for tick in range(told.shape[0]):
        reckon(
            beliefs, numbers, told[tick, 0], told[tick, 1], told[tick, 2], told[tick, 3],
            told[tick, 4],
        )  # fmt: skip
        for axis in range(3):
            poses[tick, axis] = beliefs[0].reckoned[axis]
