"""Layout of bends around a corner of a way, or around a corner and the next one.

Before a bend around two corners, as from one swath to the next, the ways may go on a little farther
first. Places in cells of the window, as in :mod:`.rounding`.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask, Polyline
from roomba.compilation import inner_part, part
from roomba.planning.coverage.passes.sweep import Counts, Legs

_SHARPEST: Final = 2.4
"""rad; sharper corners stay: a bend would begin far before them."""
_SIDE: Final = 0.1
"""rad; a bend turns by at most this at a point, so that the robot does not slow down at points."""
NARROWER: Final = 0.75
"""Factor from one radius of a bend that is tried to the next."""
RADII: Final = 3
"""Radii that are tried: tighter bends are driven as slowly as turns on the spot."""
_OFF: Final = 1e-6
"""Cells of way; tolerance, so that rounding decides nothing."""
ROOM: Final = 64
"""Points of a way around two corners: more than bends of _SHARPEST have, in sides of _SIDE."""


class Rounded(NamedTuple):
    """A way that is being rounded.

    ``points`` is float64 [n, 2], of which the first ``size`` [1] are written. ``counts`` int16
    [rows, columns] is how many legs sweep each cell; ``need`` are the cells to sweep; ``fits`` is
    where the middle may be. ``old`` and ``new``, float64 [64, 2], are the ways around the corners
    at hand, of ``sizes`` [2] points, and ``legs`` those of both. ``radius`` is half the tool's
    width, cells; ``sharp``, rad, the turn from which on a corner is sharp; ``spare`` [1] how many
    more cells may be left.
    """

    points: Polyline
    size: NDArray[np.int64]
    counts: Counts
    need: Mask
    fits: Mask
    old: Floats
    new: Floats
    sizes: NDArray[np.int64]
    legs: Legs
    radius: float
    sharp: float
    spare: NDArray[np.int64]


@part
def _turn(ax: float, ay: float, bx: float, by: float) -> float:
    """Return the angle from one direction to another, rad."""
    return math.atan2(ax * by - ay * bx, ax * bx + ay * by)


@inner_part
def turn_at(work: Rounded, line: Polyline, at: int) -> float:
    """Return how much the way turns at a point of the line, rad, after the last point written."""
    before, here, after = work.points[work.size[0] - 1], line[at], line[at + 1]
    return _turn(here[0] - before[0], here[1] - before[1], after[0] - here[0], after[1] - here[1])


@part
def is_sharp(work: Rounded, turn: float) -> bool:
    """Whether a bend may replace a corner that turns by ``turn``, rad."""
    return work.sharp < abs(turn) < _SHARPEST


@inner_part
def bend_both(work: Rounded, line: Polyline, at: int, farther: float) -> bool:
    """Lay out the old and the new way around two corners that turn to the same side.

    The ways before and behind them go on by ``farther``. Return False if bends have no room.
    """
    before, one, two, after = work.points[work.size[0] - 1], line[at], line[at + 1], line[at + 2]
    come = math.hypot(one[0] - before[0], one[1] - before[1])
    go = math.hypot(after[0] - two[0], after[1] - two[1])
    in_x, in_y = (one[0] - before[0]) / come, (one[1] - before[1]) / come
    out_x, out_y = (after[0] - two[0]) / go, (after[1] - two[1]) / go
    x, y = one[0] + farther * in_x, one[1] + farther * in_y
    to_x, to_y = two[0] - farther * out_x, two[1] - farther * out_y
    across = math.hypot(to_x - x, to_y - y)
    first = _turn(in_x, in_y, to_x - x, to_y - y)
    second = _turn(to_x - x, to_y - y, out_x, out_y)
    if not (is_sharp(work, first) and is_sharp(work, second) and first * second > 0.0):
        return False
    first_tangent, second_tangent = math.tan(0.5 * abs(first)), math.tan(0.5 * abs(second))
    bend = min(work.radius, across / (first_tangent + second_tangent))
    back, on = bend * first_tangent - farther, bend * second_tangent - farther
    if bend < NARROWER**RADII * work.radius or back > come - _OFF or on > go - _OFF:
        return False
    _begin(work)
    back, on = max(back, 0.0), max(on, 0.0)
    _put(work, 0, one[0] - back * in_x, one[1] - back * in_y)
    _put(work, 0, one[0], one[1])
    _put(work, 0, two[0], two[1])
    _put(work, 0, two[0] + on * out_x, two[1] + on * out_y)
    _put(work, 1, work.old[0, 0], work.old[0, 1])
    _put_bend(work, x, y, in_x, in_y, first, bend)
    _put_bend(work, to_x, to_y, (to_x - x) / across, (to_y - y) / across, second, bend)
    _put(work, 1, work.old[3, 0], work.old[3, 1])
    return True


@inner_part
def bend_one(work: Rounded, line: Polyline, at: int, bend: float) -> bool:
    """Lay out the old and the new way around a corner; return False if a bend has no room.

    The bend uses half of the way to the next point at most, as the corner there needs the rest.
    """
    before, here, after = work.points[work.size[0] - 1], line[at], line[at + 1]
    turn = turn_at(work, line, at)
    come = math.hypot(here[0] - before[0], here[1] - before[1])
    go = math.hypot(after[0] - here[0], after[1] - here[1])
    tangent = bend * math.tan(0.5 * abs(turn))
    if tangent > come - _OFF or 2.0 * tangent > go - _OFF:
        return False
    in_x, in_y = (here[0] - before[0]) / come, (here[1] - before[1]) / come
    out_x, out_y = (after[0] - here[0]) / go, (after[1] - here[1]) / go
    _begin(work)
    _put(work, 0, here[0] - tangent * in_x, here[1] - tangent * in_y)
    _put(work, 0, here[0], here[1])
    _put(work, 0, here[0] + tangent * out_x, here[1] + tangent * out_y)
    _put(work, 1, work.old[0, 0], work.old[0, 1])
    _put_bend(work, here[0], here[1], in_x, in_y, turn, bend)
    _put(work, 1, work.old[2, 0], work.old[2, 1])
    return True


@part
def _begin(work: Rounded) -> None:
    work.sizes[0], work.sizes[1] = 0, 0


@part
def _put(work: Rounded, which: int, x: float, y: float) -> None:
    """Add a point to the old way, 0, or the new one, 1."""
    way = work.old if which == 0 else work.new
    way[work.sizes[which], 0], way[work.sizes[which], 1] = x, y
    work.sizes[which] += 1


@inner_part
def _put_bend(
    work: Rounded, x: float, y: float, in_x: float, in_y: float, turn: float, bend: float
) -> None:
    """Add a bend around the inside of a corner at (x, y) to the new way.

    It comes along the direction (``in_x``, ``in_y``) and turns by ``turn``, rad, with the radius
    ``bend``, in sides that touch the arc.
    """
    back = bend * math.tan(0.5 * abs(turn))
    left = math.copysign(bend, turn)
    middle_x, middle_y = x - back * in_x - left * in_y, y - back * in_y + left * in_x
    count = math.ceil(abs(turn) / _SIDE)
    outwards = left / math.cos(0.5 * turn / count)
    for number in range(count):
        angle = (number + 0.5) * turn / count
        cosine, sine = math.cos(angle), math.sin(angle)
        along_x, along_y = in_x * cosine - in_y * sine, in_x * sine + in_y * cosine
        _put(work, 1, middle_x + outwards * along_y, middle_y - outwards * along_x)
