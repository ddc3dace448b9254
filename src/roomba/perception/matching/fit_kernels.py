"""Compiled likelihood of a scan at a pose, beam by beam."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, allocating_part, any_order_entry
from roomba.perception.matching.field_kernels import OFF_MAP, Field, Place, look

LOOKED_AT: Final = 0
AGREEING: Final = 1
SHORT: Final = 2
THROUGH: Final = 3
EVIDENCE: Final = 4
"""Indices into the ``fit`` that :func:`judge` fills."""

_SLACK: Final = 0.06
_SLACK_SHARE: Final = 0.01
"""m, and share of the range: how far from the expected surface a beam may end to agree with it."""
_SPREAD: Final = 0.03
"""m; standard deviation of where beams that agree end: noise of range, pose and map."""
_FINE_CELL: Final = 0.05
"""m; a wall may be farther off by as much as the cells of a map are larger than this."""
_CHANCE: Final = 0.03
"""Likelihood, against that of a perfect hit, of a beam that ends anywhere else."""
_BEHIND: Final = 0.01
"""Likelihood, in the same scale, of a beam that goes through what the map shows as solid."""
JUDGE_LANES: Final = 8
"""Rows of the work array of :func:`judge`; each column is a ray."""
_ALONG: Final = 0
_ACROSS: Final = 1
_MOST: Final = 2
_WAY: Final = 3
_DISTANCE: Final = 4
_NUMBER: Final = 5
"""Rows of rays that are traced: direction, length, way so far, m, distance to surfaces there, m,
and the number of the beam."""
_SLACK_THERE: Final = 6
_IS_THROUGH: Final = 7
"""Rows of beams, by number: how far off the beam may end, m, and whether it met a surface early."""
_TOUCH: Final = 0.005
"""m; a ray that is this near to a surface has met it."""
_GRAZED: Final = 0.35
"""In cells; in a coarse map a ray meets a wall only so deep in it: walls are thinner than cells."""
_LEAST_STEP: Final = 0.02
"""m; a ray that grazes a surface goes on by at least this."""
_NEAREST_SURFACE: Final = 0.1
"""m; surfaces of the map nearer to the lidar than this do not count: the robot itself is there."""
_SHARE: Final = 0.1
"""Weight of one beam: neighbours, and scans from nearby places, are not independent."""


@allocating_entry
def judge(
    field: Field,
    place: Place,
    ends: Floats,
    count: int,
    pose: Floats,
    mount: Floats,
    stride: int,
    fit: Floats,
    lanes: Floats,
) -> None:
    """Fill ``fit`` [5] with how well each ``stride``-th beam fits ``pose`` [3].

    The numbers are: the beams that were looked at; those of them that end where the map has a
    surface; those that end before a surface (at something that the map does not show) and those
    that end behind one (through something that the map shows); and the logarithm of their
    likelihood, as evidence to compare poses by. ``lanes`` [JUDGE_LANES, n] is a work array with a
    column for each beam that is looked at.
    """
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    x = pose[0] + cosine * mount[0] - sine * mount[1]
    y = pose[1] + sine * mount[0] + cosine * mount[1]
    looked_at = rays = 0
    coarse = max(0.0, place[2] - _FINE_CELL)
    for index in range(0, count, stride):
        off_x, off_y = ends[index, 0] - mount[0], ends[index, 1] - mount[1]
        length = math.sqrt(off_x * off_x + off_y * off_y)
        slack = _SLACK + coarse + _SLACK_SHARE * length
        lanes[_SLACK_THERE, looked_at], lanes[_IS_THROUGH, looked_at] = slack, 0.0
        if length > slack:
            lanes[_ALONG, rays] = cosine * ends[index, 2] - sine * ends[index, 3]
            lanes[_ACROSS, rays] = sine * ends[index, 2] + cosine * ends[index, 3]
            lanes[_MOST, rays], lanes[_WAY, rays] = length - slack, _NEAREST_SURFACE
            lanes[_NUMBER, rays] = looked_at
            rays += 1
        looked_at += 1
    _trace(field, place, x, y, lanes, rays)
    fit[:] = 0.0
    fit[LOOKED_AT] = looked_at
    for number in range(looked_at):
        if lanes[_IS_THROUGH, number] != 0.0:
            fit[THROUGH] += 1.0
            fit[EVIDENCE] += _SHARE * math.log(_BEHIND)
            continue
        end_x, end_y = ends[number * stride, 0], ends[number * stride, 1]
        turned_x, turned_y = cosine * end_x - sine * end_y, sine * end_x + cosine * end_y
        off, _, _ = look(field, place, pose[0] + turned_x, pose[1] + turned_y)
        fit[AGREEING if abs(off) <= lanes[_SLACK_THERE, number] else SHORT] += 1.0
        share = off / (_SPREAD + 0.5 * coarse)
        fit[EVIDENCE] += _SHARE * math.log(
            _CHANCE + (1.0 - _CHANCE) * math.exp(-0.5 * share * share)
        )


@allocating_part
def _trace(field: Field, place: Place, x: float, y: float, lanes: Floats, rays: int) -> None:
    """Mark the rays from a point, m, that meet a surface before their end.

    All rays advance together by the distance to the nearest surface (sphere tracing, Hart 1996),
    until each has met one or is at its end.
    """
    rows, columns = field.shape
    if rows < 2 or columns < 2:
        return
    cells = field.ravel()
    touch = _TOUCH - (_GRAZED * place[2] if place[2] > _FINE_CELL + _TOUCH else 0.0)
    while rays > 0:
        _stride(cells, rows, columns, place, x, y, lanes, rays)
        left = 0
        for ray in range(rays):
            there, most = lanes[_DISTANCE, ray], lanes[_MOST, ray]
            has_met = there < touch
            # The ray made a step too many, perhaps a little into the surface that it met.
            if has_met and lanes[_WAY, ray] - _LEAST_STEP + min(there, 0.0) < most:
                lanes[_IS_THROUGH, int(lanes[_NUMBER, ray])] = 1.0
            # A ray that goes on moves up; one that ended is overwritten by the next.
            lanes[_ALONG, left], lanes[_ACROSS, left] = lanes[_ALONG, ray], lanes[_ACROSS, ray]
            lanes[_MOST, left], lanes[_WAY, left] = lanes[_MOST, ray], lanes[_WAY, ray]
            lanes[_NUMBER, left] = lanes[_NUMBER, ray]
            left += (not has_met) & (lanes[_WAY, ray] < most + _LEAST_STEP)
        rays = left


@any_order_entry
def _stride(
    cells: Field,
    rows: int,
    columns: int,
    place: Place,
    x: float,
    y: float,
    lanes: Floats,
    rays: int,
) -> None:
    """Advance each ray by its distance to the nearest surface, m, and keep that distance."""
    row_size, last_column, last_row = np.int32(columns), columns - 1.0, rows - 1.0
    per_metre = 1.0 / place[2]
    from_column, from_row = (x - place[0]) * per_metre, (y - place[1]) * per_metre
    along, across, way = lanes[_ALONG], lanes[_ACROSS], lanes[_WAY]
    distance = lanes[_DISTANCE]
    for ray in range(rays):
        u = from_column + way[ray] * along[ray] * per_metre
        v = from_row + way[ray] * across[ray] * per_metre
        is_inside = (u >= 0.0) & (u < last_column) & (v >= 0.0) & (v < last_row)
        u, v = (u if is_inside else 0.0), (v if is_inside else 0.0)
        column, row = np.int32(u), np.int32(v)
        a, b, cell = u - column, v - row, row * row_size + column
        low, high = cells[cell], cells[cell + row_size]
        lower = low + a * (cells[cell + 1] - low)
        upper = high + a * (cells[cell + row_size + 1] - high)
        there = lower + b * (upper - lower) if is_inside else OFF_MAP
        distance[ray] = there
        way[ray] += max(there, _LEAST_STEP)
