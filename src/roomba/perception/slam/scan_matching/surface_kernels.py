"""Compiled: from the ranges of a scan to points with surface normals.

The normal of a point follows from a line fit to its neighbours in the scan: by total least squares,
over the beams to both sides of it, or to one side where the others met another surface. Running
sums over the beams give each fit in constant time.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, entry, inner_part, part
from roomba.perception.matching.beams import LidarBeams, is_all_around

X: Final = 0
Y: Final = 1
NORMAL_X: Final = 2
NORMAL_Y: Final = 3
POINT: Final = 4
"""Columns of a point: x, y, m, and its surface's unit normal towards the lidar; 0, 0: not known."""

_HALF_SPAN: Final = 0.07
"""m; a normal is fitted over at least so much of the surface to each side."""
_SPAN_IN_DEVIATIONS: Final = 10.0
"""The same, in standard deviations of a range: a noisy lidar needs more of a surface."""
_MOST_BESIDE: Final = 10
_LEAST_BESIDE: Final = 2
_SURELY: Final = 3.0
"""Standard deviations of a range; a normal is fitted over at least so much of the surface to each
side, even by more than ``_MOST_BESIDE`` beams, as close by: over less, noise decides it."""
_WIDEST: Final = 0.8
"""rad; those more beams are so far to each side at most."""
_LEAST_POINTS: Final = 3
_SUMS: Final = 6
_STRAIGHT: Final = 0.009
"""m; root mean square distance from a line, above which points are not on one plane surface."""
_STRAIGHT_IN_DEVIATIONS: Final = 1.8
"""The same, in standard deviations of a range; the larger one counts."""
_GRAZING: Final = 0.12
"""Cosine between a beam and a normal; below it the two points lie on different things."""


@allocating_entry
def room_for_sums(beams: int) -> Floats:
    """Return the work array of :func:`surface_points`."""
    return np.empty((beams + 2 * _most_beside(beams) + 1, _SUMS))


@entry
def surface_points(
    ranges: NDArray[np.float32], lidar: LidarBeams, deviation: float, points: Floats, sums: Floats
) -> int:
    """Fill ``points`` [beams, POINT] from the beams that met something; return how many.

    Points are in the robot's frame, m. ``ranges`` is float32 [beams], m, ``deviation`` the standard
    deviation of a range, m. ``sums`` is a work array from :func:`room_for_sums`.
    """
    beams, directions, mount = ranges.size, lidar.directions, lidar.mount
    straight = max(_STRAIGHT, _STRAIGHT_IN_DEVIATIONS * deviation)
    turn_cosine, turn_sine = math.cos(mount[2]), math.sin(mount[2])
    step = _angle_between(directions, beams)
    most = _most_beside(beams)
    _add_up(ranges, lidar, step, sums)
    count = 0
    for beam in range(beams):
        length = ranges[beam]
        if not lidar.nearest <= length < lidar.farthest:
            continue
        along_x = turn_cosine * directions[beam, 0] - turn_sine * directions[beam, 1]
        along_y = turn_sine * directions[beam, 0] + turn_cosine * directions[beam, 1]
        beside = min(_beams_beside(length, step, deviation), most)
        normal_x, normal_y = 0.0, 0.0
        for side in range(3):
            first = beam if side == 2 else beam - beside
            last = beam if side == 1 else beam + beside
            is_plane, x, y = _normal(sums, most + first, most + last, straight)
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


@part
def _most_beside(beams: int) -> int:
    """Return how many beams to each side of one there are sums for."""
    return max(beams // 2, _LEAST_BESIDE)


@inner_part
def _beams_beside(length: float, step: float, deviation: float) -> int:
    """Return how many beams to each side of one tell how the surface faces that it met.

    ``length`` is its range, m, ``step`` the angle between beams, rad, ``deviation`` that of a
    range, m.
    """
    apart = max(length * step, 1e-6)
    half_span = max(_HALF_SPAN, _SPAN_IN_DEVIATIONS * deviation)
    usual = min(math.ceil(half_span / apart), _MOST_BESIDE)
    by_noise = min(math.ceil(_SURELY * deviation / apart), int(_WIDEST / max(step, 1e-6)))
    return max(usual, by_noise, _LEAST_BESIDE)


@inner_part
def _angle_between(directions: Floats, beams: int) -> float:
    """Return the angle between two neighbouring beams, rad; 1.0 for a single one."""
    if beams < 2:
        return 1.0
    cross = directions[0, 0] * directions[1, 1] - directions[0, 1] * directions[1, 0]
    return abs(math.asin(min(max(cross, -1.0), 1.0)))


@inner_part
def _add_up(ranges: NDArray[np.float32], lidar: LidarBeams, step: float, sums: Floats) -> None:
    """Fill ``sums``, a work array of :func:`room_for_sums`, with running sums over the beams.

    The sums begin :func:`_most_beside` beams before beam 0. A row is for the beams before one: how
    many ended, and the sums of the ends' x, y, squares and product, lidar's frame. A scan that goes
    all around continues at its other end; beyond the ends of any other scan there are no beams.
    """
    beams, directions = ranges.size, lidar.directions
    most = _most_beside(beams)
    is_around = is_all_around(beams, step)
    sums[0] = 0.0
    for row in range(sums.shape[0] - 1):
        place = row - most
        beam = place % beams
        length = ranges[beam]
        for column in range(_SUMS):
            sums[row + 1, column] = sums[row, column]
        if beam != place and not is_around:
            continue
        if not lidar.nearest <= length < lidar.farthest:
            continue
        x, y = length * directions[beam, 0], length * directions[beam, 1]
        after = sums[row + 1]
        after[0] += 1.0
        after[1] += x
        after[2] += y
        after[3] += x * x
        after[4] += x * y
        after[5] += y * y


@inner_part
def _normal(sums: Floats, first: int, last: int, straight: float) -> tuple[bool, float, float]:
    """Return whether beams ``first`` to ``last`` met one plane, and its normal, lidar's frame.

    If the root mean square distance from a line is more than ``straight``, m, there is no plane.
    """
    before, after = sums[first], sums[last + 1]
    count = after[0] - before[0]
    if count < _LEAST_POINTS:
        return False, 0.0, 0.0
    share = 1.0 / count
    x, y = (after[1] - before[1]) * share, (after[2] - before[2]) * share
    xx = (after[3] - before[3]) * share - x * x
    xy = (after[4] - before[4]) * share - x * y
    yy = (after[5] - before[5]) * share - y * y
    half, middle = 0.5 * (xx - yy), 0.5 * (xx + yy)
    spread = math.sqrt(half * half + xy * xy)
    if max(middle - spread, 0.0) > straight * straight:
        return False, 0.0, 0.0
    if spread == 0.0:
        return True, 0.0, 1.0
    # Along the line, by half the angle of (half, xy).
    cosine = math.sqrt(max(0.5 * (1.0 + half / spread), 0.0))
    sine = math.copysign(math.sqrt(max(0.5 * (1.0 - half / spread), 0.0)), xy)
    return True, -sine, cosine
