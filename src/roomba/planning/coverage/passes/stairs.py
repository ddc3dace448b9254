"""Smooth ways along slanted walls, which a grid draws as stairs.

The outline of where the middle fits goes around the corner of each step on an arc. On a grid that
arc has few bends, so sharp that the robot stops at each. Here an arc gets so many bends that the
robot takes each while driving.

Places in cells: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Polyline
from roomba.compilation import allocating_entry, inner_part
from roomba.planning.coverage.passes.directions import line_along
from roomba.planning.coverage.passes.solid_cells import Beside, SolidCells, nearest_solid

Complexes = NDArray[np.complex128]

_WINDOW = 60
"""Points of an outline, more than half a metre: three steps or more of a wall that is slanted by 17
degrees."""
_BAND = 3.75
"""cells; width of a line. A dip between two corners of a wall that is slanted by 17 degrees is 2.6
cells deep, and corners of cells lie up to one cell more off their line."""
_SLANT = math.radians(8.0)
"""The least slant: a wall with less has steps farther apart, and deeper dips."""
_OFF = 1.6
"""cells; rounding puts an outline at most so much farther from a wall than the middle must be."""
_LEAST_STEPS = 3
"""Corners that a stair has at least."""
_BEND = 0.3
"""rad; the most that a smooth way turns at a point: it is taken while driving."""
_PROBES = 0.5
"""cells between two places at which a way's distance from walls is tested."""
_ROUNDING = 0.05
"""cells; arcs are by this wider than the distance to keep, as they are drawn as polygons."""
_MOST_LOOKS = 6
"""How often a way is made at most, each time around the walls that the last one met."""
_RADIUS = 16.0
"""cells; radius of bends away from walls, about that of bends around corners. Tighter bends leave
hardly less floor, as the tool is wider than a dip, and they are driven slowly."""


class SmoothWay(NamedTuple):
    """A smooth way: ``points`` replace those of an outline between ``first`` and ``last``."""

    first: int
    last: int
    points: Polyline


def smooth_ways(ring: Polyline, walls: SolidCells) -> list[SmoothWay]:
    """Return smooth ways along all stairs of a closed outline, in its order.

    ``ring`` is float64 [n, 2], its last point the first one, what fits on its left. Ways beside
    round things are left out.
    """
    slanted = along_stairs(ring)
    if not slanted.any():
        return []
    nearest = _nearest_corners(ring, slanted, walls.beside, walls.reach + _OFF)
    ways = [
        _smooth_way(ring, nearest, first, last, walls)
        for first, last in _runs(np.isfinite(nearest[:, 2]))
    ]
    return [way for way in ways if way is not None]


def _smooth_way(
    ring: Polyline, nearest: Floats, begin: int, end: int, walls: SolidCells
) -> SmoothWay | None:
    """Return a smooth way along the walls nearest to points ``begin`` to ``end`` - 1, or None."""
    is_corner = nearest[begin:end, 2] > 0.0
    is_corner[1:] &= (nearest[begin + 1 : end, :2] != nearest[begin : end - 1, :2]).any(axis=1)
    at = begin + np.flatnonzero(is_corner)
    if len(at) < _LEAST_STEPS:
        return None
    # The first and the last point of an outline are the same one: it stays.
    first = max(int(at[0]), 1)
    last = min(int(begin + np.flatnonzero(nearest[begin:end, 2] > 0.0)[-1]), len(ring) - 2)
    steps = nearest[at, :2]
    left, joined = complex(*ring[first].tolist()), complex(*ring[last].tolist())
    for _ in range(_MOST_LOOKS):
        points = _around(steps, left, joined, walls.reach + _ROUNDING, _RADIUS)
        way = np.concatenate((ring[first : first + 1], points, ring[last : last + 1]))
        met = _met(way, walls.beside, walls.reach - _ROUNDING)
        if len(met) == 0:
            return None if _is_beside_things(points, walls) else SmoothWay(first, last, points)
        # Between corners that are far apart, sides of steps come nearer than the corners.
        near = first + _nearest_points(ring[first:last], met)
        order = np.argsort(np.concatenate((at, near)), kind="stable")
        at = np.concatenate((at, near))[order]
        steps = np.concatenate((steps, met[:, 2:]))[order]
    return None


@allocating_entry
def along_stairs(ring: Polyline) -> NDArray[np.bool_]:
    """Return which points of a closed outline lie along a slanted wall, bool [n].

    ``ring`` is float64 [n, 2], its last point the first one. A slanted wall is straight for more
    than half a metre, but for the dips at its steps.
    """
    count = len(ring) - 1
    found = np.zeros(count + 1, np.bool_)
    for first in range(count - _WINDOW + 1):
        if _is_slanted(ring, first):
            found[first : first + _WINDOW] = True
    return found


@inner_part
def _is_slanted(ring: Polyline, first: int) -> bool:
    """Whether the window of points from ``first`` on lies along one slanted line."""
    is_straight, angle = line_along(ring, first, _WINDOW, _BAND)
    off_axis = abs(angle) % (0.5 * math.pi)
    return is_straight and min(off_axis, 0.5 * math.pi - off_axis) >= _SLANT


