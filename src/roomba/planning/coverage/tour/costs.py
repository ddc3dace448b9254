"""Compiled costs of connections between the ends of pieces, looked up or found when asked for.

Piece i has the ends 2 i and 2 i + 1; places in cells of the window: (x, y) is (column, row).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.arrays import Mask
from roomba.compilation import allocating_entry, entry, inner_part, part

Tour = NDArray[np.int32]
"""The ends of pieces as they are passed, int32 [2 n]: the two ends of a piece at the positions 2 k
and 2 k + 1, a connection between 2 k + 1 and 2 k + 2."""

_HIDDEN = 2.0
"""Estimated length of an unknown way out of sight, as a multiple of the straight one."""
_AROUND = 200.0
"""cells; added to that estimate."""
_LOOKS = 8.0
"""cells; distance between the places at which a straight way is tested."""
_PARTS = 256.0
"""Costs are whole numbers of these parts of a cell: sums are exact, and no move undoes another."""
_KNOWN = 256
_PROBES = 16
_SCATTER = 37
_COST = (1 << 40) - 1


class Costs(NamedTuple):
    """Costs of connections: their length, and ``turning`` cells for each radian.

    ``nearest`` int32 [ends, k] are the nearest ends of each, the cheapest first, -1 for none, with
    their ``costs``, which are the same in both directions. ``known``, int64 [ends, 256], is a hash
    table for each end: of a pair, the row of the lower end holds the higher end + 1, shifted, and
    the cost in parts. It is small enough for the processor's cache. ``at`` float64 [ends, 2] are
    the ends' places on ``fits``; ``headings`` float64 [ends], rad, lead out of the pieces, NaN for
    a piece without length. ``loose``: the last piece costs nothing to get to.
    """

    nearest: NDArray[np.int32]
    costs: NDArray[np.float64]
    known: NDArray[np.int64]
    at: NDArray[np.float64]
    headings: NDArray[np.float64]
    fits: Mask
    turning: float
    loose: bool


def costs_of(
    nearest: NDArray[np.int32],
    lengths: NDArray[np.float64],
    at: NDArray[np.float64],
    headings: NDArray[np.float64],
    fits: Mask,
    turning: float,
    loose: bool,
) -> Costs:
    """Return costs from the ``lengths``, float64 [ends, k], of the ways to the ``nearest`` ends."""
    known = np.zeros((len(at), _KNOWN), np.int64)
    costs = Costs(nearest, lengths, known, at, headings, fits, turning, loose)
    _add_turns(costs)
    return costs


@entry
def note_pair(costs: Costs, one: int, other: int, cost: float) -> float:
    """Store a connection's cost, if there is room, and return it rounded to parts of a cell."""
    low, high = min(one, other), max(one, other)
    parts = np.int64(cost * _PARTS + 0.5)
    for probe in range(_PROBES):
        at = (high * _SCATTER + probe) & (_KNOWN - 1)
        if costs.known[low, at] == 0 or costs.known[low, at] >> 40 == high + 1:
            costs.known[low, at] = np.int64(high + 1) << 40 | parts
            break
    return float(parts / _PARTS)


@inner_part
def turns_between(costs: Costs, one: int, other: int) -> float:
    """Return the turns, rad, on the straight way from one end to another."""
    x, y = costs.at[other, 0] - costs.at[one, 0], costs.at[other, 1] - costs.at[one, 1]
    leaving, entering = costs.headings[one], costs.headings[other]
    if x * x + y * y < 1e-12:
        if math.isnan(leaving) or math.isnan(entering):
            return 0.0
        return math.pi - _between(leaving, entering)
    along = math.atan2(y, x)
    turns = 0.0 if math.isnan(leaving) else _between(along, leaving)
    return turns if math.isnan(entering) else turns + math.pi - _between(along, entering)


@part
def _between(one: float, other: float) -> float:
    """Return the angle between two headings, rad in [0, pi]."""
    return abs(wrapped(one - other))


@inner_part
def cost_of(costs: Costs, one: int, other: int) -> float:
    """Return the cost of connecting two ends; it is a guess if neither known nor in sight."""
    low, high = min(one, other), max(one, other)
    for probe in range(_PROBES):
        word = costs.known[low, (high * _SCATTER + probe) & (_KNOWN - 1)]
        if word >> 40 == high + 1:
            return float((word & _COST) / _PARTS)
        if word == 0:
            break
    return _cost_found(costs, one, other)


@part
def least_cost(costs: Costs, one: int, other: int) -> float:
    """Return the least that connecting two ends can cost, without looking anything up."""
    if costs.loose and max(one, other) >= len(costs.nearest) - 2:
        return 0.0
    x, y = costs.at[other, 0] - costs.at[one, 0], costs.at[other, 1] - costs.at[one, 1]
    return math.sqrt(x * x + y * y) - 1.0 / _PARTS


@inner_part
def _cost_found(costs: Costs, one: int, other: int) -> float:
    """Compute or guess the cost of a connection, and store it."""
    ends = len(costs.nearest)
    cost = 0.0
    if not (costs.loose and (one >= ends - 2 or other >= ends - 2)):
        x, y = costs.at[one]
        to_x, to_y = costs.at[other]
        cost = math.hypot(to_x - x, to_y - y)
        if not _is_in_sight(costs.fits, x, y, to_x, to_y):
            cost = _HIDDEN * cost + _AROUND
        cost += costs.turning * turns_between(costs, one, other)
    return note_pair(costs, one, other, cost)


@inner_part
def _is_in_sight(fits: Mask, x: float, y: float, to_x: float, to_y: float) -> bool:
    """Whether the middle fits on the straight way between two places, tested every few cells.

    No wall is missed: floor where the middle does not fit is wider than the distance between tests,
    as the middle keeps its distance on both sides of a wall.
    """
    looks = int(math.hypot(to_x - x, to_y - y) / _LOOKS)
    for look in range(1, looks + 1):
        share = look / (looks + 1)
        row, column = int(y + share * (to_y - y) + 0.5), int(x + share * (to_x - x) + 0.5)
        if not fits[row, column]:
            return False
    return True


@allocating_entry
def _add_turns(costs: Costs) -> None:
    """Add the turns to ``costs``, which are lengths so far; sort by the sum, and store all pairs.

    An end of a loose piece has no near ends.
    """
    ends, most = costs.nearest.shape
    for one in range(ends):
        for k in range(most):
            other = costs.nearest[one, k]
            if other < 0:
                continue
            if costs.loose and (one >= ends - 2 or other >= ends - 2):
                costs.nearest[one, k], costs.costs[one, k] = -1, np.inf
            else:
                cost = costs.costs[one, k] + costs.turning * turns_between(costs, one, other)
                costs.costs[one, k] = note_pair(costs, one, other, cost)
        order = np.argsort(costs.costs[one], kind="mergesort")
        near, cost_of_near = costs.nearest[one].copy(), costs.costs[one].copy()
        for k in range(most):
            costs.nearest[one, k] = near[order[k]]
            costs.costs[one, k] = cost_of_near[order[k]]


@entry
def tour_cost(costs: Costs, tour: Tour) -> float:
    """Return the cost of all connections of a tour."""
    total = 0.0
    for at in range(1, tour.size - 1, 2):
        total += cost_of(costs, tour[at], tour[at + 1])
    return total
