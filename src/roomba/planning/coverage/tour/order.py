"""Stage order: the order and direction in which the pieces are driven."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask, Polyline
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.tour.costs import Costs, costs_of, note_pair
from roomba.planning.coverage.tour.guesses import guesses_measured
from roomba.planning.coverage.tour.near import (
    NearestSearch,
    Places,
    nearest_wanted,
    neighbours,
    places_over,
    search_over,
)
from roomba.planning.coverage.tour.net import Net
from roomba.planning.coverage.tour.tour import greedy_links, iterated_local_search

_NEAREST = 20
_NEAR = 300.0
"""cells; longer connections are not searched beforehand: they are made only if needed."""
_EVERYWHERE = 1e8
_MOST_SEARCHES = 6
"""Searches for an order, each with the true lengths of the ways that the last one had guessed."""


def ordered(
    net: Net, pieces: list[Polyline], start: Floats, end: Floats | None, config: CoverageConfig
) -> list[Polyline]:
    """Return the pieces in a good order from ``start`` to ``end``, float64 [2], turned as driven.

    Without an ``end`` the last piece may be anywhere.
    """
    if not pieces:
        return []
    last = start if end is None else end
    lines = [np.stack((start, start)), *pieces, np.stack((last, last))]
    places = np.concatenate([line[[0, -1]] for line in lines])
    search = search_over(net)
    spots = places_over(net, places)
    nearest, lengths = neighbours(net, search, spots, _NEAREST, _NEAR)
    headings = _headings(lines)
    costs = costs_of(nearest, lengths, places, headings, net.fits, config.turning, end is None)
    tour = _first_tour(net, search, spots, costs)
    for _ in range(_MOST_SEARCHES):
        tour = iterated_local_search(costs, tour, config.search_rounds, config.search_pays)
        if guesses_measured(net, costs, tour) == 0:
            break
    return [
        lines[entry // 2] if entry % 2 == 0 else lines[entry // 2][::-1]
        for entry in tour[2:-2:2].tolist()
    ]


def _headings(lines: list[Polyline]) -> NDArray[np.float64]:
    """Return where each end leads out of its piece, rad [ends]; not a number for a point."""
    outward = np.concatenate([line[[0, -1]] - line[[1, -2]] for line in lines])
    headings = np.arctan2(outward[:, 1], outward[:, 0])
    headings[~outward.any(axis=1)] = np.nan
    return headings


def _first_tour(net: Net, search: NearestSearch, places: Places, costs: Costs) -> NDArray[np.int32]:
    """Return a tour that makes the cheapest connections, and goes on to the nearest free end.

    The costs of the connections to free ends are stored in ``costs``.
    """
    links: NDArray[np.int32] = greedy_links(costs)
    found = np.empty(64, np.int32)
    lengths = np.empty(64, np.float64)
    last = len(places.at) - 1
    tail = _followed(links, last)
    free: Mask = links < 0
    free[[0, last]] = False
    free[tail[-1]] = False
    tour = _followed(links, 0)
    while True:
        at = int(tour[-1])
        free[at] = False
        if not free.any():
            break
        count = nearest_wanted(net, search, places, free, at, 1, _EVERYWHERE, found, lengths)
        if count:
            nearest = int(np.argmin(lengths[:count]))
            to, cost = int(found[nearest]), float(lengths[nearest])
        else:
            to, cost = int(np.flatnonzero(free)[0]), _EVERYWHERE
        note_pair(costs, at, to, cost)
        free[to] = False
        tour = np.concatenate((tour, _followed(links, to)))
    straight = np.hypot(*(places.at[tour[-1]] - places.at[tail[-1]]))
    note_pair(costs, int(tour[-1]), int(tail[-1]), float(straight))
    whole: NDArray[np.int32] = np.concatenate((tour, tail[::-1])).astype(np.int32)
    return whole


def _followed(links: NDArray[np.int32], end: int) -> NDArray[np.int32]:
    """Return the ends passed from a free end on along pieces and links, to another free end."""
    passed = [end, end ^ 1]
    while links[passed[-1]] >= 0:
        passed.append(int(links[passed[-1]]))
        passed.append(passed[-1] ^ 1)
    return np.array(passed, np.int32)
