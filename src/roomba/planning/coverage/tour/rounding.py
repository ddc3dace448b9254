"""Stage rounding: sharp corners become bends wherever that leaves hardly any floor unswept.

At a sharp corner the robot stops and turns on the spot; a bend is driven in one go. From one swath
to the next beside it there are two such corners: there the swaths go on a little farther, and a
bend leads from one into the other. Corners at which the outer floor is swept by nothing else, as in
those of rooms, stay.

Places in cells of the window: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, inner_part, part
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.floor.masks import way_fits
from roomba.planning.coverage.passes.sweep import (
    Counts,
    Legs,
    left_without,
    replace_legs,
    room_for_legs,
    set_leg,
    sweep,
)
from roomba.planning.coverage.tour.connection import tidy
from roomba.raster.distance import distance_to_nearest
from roomba.raster.regions import Mask

Line = NDArray[np.float64]

_SHARP: Final = 0.5
"""rad; at sharper corners the robot turns on the spot, others are bends already."""
_SHARPEST: Final = 2.4
"""rad; sharper corners stay: a bend would begin far before them."""
_SIDE: Final = 0.1
"""rad; a bend turns by no more at a point: so it is driven without slowing down for its points."""
_NARROWER: Final = 0.75
"""Radii of bends that are tried are by this factor apart, ..."""
_RADII: Final = 3
"""... and so many: tighter bends are driven as slowly as turns on the spot."""
_FARTHER: Final = 0.2
"""Widest radii; in such steps it is tried how much farther swaths go on, ..."""
_STEPS: Final = 5
"""... up to so many: a bend of the widest radius then leaves nothing."""
_LEAST_GAIN: Final = 1e-6
"""Cells of way by which a bend is better than another one: ..."""
_OFF: Final = 1e-6
"""... what is off by rounding, cells of way too, decides nothing."""
_BESIDE: Final = 2.0
"""cells; bends keep so much more than all ways do: in a bend the place is known less exactly, and a
touch takes more time than a stop."""
_ROOM: Final = 64
"""Points of a way around two corners: more than bends of _SHARPEST have, in sides of _SIDE."""


class Rounded(NamedTuple):
    """A way that is being rounded.

    ``points`` float64 [n, 2], of which the first ``size`` [0] are written down; ``counts`` int16
    [rows, columns]; ``need`` the cells that count; ``fits`` where the middle may be; ``old`` and
    ``new``, float64 [64, 2], are the ways around the corners at hand, of ``sizes`` [2] points, and
    ``legs`` those of both; ``radius`` is half the tool's width, cells, and ``spare`` [1] how many
    more cells may be left.
    """

    points: Line
    size: NDArray[np.int64]
    counts: Counts
    need: Mask
    fits: Mask
    old: Line
    new: Line
    sizes: NDArray[np.int64]
    legs: Legs
    radius: float
    spare: NDArray[np.int64]


def rounded(line: Line, need: Mask, fits: Mask, radius: float, config: CoverageConfig) -> Line:
    """Return the line with bends in place of sharp corners, with the same ends.

    ``need`` and ``fits`` are bool [rows, columns], ``radius`` is half the tool's width, cells, and
    the radius of the widest bend. A bend costs ``config.bend_unswept`` for each needed cell that it
    leaves, and what it makes the way longer; where that is below ``config.bend_worth`` it is taken.
    All in cells of way; in all they leave a share of ``config.spare`` at most. Bends keep a little
    more from where the middle does not fit than other ways.
    """
    line = tidy(fits, line)
    if len(line) < 3:
        return line
    work = Rounded(
        np.empty((len(line) * _ROOM // 2, 2)),
        np.zeros(1, np.int64),
        np.zeros(need.shape, np.int16),
        need,
        distance_to_nearest(~fits) > _BESIDE,
        np.empty((_ROOM, 2)),
        np.empty((_ROOM, 2)),
        np.zeros(2, np.int64),
        room_for_legs(),
        radius,
        np.array([int(config.spare * need.sum())]),
    )
    _round(work, line, config.bend_unswept, config.bend_worth)
    return work.points[: work.size[0]].copy()


@allocating_entry
def _round(work: Rounded, line: Line, unswept: float, worth: float) -> None:
    """Go along the line, corner by corner, and write it down with bends."""
    sweep(work.counts, line, work.radius)
    last = len(line) - 1
    _write(work, line[0])
    at = 1
    while at <= last:
        is_corner = at < last and _is_sharp(_turn_at(work, line, at))
        if is_corner and at + 1 < last and _try_both(work, line, at, unswept, worth):
            at += 2
        elif is_corner and _try_one(work, line, at, unswept, worth):
            at += 1
        else:
            _write(work, line[at])
            at += 1


@part
def _write(work: Rounded, place: Line) -> None:
    size = work.size[0]
    work.points[size, 0], work.points[size, 1] = place[0], place[1]
    work.size[0] = size + 1


@part
def _turn(ax: float, ay: float, bx: float, by: float) -> float:
    """Return the angle from one direction to another, rad."""
    return math.atan2(ax * by - ay * bx, ax * bx + ay * by)


@inner_part
def _turn_at(work: Rounded, line: Line, at: int) -> float:
    """Return how much the way turns at a point of the line, rad, from where it is written down."""
    before, here, after = work.points[work.size[0] - 1], line[at], line[at + 1]
    return _turn(here[0] - before[0], here[1] - before[1], after[0] - here[0], after[1] - here[1])


@part
def _is_sharp(turn: float) -> bool:
    return _SHARP < abs(turn) < _SHARPEST


@inner_part
def _try_both(work: Rounded, line: Line, at: int, unswept: float, worth: float) -> bool:
    """Put bends in place of a corner and the next one, and tell whether it was done.

    The ways before and behind them go on farther, by what costs least.
    """
    least, best = worth, -1.0
    for step in range(_STEPS + 1):
        farther = step * _FARTHER * work.radius
        if _bend_both(work, line, at, farther):
            cost = _cost(work, unswept, least)
            if cost < least - _LEAST_GAIN:
                least, best = cost, farther
    if best < 0.0:
        return False
    _bend_both(work, line, at, best)
    _take(work)
    return True


@inner_part
def _try_one(work: Rounded, line: Line, at: int, unswept: float, worth: float) -> bool:
    """Put a bend in place of a corner, the widest that is worth it; tell whether it was done."""
    bend = work.radius
    for _ in range(_RADII):
        if _bend_one(work, line, at, bend) and _cost(work, unswept, worth) < worth:
            _take(work)
            return True
        bend *= _NARROWER
    return False


@inner_part
def _bend_both(work: Rounded, line: Line, at: int, farther: float) -> bool:
    """Lay out the old and the new way around two corners that turn to the same side.

    The ways before and behind them go on by ``farther``. False where there is no room for bends.
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
    if not (_is_sharp(first) and _is_sharp(second) and first * second > 0.0):
        return False
    first_tangent, second_tangent = math.tan(0.5 * abs(first)), math.tan(0.5 * abs(second))
    bend = min(work.radius, across / (first_tangent + second_tangent))
    back, on = bend * first_tangent - farther, bend * second_tangent - farther
    if bend < _NARROWER**_RADII * work.radius or back > come - _OFF or on > go - _OFF:
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
def _bend_one(work: Rounded, line: Line, at: int, bend: float) -> bool:
    """Lay out the old and the new way around a corner; False where a bend has no room.

    Half of the way to the next point is left to the corner there.
    """
    before, here, after = work.points[work.size[0] - 1], line[at], line[at + 1]
    turn = _turn_at(work, line, at)
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


