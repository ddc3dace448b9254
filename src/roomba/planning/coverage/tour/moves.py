"""Compiled moves that make a tour over the ends of pieces cheaper.

The first piece keeps its place, and the last one too.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_part, entry, inner_part, part
from roomba.planning.coverage.tour.costs import Costs, Tour, cost_of, least_cost

_GAIN = 1e-6
_MOST_MOVES = 20
"""Moves for each end, at most; far more than are ever made."""


class TourState(NamedTuple):
    """A tour that is being changed, ``position`` int32 [ends] of each end in it, and work arrays.

    ``joined``, float64 [ends], is the cost of each end's connection. ``touched``, int32 [6], are
    the ends that the last move changed. ``gain`` float64 [1] and ``span`` int64 [2], the first and
    last position changed, add up over moves until they are set anew.
    """

    tour: Tour
    position: Tour
    joined: NDArray[np.float64]
    room: Tour
    touched: Tour
    gain: NDArray[np.float64]
    span: NDArray[np.int64]


@allocating_part
def state_along(costs: Costs, tour: Tour) -> TourState:
    """Return a state along a tour, which it changes; nothing has moved yet."""
    ends = tour.size
    state = TourState(
        tour,
        np.empty(ends, np.int32),
        np.zeros(ends),
        np.empty(ends, np.int32),
        np.empty(6, np.int32),
        np.zeros(1),
        np.array([ends, -1]),
    )
    for at in range(ends):
        state.position[tour[at]] = at
    for at in range(1, ends - 1, 2):
        join(costs, state, at)
    return state


@part
def place_of(state: TourState, end: int) -> int:
    """Return the position of an end in the type of sums, so that moves are compiled only once."""
    place: int = np.int64(state.position[end])  # type: ignore[assignment]
    return place


@part
def join(costs: Costs, state: TourState, at: int) -> None:
    """Store the cost of connecting the ends at a position and at the next one."""
    one, other = state.tour[at], state.tour[at + 1]
    cost = cost_of(costs, one, other)
    state.joined[one] = cost
    state.joined[other] = cost


@part
def _note(state: TourState, gain: float, first: int, last: int) -> None:
    state.gain[0] += gain
    state.span[0] = min(state.span[0], first)
    state.span[1] = max(state.span[1], last)


@inner_part
def _reverse(costs: Costs, state: TourState, first: int, last: int) -> None:
    """Drive the pieces from one position to another the other way round."""
    tour, position, before, after = state.tour, state.position, first - 1, last
    while first < last:
        one, other = tour[first], tour[last]
        tour[first], tour[last] = other, one
        position[other], position[one] = first, last
        first += 1
        last -= 1
    if first == last:
        position[tour[first]] = first
    join(costs, state, before)
    join(costs, state, after)


@inner_part
def _try_end(costs: Costs, state: TourState, end: int) -> int:
    """Make the first move that gains by a better connection of one end.

    Returns how many ends it changed, written to ``touched``; 0 if there is no such move.
    """
    tour, touched = state.tour, state.touched
    size = tour.size
    at = place_of(state, end)
    leaves = at % 2 == 1
    partner_at = at + 1 if leaves else at - 1
    if partner_at < 0 or partner_at >= size:
        return 0
    partner = tour[partner_at]
    now = state.joined[end]
    for k in range(costs.nearest.shape[1]):
        other = costs.nearest[end, k]
        if other < 0:
            break
        gain = now - costs.costs[end, k]
        if gain <= _GAIN:
            break
        other_at = place_of(state, other)
        other_leaves = other_at % 2 == 1
        other_partner_at = other_at + 1 if other_leaves else other_at - 1
        if other == partner or other_partner_at < 0 or other_partner_at >= size:
            continue
        other_partner = tour[other_partner_at]
        gain += state.joined[other]
        if leaves == other_leaves:
            won = gain - least_cost(costs, partner, other_partner)
            if won > _GAIN:
                won = gain - cost_of(costs, partner, other_partner)
            if won > _GAIN:
                first = min(max(at, partner_at), max(other_at, other_partner_at))
                last = max(min(at, partner_at), min(other_at, other_partner_at))
                _reverse(costs, state, first, last)
                _note(state, won, first, last)
                touched[0], touched[1] = end, other
                touched[2], touched[3] = partner, other_partner
                return 4
        else:
            moved = _swap_runs(costs, state, at, other_at, gain)
            if moved > 0:
                return moved
        moved = _move_run(costs, state, end, other)
        if moved > 0:
            return moved
    return 0


@inner_part
def _swap_runs(costs: Costs, state: TourState, at: int, other_at: int, gain: float) -> int:
    """Let two neighbouring runs of pieces change places, without turning either.

    The connection of the ends at ``at`` and ``other_at`` is new and brings ``gain``. The third
    connection to break is searched here.
    """
    tour, touched = state.tour, state.touched
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
            e_at = place_of(state, e)
            if e_at % 2 == 0 or e_at < entry_at or e_at + 1 >= size:
                continue
            f = tour[e_at + 1]
            won = gain - costs.costs[b, k] + state.joined[e]
            if won - least_cost(costs, c, f) <= _GAIN:
                continue
            won -= cost_of(costs, c, f)
            if won > _GAIN:
                exchange(costs, state, leaver_at + 1, entry_at, e_at + 1)
                _note(state, won, leaver_at + 1, e_at)
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
            d_at = place_of(state, d)
            if d_at % 2 == 1 or d_at <= entry_at or d_at > leaver_at:
                continue
            c = tour[d_at - 1]
            won = gain - costs.costs[a, k] + state.joined[c]
            if won - least_cost(costs, c, f) <= _GAIN:
                continue
            won -= cost_of(costs, c, f)
            if won > _GAIN:
                exchange(costs, state, entry_at, d_at, leaver_at + 1)
                _note(state, won, entry_at, leaver_at)
                touched[0], touched[1], touched[2] = a, b, c
                touched[3], touched[4], touched[5] = d, e, f
                return 6
    return 0


@part
def exchange(costs: Costs, state: TourState, first: int, middle: int, stop: int) -> None:
    """Swap the runs at [first, middle) and [middle, stop), between other pieces."""
    tour, room = state.tour, state.room
    size = middle - first
    for n in range(size):
        room[n] = tour[first + n]
    for at in range(middle, stop):
        tour[at - size] = tour[at]
    for n in range(size):
        tour[stop - size + n] = room[n]
    for at in range(first, stop):
        state.position[tour[at]] = at
    join(costs, state, first - 1)
    join(costs, state, stop - size - 1)
    join(costs, state, stop - 1)


@inner_part
def _move_run(costs: Costs, state: TourState, end: int, other: int) -> int:
    """Move a run of one to three pieces that begins with ``end`` to the side of ``other``."""
    tour, touched = state.tour, state.touched
    size = tour.size
    at = place_of(state, end)
    leaves = at % 2 == 1
    other_at = place_of(state, other)
    partner_at = other_at + 1 if other_at % 2 == 1 else other_at - 1
    if partner_at < 0 or partner_at >= size:
        return 0
    partner = tour[partner_at]
    of_place = state.joined[other] - cost_of(costs, end, other)
    for pieces in range(1, 4):
        # The run reaches away from the connection of ``end`` that is to be broken.
        first, last = (at - 2 * pieces + 1, at) if leaves else (at, at + 2 * pieces - 1)
        if first < 2 or last > size - 3:
            return 0
        if first <= other_at <= last:
            return 0
        if first <= partner_at <= last:
            continue
        before, after = tour[first - 1], tour[last + 1]
        far = tour[first] if leaves else tour[last]
        won = state.joined[before] + state.joined[after] + of_place
        if won <= 0.0:
            continue
        least = least_cost(costs, far, partner)
        if won - least <= 0.0 or won - least - least_cost(costs, before, after) <= _GAIN:
            continue
        won -= cost_of(costs, before, after) + cost_of(costs, far, partner)
        if won > _GAIN:
            gap = max(other_at, partner_at)
            _note(state, won, min(first, gap), max(last, gap - 1))
            if gap > last:
                exchange(costs, state, first, last + 1, gap)
                first, last = gap - 2 * pieces, gap - 1
            else:
                exchange(costs, state, gap, first, last + 1)
                first, last = gap, gap + 2 * pieces - 1
            entered = tour[first - 1]
            if (entered == other) != (tour[first] == end):
                _reverse(costs, state, first, last)
            touched[0], touched[1], touched[2] = end, other, far
            touched[3], touched[4], touched[5] = partner, before, after
            return 6
    return 0


@entry
def improve(
    costs: Costs, state: TourState, queue: Tour, count: int, waiting: NDArray[np.bool_]
) -> None:
    """Make moves until none helps, looking again at the ends that a move concerned.

    The first ``count`` of ``queue``, int32 [ends], are looked at first; ``waiting``, bool [ends],
    is true for them, and all false afterwards.
    """
    head = 0
    moves = 0
    while count > 0:
        end = queue[head]
        head = head + 1 if head + 1 < queue.size else 0
        count -= 1
        waiting[end] = False
        while moves < _MOST_MOVES * queue.size:
            concerned = _try_end(costs, state, end)
            if concerned == 0:
                break
            moves += 1
            for n in range(concerned):
                other = state.touched[n]
                if not waiting[other] and other != end:
                    waiting[other] = True
                    queue[(head + count) % queue.size] = other
                    count += 1
