"""Stage rounding: sharp corners become bends wherever that leaves hardly any floor unswept.

At a sharp corner the robot stops and turns on the spot; a bend is driven in one go. From one swath
to the next beside it there are two such corners: there the swaths go on a little farther, and a
bend leads from one into the other. A corner stays if nothing else sweeps the floor on its outside,
as in the corners of rooms.

Places in cells of the window: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Floats, Mask, Polyline
from roomba.compilation import allocating_entry, inner_part, part
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.floor.masks import grown, half_widths, way_fits
from roomba.planning.coverage.passes.sweep import (
    left_without,
    replace_legs,
    room_for_legs,
    set_leg,
    sweep,
)
from roomba.planning.coverage.tour.bends import (
    NARROWER,
    RADII,
    ROOM,
    Rounded,
    bend_both,
    bend_one,
    is_sharp,
    turn_at,
)
from roomba.planning.coverage.tour.connection import tidy

_FARTHER: Final = 0.2
"""In widest radii; step by which swaths are tried to go on farther."""
_STEPS: Final = 5
"""Such steps, at most: a bend of the widest radius then leaves no floor."""
_LEAST_GAIN: Final = 1e-6
"""Cells of way that a bend must save to count as better than another one."""
_BESIDE: Final = 2.0
"""cells; bends keep so much more distance than other ways: in a bend the pose is known less
exactly, and a touch takes more time than a stop."""


def rounded(
    line: Polyline, need: Mask, fits: Mask, radius: float, sharp: float, config: CoverageConfig
) -> Polyline:
    """Return the line with bends in place of sharp corners, with the same ends.

    ``need`` and ``fits`` are bool [rows, columns], ``radius`` is half the tool's width, cells, and
    the radius of the widest bend. At corners of more than ``sharp``, rad, the robot turns on the
    spot; softer ones it rounds off as it drives, and they stay.

    A bend costs ``config.bend_unswept`` for each needed cell that it leaves, plus the length that
    it adds to the way. It is taken if it costs less than ``config.bend_worth``; all costs are in
    cells of way. All bends together leave a share of ``config.spare`` of the needed cells at most.
    Bends keep a little more distance from where the middle does not fit than other ways.
    """
    line = tidy(fits, line)
    if len(line) < 3:
        return line
    work = Rounded(
        np.empty((len(line) * ROOM // 2, 2)),
        np.zeros(1, np.int64),
        np.zeros(need.shape, np.int16),
        need,
        ~grown(~fits, half_widths(_BESIDE)),
        np.empty((ROOM, 2)),
        np.empty((ROOM, 2)),
        np.zeros(2, np.int64),
        room_for_legs(),
        radius,
        sharp,
        np.array([int(config.spare * need.sum())]),
    )
    _round(work, line, config.bend_unswept, config.bend_worth)
    return work.points[: work.size[0]].copy()


@allocating_entry
def _round(work: Rounded, line: Polyline, unswept: float, worth: float) -> None:
    """Go along the line, corner by corner, and write it down with bends."""
    sweep(work.counts, line, work.radius)
    last = len(line) - 1
    _write(work, line[0])
    at = 1
    while at <= last:
        is_corner = at < last and is_sharp(work, turn_at(work, line, at))
        if is_corner and at + 1 < last and _try_both(work, line, at, unswept, worth):
            at += 2
        elif is_corner and _try_one(work, line, at, unswept, worth):
            at += 1
        else:
            _write(work, line[at])
            at += 1


@part
def _write(work: Rounded, place: Floats) -> None:
    size = work.size[0]
    work.points[size, 0], work.points[size, 1] = place[0], place[1]
    work.size[0] = size + 1


@inner_part
def _try_both(work: Rounded, line: Polyline, at: int, unswept: float, worth: float) -> bool:
    """Put bends in place of a corner and the next one; return whether it was done.

    The ways before and behind them go on farther by the step that costs least.
    """
    least, best = worth, -1.0
    for step in range(_STEPS + 1):
        farther = step * _FARTHER * work.radius
        if bend_both(work, line, at, farther):
            cost = _cost(work, unswept, least)
            if cost < least - _LEAST_GAIN:
                least, best = cost, farther
    if best < 0.0:
        return False
    bend_both(work, line, at, best)
    _take(work)
    return True


@inner_part
def _try_one(work: Rounded, line: Polyline, at: int, unswept: float, worth: float) -> bool:
    """Put the widest bend that is worth it in place of a corner; return whether it was done."""
    bend = work.radius
    for _ in range(RADII):
        if bend_one(work, line, at, bend) and _cost(work, unswept, worth) < worth:
            _take(work)
            return True
        bend *= NARROWER
    return False


@inner_part
def _cost(work: Rounded, unswept: float, most: float) -> float:
    """Return the cost of the new way in place of the old one, cells of way; infinite if the new one
    does not fit, or is longer by ``most``."""
    longer = _length(work.new, work.sizes[1]) - _length(work.old, work.sizes[0])
    if longer >= most or not _fits(work):
        return math.inf
    left = _left(work)
    return longer + unswept * left if left <= max(work.spare[0], 0) else math.inf


@part
def _length(way: Polyline, size: int) -> float:
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
    """Return how many more needed cells are left unswept by the new way in place of the old one.

    Both ways are written to the work array of legs.
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
    """Take the new way in place of the old one, and write its points."""
    work.spare[0] -= _left(work)
    old = work.sizes[0] - 1
    replace_legs(work.counts, work.legs, old, old + work.sizes[1] - 1, work.radius)
    for at in range(work.sizes[1]):
        _write(work, work.new[at])