@inner_part
def _cost(work: Rounded, unswept: float, most: float) -> float:
    """Return what the new way costs in place of the old one, cells of way; infinite where it does
    not fit, or is longer by ``most``."""
    longer = _length(work.new, work.sizes[1]) - _length(work.old, work.sizes[0])
    if longer >= most or not _fits(work):
        return math.inf
    left = _left(work)
    return longer + unswept * left if left <= max(work.spare[0], 0) else math.inf


@part
def _length(way: Line, size: int) -> float:
    length = 0.0
    for leg in range(size - 1):
        length += math.hypot(way[leg + 1, 0] - way[leg, 0], way[leg + 1, 1] - way[leg, 1])
    return length


@inner_part
def _fits(work: Rounded) -> bool:
    way = work.new
    for leg in range(work.sizes[1] - 1):
        if not way_fits(work.fits, way[leg, 0], way[leg, 1], way[leg + 1, 0], way[leg + 1, 1]):
            return False
    return True


@inner_part
def _left(work: Rounded) -> int:
    """Return how many more needed cells nothing sweeps with the new way in place of the old one.

    Both ways are written down as legs.
    """
    at = 0
    for which in range(2):
        way = work.old if which == 0 else work.new
        for leg in range(work.sizes[which] - 1):
            x, y = way[leg]
            set_leg(work.legs, at, x, y, way[leg + 1, 0], way[leg + 1, 1])
            at += 1
    old = work.sizes[0] - 1
    return left_without(work.need, work.counts, work.legs, old, at, work.radius, np.inf)


@inner_part
def _take(work: Rounded) -> None:
    """Go the new way in place of the old one, and write it down."""
    work.spare[0] -= _left(work)
    old = work.sizes[0] - 1
    replace_legs(work.counts, work.legs, old, old + work.sizes[1] - 1, work.radius)
    for at in range(work.sizes[1]):
        _write(work, work.new[at])
