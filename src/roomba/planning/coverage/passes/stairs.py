"""Ways along slanted walls: a grid draws these as stairs, and here the way around them is smooth.

The outline of where the middle fits goes around the corner of each step on an arc. On a grid that
has few bends, so sharp that the robot stops at each; here an arc has as many as are driven along.

Places in cells: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, inner_part
from roomba.planning.coverage.passes.directions import line_along

Line = NDArray[np.float64]

_WINDOW = 60
"""Points of an outline, more than half a metre: three steps or more of a wall that is slanted by 17
degrees."""
_BAND = 3.75
"""cells; a dip between two corners of a wall that is slanted by 17 degrees is 2.6 deep, and corners
of cells lie off their line by up to one more."""
_SLANT = math.radians(8.0)
"""A wall that is slanted by less has steps farther apart, and deeper dips."""
_OFF = 1.6
"""cells; by rounding an outline lies at most so much farther from a wall than the middle may be."""
_LEAST_STEPS = 3
"""Corners of a stair."""
_BEND = 0.3
"""rad; the most that a smooth way turns at a point: it is taken while driving."""
_PROBES = 0.5
"""cells between two places at which a way is compared with the walls."""
_ROUNDING = 0.05
"""cells; arcs are as much larger than what is kept from walls, as they are polygons."""
_MOST_LOOKS = 6
"""Times that a way is made anew around what it met."""
_RADIUS = 16.0
"""cells; of bends away from walls, about as wide as those around corners. Tighter ones leave hardly
less floor: the tool is wider than a dip, and they are driven slowly."""


class SolidCells(NamedTuple):
    """What is solid: bool [rows, columns], of which cell (0, 0) of the outlines is at ``column``
    and ``row``; ``reach`` is what the middle keeps from it, cells. ``things`` are round and not
    part of it, float64 [n, 3]: x, y and radius."""

    solid: Mask
    column: int
    row: int
    reach: float
    things: Line


class SmoothWay(NamedTuple):
    """The points of an outline from ``first`` to ``last`` are passed by ``points`` between."""

    first: int
    last: int
    points: Line


def smooth_ways(ring: Line, walls: SolidCells) -> list[SmoothWay]:
    """Return smooth ways along all stairs of a closed outline, in its order.

    ``ring`` is float64 [n, 2], its last point the first one, what fits on its left. Ways beside
    round things are left out.
    """
    slanted = along_stairs(ring)
    if not slanted.any():
        return []
    nearest = _nearest_corners(ring, slanted, walls)
    ways = [
        _smooth_way(ring, nearest, first, last, walls)
        for first, last in _runs(np.isfinite(nearest[:, 2]))
    ]
    return [way for way in ways if way is not None]


def _smooth_way(
    ring: Line, nearest: Line, begin: int, end: int, walls: SolidCells
) -> SmoothWay | None:
    """Return a smooth way along what is nearest to the points before ``end``, or None."""
    is_corner = nearest[begin:end, 2] > 0.0
    is_corner[1:] &= (nearest[begin + 1 : end, :2] != nearest[begin : end - 1, :2]).any(axis=1)
    at = begin + np.flatnonzero(is_corner)
    if len(at) < _LEAST_STEPS:
        return None
    # Where an outline begins it ends as well.
    first = max(int(at[0]), 1)
    last = min(int(begin + np.flatnonzero(nearest[begin:end, 2] > 0.0)[-1]), len(ring) - 2)
    steps = nearest[at, :2]
    for _ in range(_MOST_LOOKS):
        points = _around(steps, ring[first], ring[last], walls.reach + _ROUNDING, _RADIUS)
        way = np.concatenate((ring[first : first + 1], points, ring[last : last + 1]))
        met = _met(way, walls)
        if len(met) == 0:
            return None if _is_beside_things(points, walls) else SmoothWay(first, last, points)
        # Sides of steps come nearer than their corners where these are far apart.
        near = [first + int(np.argmin(np.hypot(*(ring[first:last] - x[:2]).T))) for x in met]
        order = np.argsort(np.concatenate((at, near)), kind="stable")
        at = np.concatenate((at, near))[order]
        steps = np.concatenate((steps, met[:, 2:]))[order]
    return None


@allocating_entry
def along_stairs(ring: Line) -> NDArray[np.bool_]:
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
def _is_slanted(ring: Line, first: int) -> bool:
    """Whether the window of points from ``first`` on lies along one slanted line."""
    is_straight, angle = line_along(ring, first, _WINDOW, _BAND)
    off_axis = abs(angle) % (0.5 * math.pi)
    return is_straight and min(off_axis, 0.5 * math.pi - off_axis) >= _SLANT


@inner_part
def _nearest_solid(walls: SolidCells, x: float, y: float) -> tuple[float, float, float]:
    """Return the nearest point of what is solid, x and y, and how far it is, cells."""
    rows, columns = walls.solid.shape
    span = math.ceil(walls.reach + _OFF) + 1
    column, row = math.floor(x + 0.5) + walls.column, math.floor(y + 0.5) + walls.row
    best, best_x, best_y = np.inf, 0.0, 0.0
    for at_row in range(max(row - span, 0), min(row + span + 1, rows)):
        to_y = min(max(y, at_row - walls.row - 0.5), at_row - walls.row + 0.5)
        for at_column in range(max(column - span, 0), min(column + span + 1, columns)):
            if walls.solid[at_row, at_column]:
                left = at_column - walls.column - 0.5
                to_x = min(max(x, left), left + 1.0)
                away = (to_x - x) * (to_x - x) + (to_y - y) * (to_y - y)
                if away < best:
                    best, best_x, best_y = away, to_x, to_y
    return best_x, best_y, math.sqrt(best)


@allocating_entry
def _nearest_corners(ring: Line, wanted: NDArray[np.bool_], walls: SolidCells) -> Line:
    """Return what of the walls is nearest to the wanted points, float64 [n, 3].

    x and y, and 1 for a corner, 0 for a side; NaN for other points, and those of no wall.
    """
    found = np.full((len(ring), 3), np.nan)
    for at in range(len(ring)):
        if not wanted[at]:
            continue
        x, y = ring[at]
        to_x, to_y, away = _nearest_solid(walls, x, y)
        if away > walls.reach + _OFF:
            continue
        found[at, 0], found[at, 1] = to_x, to_y
        found[at, 2] = 1.0 if to_x != x and to_y != y else 0.0
    return found


@allocating_entry
def _met(way: Line, walls: SolidCells) -> Line:
    """Return where legs of a way come too near to what is solid, float64 [n, 4].

    Each is x and y of the worst place of a leg, and of what is nearest to it there.
    """
    found = np.empty((len(way), 4))
    size = 0
    for leg in range(len(way) - 1):
        x, y = way[leg]
        along_x, along_y = way[leg + 1, 0] - x, way[leg + 1, 1] - y
        parts = math.ceil(math.hypot(along_x, along_y) / _PROBES) + 1
        least = walls.reach - _ROUNDING
        is_met = False
        for probe in range(parts):
            share = probe / parts
            at_x, at_y = x + share * along_x, y + share * along_y
            to_x, to_y, away = _nearest_solid(walls, at_x, at_y)
            if away < least:
                least, is_met = away, True
                found[size] = at_x, at_y, to_x, to_y
        size += is_met
    return found[:size]


def _is_beside_things(points: Line, walls: SolidCells) -> bool:
    """Whether a way comes near to something round."""
    x, y, radius = walls.things.T[:, :, None]
    away = np.hypot(points[:, 0] - x, points[:, 1] - y) - radius
    return bool((away < walls.reach + _OFF).any())


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first of each run of true ones, and the one after its last."""
    ends = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return [(int(first), int(last)) for first, last in ends.reshape(-1, 2)]


