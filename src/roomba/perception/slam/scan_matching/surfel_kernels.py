"""Compiled: surfels, little pieces of surface in a grid, and matching a scan to them.

A cell has separate surfels for surfaces that face left, right, up and down, so that the two sides
of a thin wall are two surfaces. A pose is found by the Gauss-Newton method: each point of the scan
should lie in the plane of the surfel next to it (point to plane, Chen and Medioni, "Object
modelling by registration of multiple range images", 1992). Points much farther off than a scale
lose weight (Geman and McClure).
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, entry, inner_part, part
from roomba.perception.matching.match_kernels import invert
from roomba.perception.slam.scan_matching.surface_kernels import NORMAL_X, NORMAL_Y, X, Y
from roomba.perception.slam.scan_matching.tolerances import Tolerances

FACINGS: Final = 4
SUMS: Final = 5
"""Numbers of a surfel: points, sums of their x, y from the cell's middle, and sums of normals."""
MATCHED: Final = 0
CLOSE: Final = 1
ASKED: Final = 2
COUNTS: Final = 3
"""Numbers of a match: points that met a surfel, those in its plane, and points with a normal."""
ALIGN_WORK: Final = 10
"""Rows of the work array of :func:`align`."""

_SAME_WAY: Final = 0.8
"""Cosine; surfaces at a larger angle to each other are not the same."""


class Surfels(NamedTuple):
    """The grid as kernels know it.

    ``sums`` is float32 [rows, columns, FACINGS, SUMS]; ``place`` the lower left corner x, y and the
    cell size, m. The first ``used`` [1] of ``touched``, int32 [n], are the cells with surfels.
    """

    sums: NDArray[np.float32]
    place: Floats
    touched: NDArray[np.int32]
    used: NDArray[np.int64]


