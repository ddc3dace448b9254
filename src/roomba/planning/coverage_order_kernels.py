"""Compiled search for a good order of pieces: a tour over their ends, improved move by move.

Piece i has the ends 2 i and 2 i + 1. A tour, int32 [2 n], lists the ends as they are passed: the
two ends of a piece at the positions 2 k and 2 k + 1, a connection between 2 k + 1 and 2 k + 2. The
first piece keeps its place, and the last one too.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Tour = NDArray[np.int32]

_GAIN = 1e-6
_FAR = 1e7
_MOST_MOVES = 20
"""moves for each end; far more than are ever made."""


class Costs(NamedTuple):
    """What connections cost: between each end and its nearest ones, and those first made.

    ``nearest`` int32 [ends, k], -1 for none, with ``costs``; ``given`` int32 [ends], the end that
    each was first connected to or -1, with ``given_costs``. ``loose``: the last piece costs nothing
    to get to. All others are too far.
    """

    nearest: NDArray[np.int32]
    costs: NDArray[np.float64]
    given: NDArray[np.int32]
    given_costs: NDArray[np.float64]
    loose: bool


@njit(cache=True, nogil=True)
def cost_of(costs: Costs, one: int, other: int) -> float:
    """Return what the connection of two ends costs."""
    if costs.loose and (one >= costs.given.size - 2 or other >= costs.given.size - 2):
        return 0.0
    for k in range(costs.nearest.shape[1]):
        if costs.nearest[one, k] == other:
            return costs.costs[one, k]
        if costs.nearest[one, k] < 0:
            break
    for k in range(costs.nearest.shape[1]):
        if costs.nearest[other, k] == one:
            return costs.costs[other, k]
        if costs.nearest[other, k] < 0:
            break
    if costs.given[one] == other:
        return costs.given_costs[one]
    return _FAR


@njit(cache=True, nogil=True)
def tour_cost(costs: Costs, tour: Tour) -> float:
    """Return what all connections of a tour cost."""
    total = 0.0
    for at in range(1, tour.size - 1, 2):
        total += cost_of(costs, tour[at], tour[at + 1])
    return total


@njit(cache=True, nogil=True)
def greedy_links(costs: Costs) -> NDArray[np.int32]:
    """Return the end that each is connected to, or -1: cheapest connections first, no circles.

    int32 [ends]. The outer ends of the first and the last piece stay free.
    """
    ends, most = costs.nearest.shape
    links = np.full(ends, -1, np.int32)
    far_end = np.arange(ends) ^ 1
    order = np.argsort(costs.costs.ravel(), kind="mergesort")
    for index in order:
        one, other = index // most, costs.nearest[index // most, index % most]
        if other < 0:
            break
        if one in (0, ends - 1) or other in (0, ends - 1):
            continue
        if links[one] >= 0 or links[other] >= 0 or far_end[one] == other:
            continue
        first, last = far_end[one], far_end[other]
        if (first == 0 and last == ends - 1) or (first == ends - 1 and last == 0):
            continue
        links[one], links[other] = other, one
        far_end[first], far_end[last] = last, first
    return links


@njit(cache=True, nogil=True)
def _reverse(tour: Tour, position: Tour, first: int, last: int) -> None:
    while first < last:
        one, other = tour[first], tour[last]
        tour[first], tour[last] = other, one
        position[other], position[one] = first, last
        first += 1
        last -= 1
    if first == last:
        position[tour[first]] = first


@njit(cache=True, nogil=True)
def _try_end(costs: Costs, tour: Tour, position: Tour, end: int, touched: Tour) -> int:
    """Make the first move that a better connection of one end allows.

    Returns how many ends it concerned, written to ``touched``; 0 when there is no such move.
    """
    size = tour.size
    at = position[end]
    leaves = at % 2 == 1
    partner_at = at + 1 if leaves else at - 1
    if partner_at < 0 or partner_at >= size:
        return 0
    partner = tour[partner_at]
    now = cost_of(costs, end, partner)
    for k in range(costs.nearest.shape[1]):
        other = costs.nearest[end, k]
        if other < 0:
            break
        gain = now - costs.costs[end, k]
        if gain <= _GAIN:
            break
        other_at = position[other]
        other_leaves = other_at % 2 == 1
        other_partner_at = other_at + 1 if other_leaves else other_at - 1
        if other == partner or other_partner_at < 0 or other_partner_at >= size:
            continue
        other_partner = tour[other_partner_at]
        gain += cost_of(costs, other, other_partner)
        if leaves == other_leaves:
            if gain - cost_of(costs, partner, other_partner) > _GAIN:
                first = min(max(at, partner_at), max(other_at, other_partner_at))
                last = max(min(at, partner_at), min(other_at, other_partner_at))
                _reverse(tour, position, first, last)
                touched[0], touched[1] = end, other
                touched[2], touched[3] = partner, other_partner
                return 4
        else:
            moved = _swap_runs(costs, tour, position, at, other_at, gain, touched)
            if moved > 0:
                return moved
        moved = _move_run(costs, tour, position, end, other, touched)
        if moved > 0:
            return moved
    return 0


@njit(cache=True, nogil=True)
def _swap_runs(
    costs: Costs, tour: Tour, position: Tour, at: int, other_at: int, gain: float, touched: Tour
) -> int:
    """Let two neighbouring runs of pieces change places, without turning either.

    The connection of the ends at ``at`` and ``other_at`` is new and brings ``gain``; which third
    connection is broken is searched here.
    """
    size = tour.size
    leaver_at, entry_at = (at, other_at) if at % 2 == 1 else (other_at, at)
    if entry_at > leaver_at:
        # ... a | b ... c | d ... e | f ...  becomes  a d ... e b ... c f, with a, d given.
        a, b = tour[leaver_at], tour[leaver_at + 1]
        c, d = tour[entry_at - 1], tour[entry_at]
        for k in range(costs.nearest.shape[1]):
            e = costs.nearest[b, k]
            if e < 0 or costs.costs[b, k] >= gain - _GAIN:
                break
            e_at = position[e]
            if e_at % 2 == 0 or e_at < entry_at or e_at + 1 >= size:
                continue
            f = tour[e_at + 1]
            if gain - costs.costs[b, k] + cost_of(costs, e, f) - cost_of(costs, c, f) > _GAIN:
                _exchange(tour, position, leaver_at + 1, entry_at, e_at + 1)
                touched[0], touched[1], touched[2] = a, b, c
                touched[3], touched[4], touched[5] = d, e, f
                return 6
    else:
        # ... a | b ... c | d ... e | f ...  with e, b given: the run from b to e would be a circle.
        b, e = tour[entry_at], tour[leaver_at]
        if entry_at == 0 or leaver_at == size - 1:
            return 0
        a, f = tour[entry_at - 1], tour[leaver_at + 1]
        for k in range(costs.nearest.shape[1]):
            d = costs.nearest[a, k]
            if d < 0 or costs.costs[a, k] >= gain - _GAIN:
                break
            d_at = position[d]
            if d_at % 2 == 1 or d_at <= entry_at or d_at > leaver_at:
                continue
            c = tour[d_at - 1]
            if gain - costs.costs[a, k] + cost_of(costs, c, d) - cost_of(costs, c, f) > _GAIN:
                _exchange(tour, position, entry_at, d_at, leaver_at + 1)
                touched[0], touched[1], touched[2] = a, b, c
                touched[3], touched[4], touched[5] = d, e, f
                return 6
    return 0


@njit(cache=True, nogil=True)
def _exchange(tour: Tour, position: Tour, first: int, middle: int, stop: int) -> None:
    """Swap the runs at [first, middle) and [middle, stop)."""
    moved = np.concatenate((tour[middle:stop], tour[first:middle]))
    for n in range(moved.size):
        tour[first + n] = moved[n]
        position[moved[n]] = first + n


@njit(cache=True, nogil=True)
def _move_run(costs: Costs, tour: Tour, position: Tour, end: int, other: int, touched: Tour) -> int:
    """Move a run of one to three pieces that begins with ``end`` to the side of ``other``."""
    size = tour.size
    at = position[end]
    leaves = at % 2 == 1
    other_at = position[other]
    for pieces in range(1, 4):
        # The run reaches away from the connection of ``end`` that is to be broken.
        first, last = (at - 2 * pieces + 1, at) if leaves else (at, at + 2 * pieces - 1)
        if first < 2 or last > size - 3:
            return 0
        if first <= other_at <= last:
            return 0
        before, after = tour[first - 1], tour[last + 1]
        far = tour[first] if leaves else tour[last]
        saved = cost_of(costs, before, tour[first]) + cost_of(costs, tour[last], after)
        saved -= cost_of(costs, before, after)
        partner_at = other_at + 1 if other_at % 2 == 1 else other_at - 1
        if partner_at < 0 or partner_at >= size or first <= partner_at <= last:
            continue
        partner = tour[partner_at]
        spent = cost_of(costs, end, other) + cost_of(costs, far, partner)
        spent -= cost_of(costs, other, partner)
        if saved - spent > _GAIN:
            gap = max(other_at, partner_at)
            if gap > last:
                _exchange(tour, position, first, last + 1, gap)
                first, last = gap - 2 * pieces, gap - 1
            else:
                _exchange(tour, position, gap, first, last + 1)
                first, last = gap, gap + 2 * pieces - 1
            entered = tour[first - 1]
            if (entered == other) != (tour[first] == end):
                _reverse(tour, position, first, last)
            touched[0], touched[1], touched[2] = end, other, far
            touched[3], touched[4], touched[5] = partner, before, after
            return 6
    return 0


@njit(cache=True, nogil=True)
def improve(
    costs: Costs, tour: Tour, position: Tour, queue: Tour, waiting: NDArray[np.bool_]
) -> None:
    """Make moves until none helps, looking again at the ends that a move concerned.

    ``waiting``, bool [ends], marks the ends to look at first; all false afterwards.
    """
    touched = np.empty(6, np.int32)
    size = 0
    for end in tour:
        if waiting[end]:
            queue[size] = end
            size += 1
    head = 0
    count = size
    moves = 0
    while count > 0 and moves < _MOST_MOVES * tour.size:
        end = queue[head]
        head = (head + 1) % queue.size
        count -= 1
        waiting[end] = False
        while True:
            concerned = _try_end(costs, tour, position, end, touched)
            if concerned == 0 or moves >= _MOST_MOVES * tour.size:
                break
            moves += 1
            for n in range(concerned):
                other = touched[n]
                if not waiting[other] and other != end:
                    waiting[other] = True
                    queue[(head + count) % queue.size] = other
                    count += 1


@njit(cache=True, nogil=True)
def shake(costs: Costs, tour: Tour, rounds: int) -> None:
    """Improve a tour, then again and again from where short runs near each other were exchanged.

    The exchanges are drawn from a fixed sequence, so the outcome is always the same.
    """
    ends = tour.size
    position = np.empty(ends, np.int32)
    for at in range(ends):
        position[tour[at]] = at
    queue = np.empty(ends, np.int32)
    waiting = np.ones(ends, np.bool_)
    improve(costs, tour, position, queue, waiting)
    pieces = ends // 2
    if pieces < 6:
        return
    best = tour.copy()
    best_cost = tour_cost(costs, tour)
    state = np.uint64(88172645463325252)
    for _ in range(rounds):
        state ^= state << np.uint64(13)
        state ^= state >> np.uint64(7)
        state ^= state << np.uint64(17)
        span = min(pieces - 2, 30)
        begin = 1 + int(state % np.uint64(pieces - 1 - span)) if pieces - 1 > span else 1
        one = int((state >> np.uint64(20)) % np.uint64(span - 2)) + 1
        two = int((state >> np.uint64(40)) % np.uint64(span - 1 - one)) + 1
        first, middle, stop = 2 * begin, 2 * (begin + one), 2 * (begin + one + two)
        if stop > ends - 2:
            continue
        for at in (first - 1, first, middle - 1, middle, stop - 1, stop):
            waiting[tour[at]] = True
        _exchange(tour, position, first, middle, stop)
        improve(costs, tour, position, queue, waiting)
        cost = tour_cost(costs, tour)
        if cost < best_cost - _GAIN:
            best_cost = cost
            best[:] = tour
        elif cost > best_cost + _GAIN:
            tour[:] = best
            for at in range(ends):
                position[tour[at]] = at
    tour[:] = best
