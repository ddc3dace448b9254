"""Compiled matching of a scan to a surface field.

The pose is found by the Gauss-Newton method: the ends of the beams should lie on surfaces. Ends
that are farther off than a scale lose weight (the robust kernel of Geman and McClure), so that
things that the map does not show hardly matter.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, allocating_part, any_order_entry, entry, inner_part
from roomba.perception.matching.field_kernels import Field, Place

_MORE_ROUNDS: Final = 2
"""Rounds after those with scales of their own. Their number is fixed: if they ended at a small
correction, a difference in the last bit could become one of 0.1 mm."""
MATCH_WORK: Final = 10
"""Rows of the work array of :func:`match_in`."""


@entry
def beam_ends(
    ranges: NDArray[np.float32],
    directions: Floats,
    mount: Floats,
    nearest: float,
    farthest: float,
    ends: Floats,
) -> int:
    """Fill ``ends`` [beams, 4] with those beams that met something; return how many.

    A row is a beam's end x, y, m, and its direction, cosine and sine, in the robot's frame.
    ``directions`` is [beams, 2], cosine and sine in the lidar's frame; ``mount`` x, y, theta of the
    lidar in the robot's frame.
    """
    cosine, sine = math.cos(mount[2]), math.sin(mount[2])
    count = 0
    for beam in range(ranges.size):
        length = ranges[beam]
        if not nearest <= length < farthest:
            continue
        along = cosine * directions[beam, 0] - sine * directions[beam, 1]
        across = sine * directions[beam, 0] + cosine * directions[beam, 1]
        ends[count, 0] = mount[0] + length * along
        ends[count, 1] = mount[1] + length * across
        ends[count, 2] = along
        ends[count, 3] = across
        count += 1
    return count


@inner_part
def fill_lanes(ends: Floats, count: int, lanes: Floats) -> None:
    """Fill ``lanes`` [2 or more, n] with x and y of the first ``count`` of ``ends`` [n, 4]."""
    for index in range(count):
        lanes[0, index], lanes[1, index] = ends[index, 0], ends[index, 1]


@any_order_entry
def add_beams(
    field: Field,
    place: Place,
    lanes: Floats,
    count: int,
    pose: Floats,
    scale: float,
    certainty: float,
    information: Floats,
    gradient: Floats,
) -> None:
    """Add the beams' terms to the upper half of ``information`` [3, 3] and to ``gradient`` [3].

    ``lanes`` [2 or more, n] has x and y of the beams' ends. A beam whose end lies on a surface
    weighs ``certainty``, 1/m2, and one that ends ``scale`` m off, a quarter of that. The field is
    looked up as by :func:`roomba.perception.matching.field_kernels.look`, for many beams at a time.
    """
    rows, columns = field.shape
    if rows < 2 or columns < 2:
        return
    cells, row_size = field.ravel(), np.int32(columns)
    last_column, last_row = columns - 1.0, rows - 1.0
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    per_metre, inverse = 1.0 / place[2], 1.0 / scale
    from_column, from_row = (pose[0] - place[0]) * per_metre, (pose[1] - place[1]) * per_metre
    end_x, end_y = lanes[0], lanes[1]
    xx = xy = xt = yy = yt = tt = gx = gy = gt = 0.0
    for index in range(count):
        turned_x = cosine * end_x[index] - sine * end_y[index]
        turned_y = sine * end_x[index] + cosine * end_y[index]
        u, v = from_column + turned_x * per_metre, from_row + turned_y * per_metre
        is_inside = (u >= 0.0) & (u < last_column) & (v >= 0.0) & (v < last_row)
        u, v = (u if is_inside else 0.0), (v if is_inside else 0.0)
        column, row = np.int32(u), np.int32(v)
        a, b, cell = u - column, v - row, row * row_size + column
        low, low_next = cells[cell], cells[cell + 1]
        high, high_next = cells[cell + row_size], cells[cell + row_size + 1]
        lower, upper = low + a * (low_next - low), high + a * (high_next - high)
        off = lower + b * (upper - lower)
        slope_x = ((1.0 - b) * (low_next - low) + b * (high_next - high)) * per_metre
        slope_y = (upper - lower) * per_metre
        share = off * inverse
        weight = 1.0 / (1.0 + share * share)
        weight = weight * weight if is_inside else 0.0
        slope_t = slope_y * turned_x - slope_x * turned_y
        xx += weight * slope_x * slope_x
        xy += weight * slope_x * slope_y
        xt += weight * slope_x * slope_t
        yy += weight * slope_y * slope_y
        yt += weight * slope_y * slope_t
        tt += weight * slope_t * slope_t
        gx += weight * slope_x * off
        gy += weight * slope_y * off
        gt += weight * slope_t * off
    information[0, 0] += certainty * xx
    information[0, 1] += certainty * xy
    information[0, 2] += certainty * xt
    information[1, 1] += certainty * yy
    information[1, 2] += certainty * yt
    information[2, 2] += certainty * tt
    gradient[0] += certainty * gx
    gradient[1] += certainty * gy
    gradient[2] += certainty * gt


@entry
def invert(matrix: Floats, out: Floats) -> bool:
    """Fill ``out`` with the inverse of a symmetric positive definite matrix.

    Both are [3, 3]; of ``matrix`` the upper half is read. Return False for a matrix that is not
    positive definite; ``out`` is left as it was.
    """
    a, b, c = matrix[0, 0], matrix[0, 1], matrix[0, 2]
    d, e, f = matrix[1, 1], matrix[1, 2], matrix[2, 2]
    minor_a, minor_b, minor_c = d * f - e * e, c * e - b * f, b * e - c * d
    determinant = a * minor_a + b * minor_b + c * minor_c
    if not determinant > 0.0:
        return False
    inverse = 1.0 / determinant
    out[0, 0] = minor_a * inverse
    out[0, 1] = out[1, 0] = minor_b * inverse
    out[0, 2] = out[2, 0] = minor_c * inverse
    out[1, 1] = (a * f - c * c) * inverse
    out[1, 2] = out[2, 1] = (b * c - a * e) * inverse
    out[2, 2] = (a * d - b * b) * inverse
    return True


@allocating_entry
def match(
    field: Field,
    place: Place,
    ends: Floats,
    count: int,
    prior: Floats,
    covariance: Floats,
    scales: Floats,
    variance: float,
    pose: Floats,
) -> int:
    """Move ``pose`` [3] to where the scan fits best, near ``prior`` [3]; return the rounds of that.

    Headings are not wrapped. ``covariance`` [3, 3] is the prior's, and becomes that of the pose.
    ``scales``, m, are those at which beams lose weight, one for each round; the last one also holds
    for the rounds that follow. ``variance``, m2, is a beam's, its dependence on the others
    included.
    """
    work, lanes = np.empty((MATCH_WORK, 3)), np.empty((2, count))
    fill_lanes(ends, count, lanes)
    return match_in(field, place, count, prior, covariance, scales, variance, pose, work, lanes)


@allocating_part
def match_in(
    field: Field,
    place: Place,
    count: int,
    prior: Floats,
    covariance: Floats,
    scales: Floats,
    variance: float,
    pose: Floats,
    work: Floats,
    lanes: Floats,
) -> int:
    """Do the same as :func:`match`, in the caller's ``work`` [MATCH_WORK, 3], without allocating.

    ``lanes`` [2 or more, n] has x and y of the ends of ``count`` beams, as :func:`add_beams` takes
    them. Afterwards the first three rows of ``work`` are the prior's information.
    """
    of_prior, information, solved = work[0:3], work[3:6], work[6:9]
    gradient = work[9]
    if not invert(covariance, of_prior):
        return 0
    rounds = 0
    while rounds < scales.size + _MORE_ROUNDS:
        scale = scales[min(rounds, scales.size - 1)]
        rounds += 1
        for row in range(3):
            gradient[row] = 0.0
            for column in range(3):
                information[row, column] = of_prior[row, column]
                gradient[row] += of_prior[row, column] * (pose[column] - prior[column])
        add_beams(field, place, lanes, count, pose, scale, 1.0 / variance, information, gradient)
        if not invert(information, solved):
            return rounds
        for row in range(3):
            for column in range(3):
                pose[row] -= solved[row, column] * gradient[column]
    for row in range(3):
        for column in range(3):
            covariance[row, column] = solved[row, column]
    return rounds
