"""Stage polish: makes the way shorter and straighter where that leaves hardly any floor unswept.

Ends of swaths that other legs sweep are shortened, corners are cut, small zigzags and redundant
pieces are removed. Places in cells of the window: (x, y) is (column, row).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask, Polyline
from roomba.compilation import allocating_entry, inner_part, part
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.floor.masks import way_fits
from roomba.planning.coverage.passes.edges import cut
from roomba.planning.coverage.passes.sweep import (
    Counts,
    Legs,
    left_without,
    replace_legs,
    room_for_legs,
    set_leg,
    sweep,
)

_LEG = 24.0
"""cells; longer legs are cut, so that each change affects little floor."""
_LONGEST = 60.0
"""cells; no leg longer than this is made."""
_ROUNDS = 14
_LEAST_GAIN = 0.02
_BENDS = 0.01
"""rad; no change is tried around a point where the way turns by less than this."""


class Bent(NamedTuple):
    """A way that is being changed: its points, their neighbours along it, and the swept cells.

    ``points`` float64 [n, 2]; ``before`` and ``after`` int64 [n], -1 past the ends; ``on_way``
    bool [n], which points are still on the way; ``counts`` int16 [rows, columns]; ``need`` the
    cells to sweep; ``fits`` where the middle may be; ``spare``, int64 [1], how many more cells may
    be left; ``legs`` those of the change at hand.
    """

    points: Polyline
    before: NDArray[np.int64]
    after: NDArray[np.int64]
    on_way: Mask
    counts: Counts
    need: Mask
    fits: Mask
    spare: NDArray[np.int64]
    legs: Legs


def polished(
    line: Polyline, need: Mask, fits: Mask, radius: float, config: CoverageConfig
) -> Polyline:
    """Return the line changed to cost less, with the same ends.

    Its cost is its length, ``config.polish_turning`` for each radian and ``config.unswept`` for
    each needed cell left, all in cells of way; ``need`` and ``fits`` are bool [rows, columns],
    ``radius`` in cells.
    """
    if len(line) < 3:
        return line
    points = cut(line, _LEG)
    count = len(points)
    bent = Bent(
        points,
        np.arange(-1, count - 1),
        np.append(np.arange(1, count), -1),
        np.ones(count, np.bool_),
        np.zeros(need.shape, np.int16),
        need,
        fits,
        np.array([int(config.spare * need.sum())]),
        room_for_legs(),
    )
    _polish(bent, radius, config.polish_turning, config.unswept)
    kept = [0]
    while bent.after[kept[-1]] >= 0:
        kept.append(int(bent.after[kept[-1]]))
    return bent.points[kept]


@part
def _turn(points: Polyline, one: int, two: int, three: int) -> float:
    """Return how much the way turns at the second of three points, rad."""
    if one < 0 or three < 0:
        return 0.0
    ax, ay = points[one]
    bx, by = points[two]
    cx, cy = points[three]
    return _angle(bx - ax, by - ay, cx - bx, cy - by)


@part
def _turn_if_moved(
    points: Polyline, one: int, two: int, three: int, moved: int, x: float, y: float
) -> float:
    """Return that turn, rad, if ``moved``, one of the three points, were at (x, y)."""
    if one < 0 or three < 0:
        return 0.0
    ax, ay = points[one]
    bx, by = points[two]
    cx, cy = points[three]
    if one == moved:
        ax, ay = x, y
    if two == moved:
        bx, by = x, y
    if three == moved:
        cx, cy = x, y
    return _angle(bx - ax, by - ay, cx - bx, cy - by)


@part
def _angle(in_x: float, in_y: float, out_x: float, out_y: float) -> float:
    """Return the angle between two directions, rad."""
    return abs(math.atan2(in_x * out_y - in_y * out_x, in_x * out_x + in_y * out_y))


@inner_part
def _try_shortcut(
    bent: Bent, at: int, span: int, radius: float, turning: float, floor: float
) -> bool:
    """Go straight from a point to the ``span``-th after it, if that costs less."""
    points, after = bent.points, bent.after
    to = at
    length = 0.0
    turned = _turn(points, bent.before[at], at, after[at])
    for _ in range(span):
        on = after[to]
        if on < 0:
            return False
        length += math.hypot(points[on, 0] - points[to, 0], points[on, 1] - points[to, 1])
        turned += _turn(points, to, on, after[on])
        to = on
    x, y = points[at]
    to_x, to_y = points[to]
    straight = math.hypot(to_x - x, to_y - y)
    if straight > _LONGEST:
        return False
    turned -= _turn(points, bent.before[at], at, to)
    turned -= _turn(points, at, to, after[to])
    gain = length - straight + turning * turned
    if gain < _LEAST_GAIN or not way_fits(bent.fits, x, y, to_x, to_y):
        return False
    on = at
    for leg in range(span):
        _set_between(bent, leg, on, after[on])
        on = after[on]
    set_leg(bent.legs, span, x, y, to_x, to_y)
    if not _is_worth_it(bent, span, span + 1, gain, radius, floor):
        return False
    on = after[at]
    while on != to:
        bent.on_way[on] = False
        on = after[on]
    after[at] = to
    bent.before[to] = at
    return True


@part
def _set_between(bent: Bent, at: int, one: int, other: int) -> None:
    """Write the leg between two points as one of those that a change concerns."""
    points = bent.points
    set_leg(bent.legs, at, points[one, 0], points[one, 1], points[other, 0], points[other, 1])


@inner_part
def _is_worth_it(
    bent: Bent, old: int, count: int, gain: float, radius: float, floor: float
) -> bool:
    """Whether the new legs are worth it in place of the first ``old``, for all that they leave.

    If so, the swept cells are counted anew.
    """
    most = min((gain - _LEAST_GAIN) / floor, max(bent.spare[0], 0))
    left = left_without(bent.need, bent.counts, bent.legs, old, count, radius, most)
    if left > most:
        return False
    bent.spare[0] -= left
    replace_legs(bent.counts, bent.legs, old, count, radius)
    return True


@inner_part
def _try_move(
    bent: Bent, at: int, x: float, y: float, radius: float, turning: float, floor: float
) -> bool:
    """Move a point to (x, y), if that costs less."""
    points = bent.points
    one, three = bent.before[at], bent.after[at]
    now_x, now_y = points[at]
    ax, ay = points[one]
    cx, cy = points[three]
    gain = math.hypot(now_x - ax, now_y - ay) + math.hypot(cx - now_x, cy - now_y)
    gain -= math.hypot(x - ax, y - ay) + math.hypot(cx - x, cy - y)
    zero, four = bent.before[one], bent.after[three]
    turned = (
        _turn(points, zero, one, at)
        + _turn(points, one, at, three)
        + _turn(points, at, three, four)
        - _turn_if_moved(points, zero, one, at, at, x, y)
        - _turn_if_moved(points, one, at, three, at, x, y)
        - _turn_if_moved(points, at, three, four, at, x, y)
    )
    gain += turning * turned
    if gain < _LEAST_GAIN:
        return False
    if not (way_fits(bent.fits, ax, ay, x, y) and way_fits(bent.fits, x, y, cx, cy)):
        return False
    _set_between(bent, 0, one, at)
    _set_between(bent, 1, at, three)
    set_leg(bent.legs, 2, ax, ay, x, y)
    set_leg(bent.legs, 3, x, y, cx, cy)
    if not _is_worth_it(bent, 2, 4, gain, radius, floor):
        return False
    points[at, 0], points[at, 1] = x, y
    return True


@inner_part
def _improve_at(bent: Bent, at: int, radius: float, turning: float, floor: float) -> bool:
    """Try all changes around a point; return whether one was made."""
    points = bent.points
    before, after = bent.before[at], bent.after[at]
    if before < 0 or after < 0:
        return False
    if _turn(points, before, at, after) < _BENDS:
        return False
    for span in (2, 4):
        if _try_shortcut(bent, before, span, radius, turning, floor):
            return True
    x, y = points[at]
    mid_x = (points[before, 0] + points[after, 0]) / 2
    mid_y = (points[before, 1] + points[after, 1]) / 2
    for step in (6.0, 2.0):
        for goal in range(3):
            if goal == 0:
                to_x, to_y = points[before]
            elif goal == 1:
                to_x, to_y = points[after]
            else:
                to_x, to_y = mid_x, mid_y
            away = math.hypot(to_x - x, to_y - y)
            if away < step + 0.5:
                continue
            share = step / away
            if _try_move(
                bent,
                at,
                x + share * (to_x - x),
                y + share * (to_y - y),
                radius,
                turning,
                floor,
            ):
                return True
    return False


@part
def _wake(waiting: Mask, beside: NDArray[np.int64], at: int) -> None:
    """Let the next three points on one side of a point wait to be tried again."""
    on = beside[at]
    for _ in range(3):
        if on < 0:
            break
        waiting[on] = True
        on = beside[on]


@allocating_entry
def _polish(bent: Bent, radius: float, turning: float, floor: float) -> None:
    """Change the way point by point, until no change costs less or the rounds are used up."""
    points = bent.points
    sweep(bent.counts, points, radius)
    waiting = np.ones(len(points), np.bool_)
    for _ in range(_ROUNDS):
        changed = False
        at = 0
        while at >= 0:
            if waiting[at] and bent.on_way[at]:
                waiting[at] = False
                if _improve_at(bent, at, radius, turning, floor):
                    changed = True
                    waiting[at] = True
                    _wake(waiting, bent.before, at)
                    _wake(waiting, bent.after, at)
            at = bent.after[at]
        if not changed:
            break
