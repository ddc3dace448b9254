"""Where dead reckoning had the robot in the last seconds: what kernels keep and look up."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry, inner_part

_REMEMBERED: Final = 2.0
"""s; how late a scan may come: the path covers this time, however seldom odometry comes."""
_MOST: Final = 1024
"""Poses that are remembered at most: with more than 500 a second they cover less time."""
_AHEAD: Final = 0.5
"""s; for this time after the newest pose the robot is taken to go on as it did."""
_PAIR: Final = 2
"""Poses that are needed to interpolate between them."""
_NEWEST: Final = 0
_COUNT: Final = 1
"""Places in ``ends``."""


class ReckonedPath(NamedTuple):
    """The newest poses, in the frame of dead reckoning.

    ``rows`` is float64 [n, 4], a ring of stamp, s, x, y, m, and theta, rad; ``ends`` is int64 [2],
    the row of the newest pose, and the number of poses.
    """

    rows: Floats
    ends: NDArray[np.int64]

    @staticmethod
    def empty() -> ReckonedPath:
        """Return a path without a pose."""
        return ReckonedPath(np.zeros((_MOST, 4)), np.zeros(2, np.int64))


@entry
def forget_path(path: ReckonedPath) -> None:
    """Forget all poses."""
    path.ends[_COUNT] = 0


@entry
def remember(path: ReckonedPath, stamp: float, pose: Floats) -> None:
    """Add a pose [3] that is newer than all others, and forget those that no scan needs."""
    rows, ends = path.rows, path.ends
    size = rows.shape[0]
    newest = (ends[_NEWEST] + 1) % size
    rows[newest, 0] = stamp
    for axis in range(3):
        rows[newest, 1 + axis] = pose[axis]
    ends[_NEWEST] = newest
    count = min(ends[_COUNT] + 1, size)
    # The newest pose from before that time stays, to interpolate between it and the next one.
    while count > _PAIR and rows[(newest + 2 - count) % size, 0] < stamp - _REMEMBERED:
        count -= 1
    ends[_COUNT] = count


@inner_part
def is_told_within(path: ReckonedPath, seconds: float) -> bool:
    """Whether the newest two poses are no more than some seconds apart."""
    rows, ends = path.rows, path.ends
    newest = ends[_NEWEST]
    before = (newest - 1) % rows.shape[0]
    return bool(ends[_COUNT] >= _PAIR and rows[newest, 0] - rows[before, 0] <= seconds)


@entry
def pose_at(path: ReckonedPath, stamp: float, pose: Floats) -> bool:
    """Fill ``pose`` [3] with the interpolated pose at a time; after the newest pose with that one.

    Returns whether the pose is known: it is not for a time before all poses.
    """
    rows = path.rows
    earlier, later = _rows_around(path, stamp)
    if earlier < 0:
        return False
    if later < 0:
        for axis in range(3):
            pose[axis] = rows[earlier, 1 + axis]
        return True
    share = (stamp - rows[earlier, 0]) / (rows[later, 0] - rows[earlier, 0])
    for axis in range(1, 3):
        begin = rows[earlier, axis]
        pose[axis - 1] = begin + share * (rows[later, axis] - begin)
    turn = wrapped(rows[later, 3] - rows[earlier, 3])
    pose[2] = wrapped(rows[earlier, 3] + share * turn)
    return True


@inner_part
def _rows_around(path: ReckonedPath, stamp: float) -> tuple[int, int]:
    """Return the rows of the newest pose that is not after a time, and of the next pose.

    A row is -1 if there is no such pose.
    """
    size, newest, later = path.rows.shape[0], path.ends[_NEWEST], -1
    for back in range(path.ends[_COUNT]):
        row = (newest - back) % size
        if not path.rows[row, 0] > stamp:
            return row, later
        later = row
    return -1, later


class Stretch(NamedTuple):
    """A part of the path along which the robot moves with constant velocity.

    The robot is at x, y, m, theta, rad, at ``stamp``, s, and moves by ``speed_x``, ``speed_y``,
    m/s, and ``turning``, rad/s, until ``until``, s.
    """

    stamp: float
    x: float
    y: float
    theta: float
    speed_x: float
    speed_y: float
    turning: float
    until: float


@inner_part
def stretch_at(path: ReckonedPath, stamp: float) -> Stretch:
    """Return the stretch in which a time lies, also for times before or after all poses.

    Before all poses the robot stands at the oldest one. After them it goes on as between the newest
    two, for half a second, and then stands.
    """
    rows, ends = path.rows, path.ends
    size, newest, count = rows.shape[0], ends[_NEWEST], ends[_COUNT]
    if count == 0:
        return Stretch(stamp, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, math.inf)
    earlier, later = _rows_around(path, stamp)
    row = earlier if earlier >= 0 else later
    begin, x, y, theta = rows[row, 0], rows[row, 1], rows[row, 2], rows[row, 3]
    if earlier < 0:
        return Stretch(begin, x, y, theta, 0.0, 0.0, 0.0, begin)
    if count == 1:
        return Stretch(begin, x, y, theta, 0.0, 0.0, 0.0, math.inf)
    if later >= 0:
        until = rows[later, 0]
    else:
        earlier, later, until = (newest - 1) % size, newest, begin + _AHEAD
    seconds = rows[later, 0] - rows[earlier, 0]
    speed_x = (rows[later, 1] - rows[earlier, 1]) / seconds
    speed_y = (rows[later, 2] - rows[earlier, 2]) / seconds
    turning = wrapped(rows[later, 3] - rows[earlier, 3]) / seconds
    if stamp < until:
        return Stretch(begin, x, y, theta, speed_x, speed_y, turning, until)
    x, y, theta = x + _AHEAD * speed_x, y + _AHEAD * speed_y, theta + _AHEAD * turning
    return Stretch(until, x, y, theta, 0.0, 0.0, 0.0, math.inf)


@inner_part
def pose_in(stretch: Stretch, stamp: float) -> tuple[float, float, float]:
    """Return the pose at a time within a stretch; theta is not wrapped."""
    since = stamp - stretch.stamp
    return (
        stretch.x + since * stretch.speed_x,
        stretch.y + since * stretch.speed_y,
        stretch.theta + since * stretch.turning,
    )
