"""Compiled search for a good tour over the ends of pieces: a first one, improved move by move."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, part
from roomba.planning.coverage.tour.costs import Costs, Tour, tour_cost
from roomba.planning.coverage.tour.moves import Trip, exchange, improve, trip_along

_MOST_ROUNDS = 100000
_NEAR_SHARE = 30
"""Of a hundred rounds, those that exchange runs between connections that are near each other."""
_LONGEST = 25
"""pieces; the longest run that the others exchange."""


@allocating_entry
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


@part
def _drawn(state: NDArray[np.uint64], below: int) -> int:
    """Return the next number of a fixed sequence (xorshift), 0 to ``below`` - 1."""
    state[0] ^= state[0] << np.uint64(13)
    state[0] ^= state[0] >> np.uint64(7)
    state[0] ^= state[0] << np.uint64(17)
    drawn: int = np.int64((state[0] >> np.uint64(11)) % np.uint64(below))  # type: ignore[assignment]
    return drawn


@part
def _connection_near(costs: Costs, trip: Trip, end: int, state: NDArray[np.uint64]) -> int:
    """Return the position before a connection some steps from an end, from near end to near end."""
    for _ in range(1 + _drawn(state, 3)):
        known = 0
        while known < costs.nearest.shape[1] and costs.nearest[end, known] >= 0:
            known += 1
        if known == 0:
            break
        end = costs.nearest[end, _drawn(state, known)]
    at: int = trip.position[end]
    return at if at % 2 == 1 else at - 1


@allocating_entry
def shaken(costs: Costs, first_tour: Tour, period: int, pays: float) -> Tour:
    """Return a tour improved, then again and again from where runs were exchanged, while that pays.

    It goes on while ``period`` exchanges gain the share ``pays`` of the cost. They are drawn from a
    fixed sequence, so the outcome is always the same.
    """
    ends = first_tour.size
    tour = first_tour.copy()
    trip = trip_along(costs, tour)
    position, joined = trip.position, trip.joined
    queue = tour.copy()
    waiting = np.ones(ends, np.bool_)
    improve(costs, trip, queue, ends, waiting)
    if ends < 12:
        return tour
    best, best_joined = tour.copy(), joined.copy()
    state = np.array([88172645463325252], np.uint64)
    cost = tour_cost(costs, tour)
    gained = 0.0
    for round in range(_MOST_ROUNDS):
        if round % period == period - 1:
            if gained < pays * cost:
                break
            cost -= gained
            gained = 0.0
        if _drawn(state, 100) < _NEAR_SHARE:
            end = _drawn(state, ends)
            one = _connection_near(costs, trip, end, state)
            two = _connection_near(costs, trip, end, state)
            three = _connection_near(costs, trip, end, state)
            first, last = min(one, two, three), max(one, two, three)
            middle = one + two + three - first - last
        else:
            first = 1 + 2 * _drawn(state, ends // 2 - 1)
            middle = first + 2 * (1 + _drawn(state, _LONGEST))
            last = middle + 2 * (1 + _drawn(state, _LONGEST))
        if first < 1 or last > ends - 3 or first == middle or middle == last:
            continue
        a, b, c = tour[first], tour[first + 1], tour[middle]
        d, e, f = tour[middle + 1], tour[last], tour[last + 1]
        trip.gain[0] = joined[a] + joined[c] + joined[e]
        exchange(costs, trip, first + 1, middle + 1, last + 1)
        trip.gain[0] -= joined[a] + joined[e] + joined[c]
        trip.span[0], trip.span[1] = first + 1, last
        for count, concerned in enumerate((a, b, c, d, e, f)):
            queue[count] = concerned
            waiting[concerned] = True
        # No number that stands here: it would be compiled once more for that alone.
        improve(costs, trip, queue, trip.touched.size, waiting)
        low, high = trip.span
        if trip.gain[0] >= 0.0:
            for at in range(low - 1, high + 2):
                best[at] = tour[at]
                best_joined[tour[at]] = joined[tour[at]]
            gained += trip.gain[0]
        else:
            for at in range(low - 1, high + 2):
                tour[at] = best[at]
                position[tour[at]] = at
                joined[tour[at]] = best_joined[tour[at]]
    return tour
