"""Compiled: poses seen from other poses, and how far apart they are."""

from __future__ import annotations

import math

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry


@entry
def beyond(
    x: float, y: float, theta: float, ahead: float, aside: float, turn: float
) -> tuple[float, float, float]:
    """Return the pose, x, y, theta, that lies beyond the pose ``x``, ``y``, ``theta``: m and rad.

    As seen from that pose it lies ``ahead`` and ``aside``, to the left, and is turned by ``turn``.
    """
    cosine, sine = math.cos(theta), math.sin(theta)
    return (
        x + cosine * ahead - sine * aside,
        y + sine * ahead + cosine * aside,
        wrapped(theta + turn),
    )


@entry
def seen_from(pose: Floats, other: Floats) -> tuple[float, float, float]:
    """Return how a pose [3] sees another one, [3]: ahead and to the left, m, and turned, rad."""
    off_x, off_y = other[0] - pose[0], other[1] - pose[1]
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    return cosine * off_x + sine * off_y, cosine * off_y - sine * off_x, wrapped(other[2] - pose[2])


@entry
def pose_then(pose: Floats, reckoned: Floats, then: Floats) -> tuple[float, float, float]:
    """Return where a robot that is at ``pose`` [3] now was on the map before, x, y, theta.

    Dead reckoning has the robot at ``reckoned`` [3] now, and had it at ``then`` [3] before.
    """
    back = seen_from(reckoned, then)
    return beyond(pose[0], pose[1], pose[2], back[0], back[1], back[2])


@entry
def is_apart(pose: Floats, other: Floats, way: float, turn: float) -> bool:
    """Whether two poses [3] are ``way``, m, apart or turned by ``turn``, rad, or more."""
    away = math.hypot(pose[0] - other[0], pose[1] - other[1])
    return away >= way or abs(wrapped(pose[2] - other[2])) >= turn