@entry
def clear(surfels: Surfels) -> None:
    """Take all surfels out of the grid."""
    columns = surfels.sums.shape[1]
    for index in range(surfels.used[0]):
        cell = surfels.touched[index]
        surfels.sums[cell // columns, cell % columns] = 0.0
    surfels.used[0] = 0


@entry
def add_points(surfels: Surfels, points: Floats, count: int, pose: Floats) -> None:
    """Add a scan's points, seen from ``pose`` [3], grid's frame; those off the grid are lost."""
    rows, columns = surfels.sums.shape[0], surfels.sums.shape[1]
    per_metre = 1.0 / surfels.place[2]
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    for index in range(count):
        normal_x, normal_y = points[index, NORMAL_X], points[index, NORMAL_Y]
        if normal_x == 0.0 and normal_y == 0.0:
            continue
        x = pose[0] + cosine * points[index, X] - sine * points[index, Y]
        y = pose[1] + sine * points[index, X] + cosine * points[index, Y]
        facing_x = cosine * normal_x - sine * normal_y
        facing_y = sine * normal_x + cosine * normal_y
        column = math.floor((x - surfels.place[0]) * per_metre)
        row = math.floor((y - surfels.place[1]) * per_metre)
        if not (0 <= row < rows and 0 <= column < columns):
            continue
        cell = surfels.sums[row, column]
        if cell[0, 0] + cell[1, 0] + cell[2, 0] + cell[3, 0] == 0.0:
            if surfels.used[0] == surfels.touched.size:
                continue
            surfels.touched[surfels.used[0]] = row * columns + column
            surfels.used[0] += 1
        sums = cell[_facing(facing_x, facing_y)]
        sums[0] += 1.0
        sums[1] += x - (surfels.place[0] + (column + 0.5) * surfels.place[2])
        sums[2] += y - (surfels.place[1] + (row + 0.5) * surfels.place[2])
        sums[3] += facing_x
        sums[4] += facing_y


@allocating_entry
def align(
    surfels: Surfels,
    points: Floats,
    count: int,
    stride: int,
    reach: int,
    prior: Floats,
    covariance: Floats,
    tolerances: Tolerances,
    rounds: int,
    pose: Floats,
    information: Floats,
    counts: Floats,
    work: Floats,
) -> bool:
    """Move ``pose`` [3] to where every ``stride``-th point fits best, near ``prior`` [3].

    Poses are in the grid's frame. Surfels are looked for up to ``reach`` cells away. ``covariance``
    [3, 3] is the prior's, and becomes that of the pose; ``information`` [3, 3] gets that of the
    points alone, ``counts`` [COUNTS] how well they fit. ``work`` is [ALIGN_WORK, 3]. Returns
    whether there was anything to solve.
    """
    scales = tolerances.scales
    of_prior, solved, total, gradient = work[0:3], work[3:6], work[6:9], work[9]
    if not invert(covariance, of_prior):
        return False
    for each in range(rounds):
        scale = scales[min(each, scales.size - 1)]
        information[:] = 0.0
        gradient[:] = 0.0
        _add_matches(
            surfels, points, count, stride, reach, pose, scale, tolerances, information, gradient,
            counts,
        )  # fmt: skip
        for row in range(3):
            for column in range(3):
                total[row, column] = information[row, column] + of_prior[row, column]
                gradient[row] += of_prior[row, column] * (pose[column] - prior[column])
        if not invert(total, solved):
            return False
        # The rounds do not end early: a difference in the last bit could become one of 0.1 mm.
        for row in range(3):
            for column in range(3):
                pose[row] -= solved[row, column] * gradient[column]
    for row in range(3):
        for column in range(3):
            covariance[row, column] = solved[row, column]
    return True


@inner_part
def _add_matches(
    surfels: Surfels,
    points: Floats,
    count: int,
    stride: int,
    reach: int,
    pose: Floats,
    scale: float,
    tolerances: Tolerances,
    information: Floats,
    gradient: Floats,
    counts: Floats,
) -> None:
    """Add the points' terms to ``information`` and ``gradient``, and count how they fit."""
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    certainty, inverse = 1.0 / tolerances.variance, 1.0 / scale
    counts[:] = 0.0
    for index in range(0, count, stride):
        normal_x, normal_y = points[index, NORMAL_X], points[index, NORMAL_Y]
        if normal_x == 0.0 and normal_y == 0.0:
            continue
        counts[ASKED] += 1.0
        turned_x = cosine * points[index, X] - sine * points[index, Y]
        turned_y = sine * points[index, X] + cosine * points[index, Y]
        facing_x = cosine * normal_x - sine * normal_y
        facing_y = sine * normal_x + cosine * normal_y
        x, y = pose[0] + turned_x, pose[1] + turned_y
        square, off, plane_x, plane_y = _plane_near(surfels, x, y, facing_x, facing_y, 1)
        if reach > 1 and square > surfels.place[2] * surfels.place[2]:
            # Nearer ones than that are in the cells beside it.
            square, off, plane_x, plane_y = _plane_near(surfels, x, y, facing_x, facing_y, reach)
        if square == math.inf:
            continue
        counts[MATCHED] += 1.0
        if abs(off) < tolerances.close:
            counts[CLOSE] += 1.0
        share = off * inverse
        weight = certainty / (1.0 + share * share) ** 2
        slope = plane_y * turned_x - plane_x * turned_y
        information[0, 0] += weight * plane_x * plane_x
        information[0, 1] += weight * plane_x * plane_y
        information[0, 2] += weight * plane_x * slope
        information[1, 1] += weight * plane_y * plane_y
        information[1, 2] += weight * plane_y * slope
        information[2, 2] += weight * slope * slope
        gradient[0] += weight * plane_x * off
        gradient[1] += weight * plane_y * off
        gradient[2] += weight * slope * off
    information[1, 0] = information[0, 1]
    information[2, 0] = information[0, 2]
    information[2, 1] = information[1, 2]


@inner_part
def _plane_near(
    surfels: Surfels, x: float, y: float, facing_x: float, facing_y: float, reach: int
) -> tuple[float, float, float, float]:
    """Find the nearest surfel that faces the same way as a point.

    Return its squared distance, m2, infinite if there is none, how far the point is off its plane,
    m, positive before it, and the plane's normal.
    """
    rows, columns = surfels.sums.shape[0], surfels.sums.shape[1]
    size = surfels.place[2]
    u, v = (x - surfels.place[0]) / size, (y - surfels.place[1]) / size
    middle_column, middle_row = math.floor(u), math.floor(v)
    best = math.inf
    off = plane_x = plane_y = 0.0
    main = _facing(facing_x, facing_y)
    other = _other_facing(facing_x, facing_y)
    for row in range(max(middle_row - reach, 0), min(middle_row + reach + 1, rows)):
        for column in range(max(middle_column - reach, 0), min(middle_column + reach + 1, columns)):
            for turn in range(2):
                sums = surfels.sums[row, column, main if turn == 0 else other]
                weight = sums[0]
                if weight == 0.0:
                    continue
                share = 1.0 / weight
                away_x = x - (surfels.place[0] + (column + 0.5) * size + sums[1] * share)
                away_y = y - (surfels.place[1] + (row + 0.5) * size + sums[2] * share)
                square = away_x * away_x + away_y * away_y
                if square >= best:
                    continue
                length = math.sqrt(sums[3] * sums[3] + sums[4] * sums[4])
                if facing_x * sums[3] + facing_y * sums[4] < _SAME_WAY * length:
                    continue
                best = square
                plane_x, plane_y = sums[3] / length, sums[4] / length
                off = plane_x * away_x + plane_y * away_y
    return best, off, plane_x, plane_y


@part
def _facing(x: float, y: float) -> int:
    """Return which of the four ways a normal faces: 0 along x, then counter-clockwise."""
    if abs(x) >= abs(y):
        return 0 if x > 0.0 else 2
    return 1 if y > 0.0 else 3


@part
def _other_facing(x: float, y: float) -> int:
    """Return the second best of the four ways."""
    if abs(x) >= abs(y):
        return 1 if y > 0.0 else 3
    return 0 if x > 0.0 else 2
