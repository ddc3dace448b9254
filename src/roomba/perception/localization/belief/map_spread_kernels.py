"""Compiled: how far the map's own errors pull a pose off, and where in their cells its walls are.

Walls lie anywhere in their cells, and some have moved since the map was made. All beams on one wall
err together, and so do all scans from near by: more of them make the pose no surer. How far walls
are off is learned from their residuals where a scan fits best. The covariance of the pose follows
from that (the cluster-robust covariance; Liang and Zeger, Biometrika 73, 1986).
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.compilation import allocating_part, inner_part
from roomba.perception.localization.belief.belief import Row
from roomba.perception.matching.field_kernels import Field, Place, look
from roomba.perception.matching.match_kernels import invert

_GROUPS: Final = 16
"""Groups of neighbouring beams; consecutive groups that face alike are one wall."""
_LOOKED_AT: Final = 96
"""Beams that are looked at, at most: six of a group tell how far the group is off."""
_ALIKE: Final = 0.8
"""Cosine of the angle between surfaces that face alike."""
_LARGEST: Final = (0.3, 0.3, 0.15)
"""m, rad; limits of the map's errors along directions of which a scan tells nothing."""
_LEAST_WEIGHT: Final = 5.0
"""Beams that must end near surfaces, by weight."""
_LEAST_WALLS: Final = 20.0
"""Walls from which on the estimate of how far walls are off is relied on."""
_FREE: Final = 3.0
"""Degrees of freedom that a match takes from the walls: x, y and theta."""

OFFSET: Final = 0
OFFSET_BEAMS: Final = 1
APART: Final = 2
APART_WALLS: Final = 3
"""Places in ``told`` of :func:`map_spread`."""


@inner_part
def wall_variance_of(belief: Row, place: Place) -> float:
    """Return the variance of a wall's true place against the map, m2."""
    apart = belief.walls_apart
    # A wall lies anywhere in its cell: if few walls in sight agree, others may be off all the same.
    variance: float = max(apart[0] / max(apart[1], _LEAST_WALLS), of_cell(place))
    return variance


@inner_part
def of_cell(place: Place) -> float:
    """Return the variance of a wall's place within its cell of the map, m2: it is uniform."""
    variance: float = place[2] * place[2] / 12.0
    return variance


@allocating_part
def map_spread(
    field: Field,
    place: Place,
    ends: Floats,
    count: int,
    pose: Floats,
    wall_variance: float,
    offset_variance: float,
    spread: Floats,
    told: Floats,
) -> bool:
    """Fill ``spread`` [3, 3] with the pose's covariance by the map's errors; tell if there is one.

    ``pose`` [3] is where the first ``count`` of ``ends`` [n, 4] were matched to. Each wall is off
    with ``wall_variance``, m2, and all walls have an offset in common, with ``offset_variance``.
    What the scan says of the walls goes to ``told`` [4]: the common offset, m, times its
    information, in beams; that information; the sum of squares of the walls' residuals, m2; and the
    number of walls less the degrees of freedom that the match takes.
    """
    size = max(1, -(-min(count, _LOOKED_AT) // _GROUPS))
    step = count / (size * _GROUPS)
    information, walls, gradient = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros(3)
    of_group, of_wall = np.zeros(5), np.zeros(5)
    common, slope, inverse = np.zeros(3), np.empty(3), np.empty((3, 3))
    weights = 0.0
    told[:] = 0.0
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    for number in range(size * _GROUPS):
        end = ends[int(number * step)]
        x, y = cosine * end[0] - sine * end[1], sine * end[0] + cosine * end[1]
        off, slope[0], slope[1] = look(field, place, pose[0] + x, pose[1] + y)
        slope[2] = slope[1] * x - slope[0] * y
        share = off / place[2]
        weight = 1.0 / (1.0 + share * share)
        weight *= weight
        weights += weight
        told[OFFSET] += weight * off
        of_group[3] += weight * off
        of_group[4] += weight
        for row in range(3):
            of_group[row] += weight * slope[row]
            common[row] += weight * slope[row]
            gradient[row] += weight * off * slope[row]
            for column in range(3):
                information[row, column] += weight * slope[row] * slope[column]
        if (number + 1) % size == 0:
            if not _faces_alike(of_wall, of_group):
                _end_wall(of_wall, walls, told)
            of_wall += of_group
            of_group[:] = 0.0
    _end_wall(of_wall, walls, told)
    if weights < _LEAST_WEIGHT:
        return False
    for axis in range(3):
        information[axis, axis] += 1e-4 / (_LARGEST[axis] * _LARGEST[axis])
    if not invert(information, inverse):
        return False
    for row in range(3):
        for column in range(3):
            walls[row, column] *= wall_variance
            walls[row, column] += offset_variance * common[row] * common[column]
    told[OFFSET_BEAMS] = weights
    told[APART_WALLS] = max(0.0, told[APART_WALLS] - _FREE)
    if told[APART_WALLS] == 0.0:
        told[APART] = 0.0
    for row in range(3):
        for column in range(3):
            told[OFFSET] -= common[row] * inverse[row, column] * gradient[column]
            told[OFFSET_BEAMS] -= common[row] * inverse[row, column] * common[column]
            total = 0.0
            for one in range(3):
                for other in range(3):
                    total += inverse[row, one] * walls[one, other] * inverse[other, column]
            spread[row, column] = total
    return True


@inner_part
def _faces_alike(of_wall: Floats, of_group: Floats) -> bool:
    """Whether the beams of a group meet a surface that faces as the wall before it does."""
    product = of_wall[0] * of_group[0] + of_wall[1] * of_group[1]
    lengths = math.hypot(of_wall[0], of_wall[1]) * math.hypot(of_group[0], of_group[1])
    is_alike: bool = product > _ALIKE * lengths
    return is_alike


@inner_part
def _end_wall(of_wall: Floats, walls: Floats, told: Floats) -> None:
    """Add the pull of one wall on the pose, squared, and its residual; begin the next wall."""
    if of_wall[4] > 1.0:
        off = of_wall[3] / of_wall[4]
        told[APART] += off * off
        told[APART_WALLS] += 1.0
    for row in range(3):
        for column in range(3):
            walls[row, column] += of_wall[row] * of_wall[column]
    of_wall[:] = 0.0
