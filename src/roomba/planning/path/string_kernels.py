"""Compiled string pulling: a way becomes taut around the corners of solid cells.

Places in cells of the solid grid; whole numbers are the cells' sides and corners.

A disc that passes a corner keeps its distance: its middle goes on an arc about the corner. Points
on such arcs, and on circles about round things, stand for all solid things. A bend of the way is
replaced by the convex hull of those points that lie within the triangle of the bend and its two
neighbours. When the hull of each bend is the bend itself, the way is the shortest of all that pass
the points on the same sides (Hershberger & Snoeyink, "Computing minimum length paths of a given
homotopy class", Computational Geometry 4, 1994, on what is shortest among points).
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import entry, inner_part, part

Bytes = NDArray[np.uint8]

QUARTER: Final = 16
"""Steps of an arc of 90 degrees: its chords are nearer to the corner by 0.12 % of the room."""
FULL: Final = -1
"""Result that asks for a larger String."""
_EPSILON: Final = 1e-9
"""Square cells; a triangle with less than this as twice its area counts as a line."""
_MOST_SWEEPS: Final = 40
"""Sweeps over the whole way, at most; five are enough for nearly all ways."""


class String(NamedTuple):
    """A way that is pulled; reused, by one way at a time."""

    points: Floats
    """float64 [capacity, 2]: the way, x and y."""
    pinned: Bytes
    """uint8 [capacity]: 1 for points that stay."""
    held: Floats
    """float64 [capacity, 2]: the points within a bend's triangle, which hold the bend."""
    hull: Floats
    """float64 [capacity, 2]: the points that take a bend's place."""


class Pegs(NamedTuple):
    """The things around which a way is pulled."""

    corners: Bytes
    """uint8 [rows + 1, columns + 1], from :func:`mark_corners`."""
    room: float
    """The distance that the way keeps from corners, cells."""
    circles: Floats
    """float64 [n, 3]: x and y of round things, and the distance to keep from these, cells."""
    arc: Floats
    """float64 [4 * QUARTER, 2]: unit vectors all around, counterclockwise from the east."""


class _Bend(NamedTuple):
    """A bend between its two neighbours, and which way it turns: left 1, right -1."""

    from_x: float
    from_y: float
    x: float
    y: float
    to_x: float
    to_y: float
    turn: float


@entry
def mark_corners(solid: NDArray[np.bool_], corners: Bytes) -> None:
    """Mark the corners of solid cells that a disc can go around; all outside is solid, too.

    ``solid`` is bool [rows, columns], ``corners`` uint8 [rows + 1, columns + 1]; its bits 1, 2, 4
    and 8 tell that the cell to the NE, NW, SW or SE has such a corner there (x goes to the east, y
    to the north).
    """
    rows, columns = solid.shape
    for y in range(rows + 1):
        for x in range(columns + 1):
            south, north, west, east = y == 0, y == rows, x == 0, x == columns
            north_east = north or east or solid[y, x]
            north_west = north or west or solid[y, x - 1]
            south_west = south or west or solid[y - 1, x - 1]
            south_east = south or east or solid[y - 1, x]
            found = 0
            if not (north_west or south_east):
                found |= (1 if north_east else 0) | (4 if south_west else 0)
            if not (north_east or south_west):
                found |= (2 if north_west else 0) | (8 if south_east else 0)
            corners[y, x] = found


@entry
def pull(string: String, size: int, pegs: Pegs) -> int:
    """Pull the first ``size`` points of a way taut; return how many it has then, or FULL.

    The way keeps the pegs' distances, except at pinned points.
    """
    for _ in range(_MOST_SWEEPS):
        is_taut = True
        at = 1
        while at < size - 1:
            if string.pinned[at]:
                at += 1
                continue
            found = _hull_of_bend(string, at, pegs)
            if found == FULL or size + found > len(string.points):
                return FULL
            if found != 1 or not _is_there(string, at):
                _replace(string, size, at, found)
                size += found - 1
                is_taut = False
            at += found
        if is_taut:
            break
    return size


@inner_part
def _is_there(string: String, at: int) -> bool:
    """Whether the first point of the hull is a point of the way already."""
    is_there: bool = (
        string.hull[0, 0] == string.points[at, 0] and string.hull[0, 1] == string.points[at, 1]
    )
    return is_there


