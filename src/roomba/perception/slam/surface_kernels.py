"""Compiled: from the ranges of a scan to points on surfaces, and the ways these face."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]

X: Final = 0
Y: Final = 1
NORMAL_X: Final = 2
NORMAL_Y: Final = 3
POINT: Final = 4
"""Columns of a point: x, y, m, and its surface's unit normal towards the lidar; 0, 0: not known."""

_HALF_SPAN: Final = 0.07
"""m; so far to each side a surface is looked at, to know how it faces in spite of the noise."""
_MOST_BESIDE: Final = 10
_LEAST_BESIDE: Final = 2
_LEAST_POINTS: Final = 3
_STRAIGHT: Final = 0.009
"""m; root mean square off a line, above which points are not of one plane surface."""
_GRAZING: Final = 0.12
"""Cosine between a beam and a normal; below it the two points lie on different things."""


@njit(cache=True, nogil=True, error_model="numpy")
def surface_points(
    ranges: NDArray[np.float32],
    directions: Floats,
    mount: Floats,
    nearest: float,
    farthest: float,
    points: Floats,
) -> int:
    """Fill ``points`` [beams, 4] from the beams that met something; return how many.

    Robot's frame. ``directions`` is [beams, 2], cosine and sine in the lidar's frame, evenly
    spaced all around or over an arc; ``mount`` x, y, theta of the lidar in the robot's frame.
    """
    beams = ranges.size
    turn_cosine, turn_sine = math.cos(mount[2]), math.sin(mount[2])
    step = _angle_between(directions, beams)
    count = 0
    for beam in range(beams):
        length = ranges[beam]
        if not nearest <= length <= farthest:
            continue
        along_x = turn_cosine * directions[beam, 0] - turn_sine * directions[beam, 1]
        along_y = turn_sine * directions[beam, 0] + turn_cosine * directions[beam, 1]
        beside = math.ceil(_HALF_SPAN / max(length * step, 1e-6))
        beside = min(max(beside, _LEAST_BESIDE), _MOST_BESIDE)
        normal_x, normal_y = 0.0, 0.0
        for side in range(3):
            first = beam if side == 2 else beam - beside
            last = beam if side == 1 else beam + beside
            is_plane, x, y = _normal(ranges, directions, first, last, nearest, farthest)
            if is_plane:
                normal_x = turn_cosine * x - turn_sine * y
                normal_y = turn_sine * x + turn_cosine * y
                facing = -(normal_x * along_x + normal_y * along_y)
                if facing < 0.0:
                    normal_x, normal_y, facing = -normal_x, -normal_y, -facing
                if facing >= _GRAZING:
                    break
                normal_x, normal_y = 0.0, 0.0
        points[count, X] = mount[0] + length * along_x
        points[count, Y] = mount[1] + length * along_y
        points[count, NORMAL_X], points[count, NORMAL_Y] = normal_x, normal_y
        count += 1
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _angle_between(directions: Floats, beams: int) -> float:
    if beams < 2:
        return 1.0
    cross = directions[0, 0] * directions[1, 1] - directions[0, 1] * directions[1, 0]
    return abs(math.asin(min(max(cross, -1.0), 1.0)))


@njit(cache=True, nogil=True, error_model="numpy")
def _normal(
    ranges: NDArray[np.float32],
    directions: Floats,
    first: int,
    last: int,
    nearest: float,
    farthest: float,
) -> tuple[bool, float, float]:
    """Return whether beams ``first`` to ``last`` met one plane, and its normal, lidar's frame."""
    beams = ranges.size
    count = 0
    sum_x = sum_y = sum_xx = sum_xy = sum_yy = 0.0
    for each in range(first, last + 1):
        beam = each % beams
        length = ranges[beam]
        if not nearest <= length <= farthest:
            continue
        x, y = length * directions[beam, 0], length * directions[beam, 1]
        sum_x += x
        sum_y += y
        sum_xx += x * x
        sum_xy += x * y
        sum_yy += y * y
        count += 1
    if count < _LEAST_POINTS:
        return False, 0.0, 0.0
    xx = sum_xx / count - (sum_x / count) ** 2
    yy = sum_yy / count - (sum_y / count) ** 2
    xy = sum_xy / count - sum_x * sum_y / count**2
    half, middle = 0.5 * (xx - yy), 0.5 * (xx + yy)
    spread = math.hypot(half, xy)
    off = max(middle - spread, 0.0)
    if off > _STRAIGHT * _STRAIGHT:
        return False, 0.0, 0.0
    along = 0.5 * math.atan2(xy, half)
    return True, -math.sin(along), math.cos(along)