def _around(steps: Line, start: Line, end: Line, reach: float, radius: float) -> Line:
    """Return a smooth way around the corners of steps, float64 [k, 2], all of them on its right.

    It begins and ends beside ``start`` and ``end``.
    """
    corners: list[complex] = []
    bends: list[complex] = []
    first, last = _direction(steps[0], start), _direction(steps[-1], end)
    for x, y in steps.tolist():
        corner = complex(x, y)
        # A corner that the bend between its neighbours does not touch is none.
        while len(corners) > 1 and corners[-1] != corner:
            turned = (_middle(corners[-1], corner, reach, radius) - corners[-1]) / (
                bends[-1] - corners[-1]
            )
            if turned.imag <= 0.0:
                break
            corners.pop()
            bends.pop()
        if corners and corners[-1] == corner:
            continue
        if corners:
            bends.append(_middle(corners[-1], corner, reach, radius))
        corners.append(corner)
    points: list[complex] = []
    for at, corner in enumerate(corners):
        towards = first if at == 0 else bends[at - 1] - corner
        onwards = last if at == len(corners) - 1 else bends[at] - corner
        points += _arc(corner, towards, onwards, reach)
        if at < len(bends):
            points += _arc(bends[at], corner - bends[at], corners[at + 1] - bends[at], radius)
    return np.array([(point.real, point.imag) for point in points], np.float64).reshape(-1, 2)


def _direction(corner: Line, place: Line) -> complex:
    return complex(place[0] - corner[0], place[1] - corner[1])


def _middle(one: complex, other: complex, reach: float, radius: float) -> complex:
    """Return the middle of the bend that touches the arcs around two corners, left of both."""
    along = other - one
    half = 0.5 * abs(along)
    height = math.sqrt(max((reach + radius) ** 2 - half * half, 0.0))
    return one + 0.5 * along + 1j * along / abs(along) * height


def _arc(middle: complex, begin: complex, end: complex, radius: float) -> list[complex]:
    """Return the corners of sides that touch an arc, from one direction to the other."""
    turned = end / begin
    angle = math.atan2(turned.imag, turned.real)
    count = max(1, math.ceil(abs(angle) / _BEND))
    away = begin / abs(begin) * radius / math.cos(0.5 * angle / count)
    shares = [(number + 0.5) * angle / count for number in range(count)]
    return [middle + away * complex(math.cos(at), math.sin(at)) for at in shares]