@part
def _replace(string: String, size: int, at: int, found: int) -> None:
    """Put the ``found`` points of the hull where a point of the way was."""
    moved = found - 1
    if moved > 0:
        for n in range(size - 1, at, -1):
            _put(string, n + moved, string.points[n, 0], string.points[n, 1], string.pinned[n])
    elif moved < 0:
        for n in range(at + 1, size):
            _put(string, n - 1, string.points[n, 0], string.points[n, 1], string.pinned[n])
    for n in range(found):
        _put(string, at + n, string.hull[n, 0], string.hull[n, 1], 0)


@inner_part
def _put(string: String, at: int, x: float, y: float, pinned: int) -> None:
    string.points[at, 0], string.points[at, 1], string.pinned[at] = x, y, pinned


@part
def _hull_of_bend(string: String, at: int, pegs: Pegs) -> int:
    """Find the points of the taut way between the neighbours of a bend, in ``string.hull``.

    Returns the number of points, or FULL.
    """
    points = string.points
    from_x, from_y = points[at - 1, 0], points[at - 1, 1]
    x, y = points[at, 0], points[at, 1]
    to_x, to_y = points[at + 1, 0], points[at + 1, 1]
    turn = _cross(x - from_x, y - from_y, to_x - x, to_y - y)
    if abs(turn) <= _EPSILON * max(math.hypot(to_x - from_x, to_y - from_y), 1.0):
        return 0
    bend = _Bend(from_x, from_y, x, y, to_x, to_y, math.copysign(1.0, turn))
    held = _hold_corners(string.held, bend, pegs)
    if held != FULL:
        held = _hold_circles(string.held, held, bend, pegs)
    if held == FULL:
        return FULL
    return _wrap(string, held, bend)


@inner_part
def _cross(x: float, y: float, to_x: float, to_y: float) -> float:
    return x * to_y - y * to_x


@inner_part
def _dot(x: float, y: float, to_x: float, to_y: float) -> float:
    return x * to_x + y * to_y


@part
def _hold_corners(held: Floats, bend: _Bend, pegs: Pegs) -> int:
    """Note the points of corners' arcs that hold a bend; return how many, or FULL."""
    room, corners = pegs.room, pegs.corners
    size = 0
    first = math.ceil(min(bend.from_y, bend.y, bend.to_y) - room)
    last = math.floor(max(bend.from_y, bend.y, bend.to_y) + room)
    for y in range(max(first, 0), min(last, len(corners) - 1) + 1):
        low, high = _span(bend, y - room, y + room)
        left, right = math.ceil(low - room), math.floor(high + room)
        for x in range(max(left, 0), min(right, corners.shape[1] - 1) + 1):
            bits = corners[y, x]
            for quarter in range(4 if bits else 0):
                # The arc to the NE is about a corner of the cell to the SW, and so on.
                if bits & (1 << ((quarter + 2) % 4)):
                    first_step = quarter * QUARTER
                    size = _hold_arc(
                        held, size, bend, pegs, x, y, room, first_step, first_step + QUARTER
                    )
                if size == FULL:
                    return FULL
    return size


@part
def _hold_circles(held: Floats, size: int, bend: _Bend, pegs: Pegs) -> int:
    """Note the points of circles that hold a bend; return how many there are now, or FULL."""
    circles, last = pegs.circles, 4 * QUARTER - 1
    for n in range(len(circles)):
        x, y, room = circles[n, 0], circles[n, 1], circles[n, 2]
        size = _hold_arc(held, size, bend, pegs, x, y, room, 0, last)
        if size == FULL:
            return FULL
    return size


@inner_part
def _hold_arc(
    held: Floats,
    size: int,
    bend: _Bend,
    pegs: Pegs,
    x: float,
    y: float,
    room: float,
    first: int,
    last: int,
) -> int:
    """Note the points of an arc about (x, y), from its first to its last step, that hold a bend."""
    for n in range(first, last + 1):
        step = n % (4 * QUARTER)
        at_x, at_y = x + room * pegs.arc[step, 0], y + room * pegs.arc[step, 1]
        if not _holds(bend, at_x, at_y, x, y):
            continue
        if size == len(held):
            return FULL
        held[size, 0], held[size, 1] = at_x, at_y
        size += 1
    return size


