"""Compiled search for a good tour over the ends of pieces: a first one, improved move by move."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, allocating_part, inner_part, part
from roomba.planning.coverage.tour.costs import Costs, Tour, tour_cost
from roomba.planning.coverage.tour.moves import TourState, exchange, improve, state_along

_MOST_ROUNDS = 100000
_NEAR_SHARE = 30
"""Rounds in a hundred that exchange runs between connections near each other."""
_LONGEST = 25
"""pieces; the longest run that the other rounds exchange."""


class BestTour(NamedTuple):
    """The best tour so far, int32 [ends], and what the connection of each end costs there."""

    tour: Tour
    joined: NDArray[np.float64]


@allocating_entry
def greedy_links(costs: Costs) -> NDArray[np.int32]:
    """Return the end that each end is connected to, or -1, int32 [ends].

    The cheapest connections are made first, without circles. The outer ends of the first and the
    last piece stay free.
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


@part
def _drawn(generator: NDArray[np.uint64], below: int) -> int:
    """Return the next number of a fixed sequence (xorshift), 0 to ``below`` - 1."""
    generator[0] ^= generator[0] << np.uint64(13)
    generator[0] ^= generator[0] >> np.uint64(7)
    generator[0] ^= generator[0] << np.uint64(17)
    drawn: int = np.int64((generator[0] >> np.uint64(11)) % np.uint64(below))  # type: ignore[assignment]
    return drawn


@part
def _connection_near(
    costs: Costs, state: TourState, end: int, generator: NDArray[np.uint64]
) -> int:
    """Return the position before a connection that is some random steps between near ends away."""
    for _ in range(1 + _drawn(generator, 3)):
        known = 0
        while known < costs.nearest.shape[1] and costs.nearest[end, known] >= 0:
            known += 1
        if known == 0:
            break
        end = costs.nearest[end, _drawn(generator, known)]
    at: int = state.position[end]
    return at if at % 2 == 1 else at - 1


@allocating_entry
def iterated_local_search(costs: Costs, first_tour: Tour, period: int, pays: float) -> Tour:
    """Return a tour improved by iterated local search, which exchanges runs while that pays.

    It goes on while ``period`` exchanges gain the share ``pays`` of the cost. Exchanges are drawn
    from a fixed sequence, so that the result is always the same.
    """
    ends = first_tour.size
    tour = first_tour.copy()
    state = state_along(costs, tour)
    queue = tour.copy()
    waiting = np.ones(ends, np.bool_)
    improve(costs, state, queue, ends, waiting)
    if ends >= 12:
        best = BestTour(tour.copy(), state.joined.copy())
        generator = np.array([88172645463325252], np.uint64)
        _search_on(costs, state, best, queue, waiting, generator, period, pays)
    return tour


@allocating_part
def _search_on(
    costs: Costs,
    state: TourState,
    best: BestTour,
    queue: Tour,
    waiting: NDArray[np.bool_],
    generator: NDArray[np.uint64],
    period: int,
    pays: float,
) -> None:
    """Exchange runs and improve the tour from there, and keep what is no worse, while that pays."""
    cost = tour_cost(costs, state.tour)
    gained = 0.0
    for round in range(_MOST_ROUNDS):
        if round % period == period - 1:
            if gained < pays * cost:
                break
            cost -= gained
            gained = 0.0
        first, middle, last = _drawn_runs(costs, state, generator)
        if first < 1 or last > state.tour.size - 3 or first == middle or middle == last:
            continue
        concerned = _exchange_drawn(costs, state, queue, waiting, first, middle, last)
        improve(costs, state, queue, concerned, waiting)
        if state.gain[0] >= 0.0:
            _keep(state, best)
            gained += state.gain[0]
        else:
            _take_back(state, best)


@inner_part
def _drawn_runs(
    costs: Costs, state: TourState, generator: NDArray[np.uint64]
) -> tuple[int, int, int]:
    """Return the positions before three connections, between which two runs are to be exchanged."""
    ends = state.tour.size
    if _drawn(generator, 100) < _NEAR_SHARE:
        end = _drawn(generator, ends)
        first, total, last = ends, 0, -1
        for _ in range(3):
            at = _connection_near(costs, state, end, generator)
            first, total, last = min(first, at), total + at, max(last, at)
        return first, total - first - last, last
    longest = min(_LONGEST, ends // 2 - 3)
    first = 1 + 2 * _drawn(generator, ends // 2 - 1)
    middle = first + 2 * (1 + _drawn(generator, longest))
    return first, middle, middle + 2 * (1 + _drawn(generator, longest))


@inner_part
def _exchange_drawn(
    costs: Costs,
    state: TourState,
    queue: Tour,
    waiting: NDArray[np.bool_],
    first: int,
    middle: int,
    last: int,
) -> int:
    """Exchange two runs, and queue the ends at the changed connections; return their number."""
    tour, joined = state.tour, state.joined
    queue[0], queue[1], queue[2] = tour[first], tour[first + 1], tour[middle]
    queue[3], queue[4], queue[5] = tour[middle + 1], tour[last], tour[last + 1]
    state.gain[0] = joined[queue[0]] + joined[queue[2]] + joined[queue[4]]
    exchange(costs, state, first + 1, middle + 1, last + 1)
    state.gain[0] -= joined[queue[0]] + joined[queue[4]] + joined[queue[2]]
    state.span[0], state.span[1] = first + 1, last
    for n in range(state.touched.size):
        waiting[queue[n]] = True
    return state.touched.size


@inner_part
def _keep(state: TourState, best: BestTour) -> None:
    """Keep the tour as the best one, where it was changed."""
    for at in range(state.span[0] - 1, state.span[1] + 2):
        end = state.tour[at]
        best.tour[at] = end
        best.joined[end] = state.joined[end]


@inner_part
def _take_back(state: TourState, best: BestTour) -> None:
    """Make the tour the best one again, where it was changed."""
    for at in range(state.span[0] - 1, state.span[1] + 2):
        end = best.tour[at]
        state.tour[at] = end
        state.position[end] = at
        state.joined[end] = best.joined[end]
