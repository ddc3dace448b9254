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

    ``nearest`` int32 [ends, k], the cheapest first, -1 for none, with ``costs``, the same there and
    back. ``pairs``, int64 [2 ** n], and ``pair_costs`` hold all that are known by the two ends,
    wherever :func:`_slot` finds room. ``loose``: the last piece costs nothing to get to. All others
    are too far.
    """

    nearest: NDArray[np.int32]
    costs: NDArray[np.float64]
    pairs: NDArray[np.int64]
    pair_costs: NDArray[np.float64]
    loose: bool


@njit(cache=True, nogil=True)
def _slot(pairs: NDArray[np.int64], ends: int, one: int, other: int) -> np.int64:
    """Return where two ends are noted, or would be: the first free slot from a scattered one on."""
    pair = np.int64(min(one, other)) * ends + max(one, other)
    at = (pair * 0x9E3779B1 >> 8) & (pairs.size - 1)
    while pairs[at] != pair and pairs[at] >= 0:
        at = (at + 1) & (pairs.size - 1)
    return at


@njit(cache=True, nogil=True)
def note_pair(costs: Costs, one: int, other: int, cost: float) -> None:
    """Note what a connection costs, if that is less than what is known."""
    ends = len(costs.nearest)
    at = _slot(costs.pairs, ends, one, other)
    if costs.pairs[at] < 0:
        costs.pairs[at] = np.int64(min(one, other)) * ends + max(one, other)
        costs.pair_costs[at] = cost
    else:
        costs.pair_costs[at] = min(costs.pair_costs[at], cost)


@njit(cache=True, nogil=True)
def note_nearest(costs: Costs) -> None:
    """Note all connections between near ends."""
    for one in range(len(costs.nearest)):
        for k in range(costs.nearest.shape[1]):
            if costs.nearest[one, k] >= 0:
                note_pair(costs, one, costs.nearest[one, k], costs.costs[one, k])


@njit(cache=True, nogil=True)
def cost_of(costs: Costs, one: int, other: int) -> float:
    """Return what the connection of two ends costs."""
    ends = len(costs.nearest)
    if costs.loose and (one >= ends - 2 or other >= ends - 2):
        return 0.0
    at = _slot(costs.pairs, ends, one, other)
    if costs.pairs[at] < 0:
        return _FAR
    return float(costs.pair_costs[at])


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


class Log(NamedTuple):
    """What moves did: ``gain`` float64 [1], ``span`` int64 [2], first and last position changed."""

    gain: NDArray[np.float64]
    span: NDArray[np.int64]


@njit(cache=True, nogil=True)
def _note(log: Log, gain: float, first: int, last: int) -> None:
    log.gain[0] += gain
    log.span[0] = min(log.span[0], first)
    log.span[1] = max(log.span[1], last)


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
def _try_end(costs: Costs, tour: Tour, position: Tour, end: int, touched: Tour, log: Log) -> int:
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
            won = gain - cost_of(costs, partner, other_partner)
            if won > _GAIN:
                first = min(max(at, partner_at), max(other_at, other_partner_at))
                last = max(min(at, partner_at), min(other_at, other_partner_at))
                _reverse(tour, position, first, last)
                _note(log, won, first, last)
                touched[0], touched[1] = end, other
                touched[2], touched[3] = partner, other_partner
                return 4
        else:
            moved = _swap_runs(costs, tour, position, at, other_at, gain, touched, log)
            if moved > 0:
                return moved
        moved = _move_run(costs, tour, position, end, other, touched, log)
        if moved > 0:
            return moved
    return 0


@njit(cache=True, nogil=True)
def _swap_runs(
    costs: Costs,
    tour: Tour,
    position: Tour,
    at: int,
    other_at: int,
    gain: float,
    touched: Tour,
    log: Log,
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
            won = gain - costs.costs[b, k] + cost_of(costs, e, f) - cost_of(costs, c, f)
            if won > _GAIN:
                _exchange(tour, position, leaver_at + 1, entry_at, e_at + 1)
                _note(log, won, leaver_at + 1, e_at)
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
            won = gain - costs.costs[a, k] + cost_of(costs, c, d) - cost_of(costs, c, f)
            if won > _GAIN:
                _exchange(tour, position, entry_at, d_at, leaver_at + 1)
                _note(log, won, entry_at, leaver_at)
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
def _move_run(
    costs: Costs, tour: Tour, position: Tour, end: int, other: int, touched: Tour, log: Log
) -> int:
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
            _note(log, saved - spent, min(first, gap), max(last, gap - 1))
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
    costs: Costs,
    tour: Tour,
    position: Tour,
    queue: Tour,
    count: int,
    waiting: NDArray[np.bool_],
    log: Log,
) -> None:
    """Make moves until none helps, looking again at the ends that a move concerned.

    The first ``count`` of ``queue``, int32 [ends], are looked at first; ``waiting``, bool [ends],
    is true for them, and all false afterwards.
    """
    touched = np.empty(6, np.int32)
    head = 0
    moves = 0
    while count > 0:
        end = queue[head]
        head = (head + 1) % queue.size
        count -= 1
        waiting[end] = False
        while moves < _MOST_MOVES * tour.size:
            concerned = _try_end(costs, tour, position, end, touched, log)
            if concerned == 0:
                break
            moves += 1
            for n in range(concerned):
                other = touched[n]
                if not waiting[other] and other != end:
                    waiting[other] = True
                    queue[(head + count) % queue.size] = other
                    count += 1


@njit(cache=True, nogil=True)
def _drawn(state: NDArray[np.uint64], below: int) -> np.int64:
    """Return the next number of a fixed sequence (xorshift), 0 to ``below`` - 1."""
    state[0] ^= state[0] << np.uint64(13)
    state[0] ^= state[0] >> np.uint64(7)
    state[0] ^= state[0] << np.uint64(17)
    return np.int64((state[0] >> np.uint64(11)) % np.uint64(below))


@njit(cache=True, nogil=True)
def _connection_near(costs: Costs, position: Tour, end: np.int64, state: NDArray[np.uint64]) -> int:
    """Return the position before a connection some steps from an end, from near end to near end."""
    for _ in range(1 + _drawn(state, 3)):
        known = 0
        while known < costs.nearest.shape[1] and costs.nearest[end, known] >= 0:
            known += 1
        if known == 0:
            break
        end = costs.nearest[end, _drawn(state, known)]
    at: int = position[end]
    return at if at % 2 == 1 else at - 1


@njit(cache=True, nogil=True)
def shake(costs: Costs, tour: Tour, rounds: int) -> None:
    """Improve a tour, then again and again from where runs between near places were exchanged.

    The exchanges are drawn from a fixed sequence, so the outcome is always the same.
    """
    ends = tour.size
    position = np.empty(ends, np.int32)
    for at in range(ends):
        position[tour[at]] = at
    queue = tour.copy()
    waiting = np.ones(ends, np.bool_)
    log = Log(np.zeros(1), np.array([ends, -1]))
    improve(costs, tour, position, queue, ends, waiting, log)
    if ends < 12:
        return
    best = tour.copy()
    state = np.array([88172645463325252], np.uint64)
    for _ in range(rounds):
        end = _drawn(state, ends)
        one = _connection_near(costs, position, end, state)
        two = _connection_near(costs, position, end, state)
        three = _connection_near(costs, position, end, state)
        first, last = min(one, two, three), max(one, two, three)
        middle = one + two + three - first - last
        if first < 1 or last > ends - 3 or first == middle or middle == last:
            continue
        a, b, c = tour[first], tour[first + 1], tour[middle]
        d, e, f = tour[middle + 1], tour[last], tour[last + 1]
        log.gain[0] = cost_of(costs, a, b) + cost_of(costs, c, d) + cost_of(costs, e, f)
        log.gain[0] -= cost_of(costs, a, d) + cost_of(costs, e, b) + cost_of(costs, c, f)
        log.span[0], log.span[1] = first + 1, last
        _exchange(tour, position, first + 1, middle + 1, last + 1)
        for n, concerned in enumerate((a, b, c, d, e, f)):
            queue[n] = concerned
            waiting[concerned] = True
        improve(costs, tour, position, queue, 6, waiting, log)
        low, high = log.span
        if log.gain[0] >= 0.0:
            best[low : high + 1] = tour[low : high + 1]
        else:
            for at in range(low, high + 1):
                tour[at] = best[at]
                position[tour[at]] = at