@inner_part
def _holds(bend: _Bend, x: float, y: float, about_x: float, about_y: float) -> bool:
    """Whether a point (x, y) of an arc about another point lies in a bend's triangle.

    Points on the side between the neighbours do not count. A point on a leg counts only if its arc
    is about a point on the inside of the bend: what lies outside does not hold the bend.
    """
    turn, to_about_x, to_about_y = bend.turn, about_x - x, about_y - y
    leg_x, leg_y = bend.x - bend.from_x, bend.y - bend.from_y
    inside = turn * _cross(leg_x, leg_y, x - bend.from_x, y - bend.from_y)
    if not _is_within(inside, turn * _cross(leg_x, leg_y, to_about_x, to_about_y)):
        return False
    leg_x, leg_y = bend.to_x - bend.x, bend.to_y - bend.y
    inside = turn * _cross(leg_x, leg_y, x - bend.x, y - bend.y)
    if not _is_within(inside, turn * _cross(leg_x, leg_y, to_about_x, to_about_y)):
        return False
    across_x, across_y = bend.to_x - bend.from_x, bend.to_y - bend.from_y
    return turn * _cross(across_x, across_y, x - bend.from_x, y - bend.from_y) < -_EPSILON


@inner_part
def _is_within(inside: float, about_inside: float) -> bool:
    """Whether a point lies inside of a leg, or on it with the middle of its arc inside."""
    return inside > _EPSILON or (inside >= -_EPSILON and about_inside > 0.0)


@inner_part
def _span(bend: _Bend, low: float, high: float) -> tuple[float, float]:
    """Return the least and the largest x of a bend's triangle between two heights."""
    left, right = math.inf, -math.inf
    for from_x, from_y, to_x, to_y in (
        (bend.from_x, bend.from_y, bend.x, bend.y),
        (bend.x, bend.y, bend.to_x, bend.to_y),
        (bend.to_x, bend.to_y, bend.from_x, bend.from_y),
    ):
        rise = to_y - from_y
        begin, end = 0.0, 1.0
        if rise != 0.0:
            enter, leave = (low - from_y) / rise, (high - from_y) / rise
            begin, end = max(min(enter, leave), 0.0), min(max(enter, leave), 1.0)
        if begin <= end and max(from_y, to_y) >= low and min(from_y, to_y) <= high:
            at_begin, at_end = from_x + begin * (to_x - from_x), from_x + end * (to_x - from_x)
            left, right = min(left, at_begin, at_end), max(right, at_begin, at_end)
    return left, right


@part
def _wrap(string: String, held: int, bend: _Bend) -> int:
    """Find the hull of the points that hold a bend, from neighbour to neighbour (Graham scan)."""
    _sort_around(string.held, held, bend)
    hull, size = string.hull, 0
    for n in range(held + 1):
        x, y = bend.to_x, bend.to_y
        if n < held:
            x, y = string.held[n, 0], string.held[n, 1]
        while size > 0:
            before_x, before_y = bend.from_x, bend.from_y
            if size > 1:
                before_x, before_y = hull[size - 2, 0], hull[size - 2, 1]
            at_x, at_y = hull[size - 1, 0], hull[size - 1, 1]
            turn = bend.turn * _cross(at_x - before_x, at_y - before_y, x - at_x, y - at_y)
            if turn > _EPSILON:
                break
            size -= 1
        if n < held:
            hull[size, 0], hull[size, 1] = x, y
            size += 1
    return size


@part
def _sort_around(held: Floats, size: int, bend: _Bend) -> None:
    """Sort points by their direction from a bend's first neighbour, from that of the bend on.

    Of points in the same direction the nearest comes first.
    """
    for last in range(1, size):
        x, y = held[last, 0], held[last, 1]
        at = last
        while at > 0:
            other_x, other_y = held[at - 1, 0], held[at - 1, 1]
            to_x, to_y = x - bend.from_x, y - bend.from_y
            turn = bend.turn * _cross(other_x - bend.from_x, other_y - bend.from_y, to_x, to_y)
            is_farther = _dot(to_x, to_y, x - other_x, y - other_y) >= 0.0
            if turn > 0.0 or (turn == 0.0 and is_farther):
                break
            held[at, 0], held[at, 1] = other_x, other_y
            at -= 1
        held[at, 0], held[at, 1] = x, y