@allocating_entry
def _nearest_corners(
    ring: Polyline, wanted: NDArray[np.bool_], beside: Beside, far: float
) -> Floats:
    """Return the places on walls that are nearest to the wanted points, float64 [n, 3].

    A row is x and y, and 1 for a corner, 0 for a side. It is NaN for other points, and for points
    without a wall within ``far`` cells.
    """
    found = np.full((len(ring), 3), np.nan)
    for at in range(len(ring)):
        if not wanted[at]:
            continue
        x, y = ring[at, 0], ring[at, 1]
        to_x, to_y, away = nearest_solid(beside, x, y, far)
        if away == math.inf:
            continue
        found[at, 0], found[at, 1] = to_x, to_y
        found[at, 2] = 1.0 if to_x != x and to_y != y else 0.0
    return found


@allocating_entry
def _met(way: Polyline, beside: Beside, near: float) -> Polyline:
    """Return where legs of a way come nearer than ``near`` cells to solid cells, float64 [n, 4].

    A row is x and y of the worst place of a leg, and of the solid point nearest to that place.
    """
    found = np.empty((len(way), 4))
    size = 0
    for leg in range(len(way) - 1):
        x, y = way[leg, 0], way[leg, 1]
        along_x, along_y = way[leg + 1, 0] - x, way[leg + 1, 1] - y
        parts = math.ceil(math.hypot(along_x, along_y) / _PROBES) + 1
        least = near
        is_met = False
        for probe in range(parts):
            share = probe / parts
            at_x, at_y = x + share * along_x, y + share * along_y
            to_x, to_y, away = nearest_solid(beside, at_x, at_y, near)
            if away < least:
                least, is_met = away, True
                found[size, 0], found[size, 1] = at_x, at_y
                found[size, 2], found[size, 3] = to_x, to_y
        size += is_met
    return found[:size]


@allocating_entry
def _nearest_points(line: Polyline, places: Floats) -> NDArray[np.int64]:
    """Return which point of a line is nearest to each of some places, rows of x, y and more."""
    found = np.zeros(len(places), np.int64)
    for place in range(len(places)):
        x, y = places[place, 0], places[place, 1]
        least = math.inf
        for at in range(len(line)):
            to_x, to_y = line[at, 0] - x, line[at, 1] - y
            square = to_x * to_x + to_y * to_y
            if square < least:
                least, found[place] = square, at
    return found


def _is_beside_things(points: Polyline, walls: SolidCells) -> bool:
    """Whether a way comes near to something round."""
    x, y, radius = walls.things.T[:, :, None]
    away = np.hypot(points[:, 0] - x, points[:, 1] - y) - radius
    return bool((away < walls.reach + _OFF).any())


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first of each run of true ones, and the one after its last."""
    ends = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return [(int(first), int(last)) for first, last in ends.reshape(-1, 2)]


@allocating_entry
def _around(steps: Floats, start: complex, end: complex, reach: float, radius: float) -> Polyline:
    """Return a smooth way around the corners of steps, float64 [k, 2], all of them on its right.

    The way begins and ends beside the places ``start`` and ``end``, complex numbers x + i y.
    """
    corners = np.empty(len(steps), np.complex128)
    bends = np.empty(len(steps), np.complex128)
    size = _keep_corners(corners, bends, steps, reach, radius)
    most = math.ceil(math.pi / _BEND)
    points, count = np.empty((2 * size * most, 2)), 0
    for at in range(size):
        corner = corners[at]
        towards = bends[at - 1] - corner if at > 0 else start - corner
        onwards = bends[at] - corner if at < size - 1 else end - corner
        count = _write_arc(points, count, corner, towards, onwards, reach)
        if at < size - 1:
            back, on = corner - bends[at], corners[at + 1] - bends[at]
            count = _write_arc(points, count, bends[at], back, on, radius)
    return points[:count]


@inner_part
def _keep_corners(
    corners: Complexes, bends: Complexes, steps: Floats, reach: float, radius: float
) -> int:
    """Write the corners that a way around steps touches, and the middles of the bends between them.

    Returns how many corners there are; there is one bend less. Corners that the bend between their
    neighbours does not touch are left out.
    """
    size = 0
    for at in range(len(steps)):
        corner = complex(steps[at, 0], steps[at, 1])
        while size > 1 and corners[size - 1] != corner:
            last = corners[size - 1]
            turned = (_middle(last, corner, reach, radius) - last) / (bends[size - 2] - last)
            if turned.imag <= 0.0:
                break
            size -= 1
        if size > 0 and corners[size - 1] == corner:
            continue
        if size > 0:
            bends[size - 1] = _middle(corners[size - 1], corner, reach, radius)
        corners[size] = corner
        size += 1
    return size


@inner_part
def _middle(one: complex, other: complex, reach: float, radius: float) -> complex:
    """Return the middle of the bend that touches the arcs around two corners, left of both."""
    along = other - one
    half = 0.5 * abs(along)
    height = math.sqrt(max((reach + radius) ** 2 - half * half, 0.0))
    return one + 0.5 * along + 1j * along / abs(along) * height


@inner_part
def _write_arc(
    points: Polyline, count: int, middle: complex, begin: complex, end: complex, radius: float
) -> int:
    """Write the corners of sides that touch an arc, from one direction to the other.

    They are written after the first ``count`` points; returns the new number of points.
    """
    turned = end / begin
    angle = math.atan2(turned.imag, turned.real)
    sides = max(1, math.ceil(abs(angle) / _BEND))
    away = begin / abs(begin) * radius / math.cos(0.5 * angle / sides)
    for number in range(sides):
        at = (number + 0.5) * angle / sides
        corner = middle + away * complex(math.cos(at), math.sin(at))
        points[count, 0], points[count, 1] = corner.real, corner.imag
        count += 1
    return count
