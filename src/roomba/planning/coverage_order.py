"""Stage order: in which order, and which way round, the pieces are driven."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.mask_kernels import Mask
from roomba.planning.coverage_order_kernels import (
    Costs,
    greedy_links,
    note_nearest,
    note_pair,
    shake,
)
from roomba.planning.coverage_ways import (
    Net,
    Search,
    nearest_places,
    neighbours,
    places_by_block,
    search_over,
)

Line = NDArray[np.float64]

_NEAREST = 32
_NEAR = 300.0
"""cells; connections longer than this are only made where there is no other."""
_EVERYWHERE = 1e8


@dataclass(frozen=True)
class Weights:
    """What the order is to keep low: ``turning`` is the way, in cells, that a radian is worth."""

    turning: float = 6.0
    rounds: int = 10000


def ordered(
    net: Net, pieces: list[Line], start: Line, end: Line | None, weights: Weights
) -> list[Line]:
    """Return the pieces in a good order from ``start`` to ``end``, float64 [2], turned as driven.

    Without an ``end`` the last piece may be anywhere.
    """
    if not pieces:
        return []
    last = start if end is None else end
    lines = [np.stack((start, start)), *pieces, np.stack((last, last))]
    places = np.concatenate([line[[0, -1]] for line in lines])
    search = search_over(net)
    nearest, lengths = neighbours(net, search, places, _NEAREST, _NEAR)
    costs = lengths + weights.turning * _turns(lines, places, nearest)
    order = np.argsort(costs, axis=1, kind="stable")
    nearest = np.take_along_axis(nearest, order, axis=1)
    costs = np.take_along_axis(costs, order, axis=1)
    if end is None:
        nearest[np.isin(nearest, (len(places) - 2, len(places) - 1))] = -1
        nearest[-2:] = -1
        costs[nearest < 0] = np.inf
        order = np.argsort(costs, axis=1, kind="stable")
        nearest = np.take_along_axis(nearest, order, axis=1)
        costs = np.take_along_axis(costs, order, axis=1)
    size = 1 << int(np.ceil(np.log2(3 * nearest.size + 8)))
    table = Costs(nearest, costs, np.full(size, -1), np.zeros(size), end is None)
    note_nearest(table)
    tour = _first_tour(net, search, places, table)
    shake(table, tour, weights.rounds)
    return [
        lines[entry // 2] if entry % 2 == 0 else lines[entry // 2][::-1]
        for entry in tour[2:-2:2].tolist()
    ]


def _turns(lines: list[Line], places: Line, nearest: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return the turns, rad, on the straight ways from each end to its nearest; [ends, k]."""
    outward = np.zeros_like(places)
    for index, line in enumerate(lines):
        outward[2 * index] = line[0] - line[1]
        outward[2 * index + 1] = line[-1] - line[-2]
    still = ~outward.any(axis=1)
    headings = np.arctan2(outward[:, 1], outward[:, 0])
    ways = places[nearest] - places[:, None]
    along = np.arctan2(ways[..., 1], ways[..., 0])
    at_once = np.hypot(ways[..., 0], ways[..., 1]) < 1e-6
    along = np.where(at_once, headings[:, None], along)
    leaving = np.abs((along - headings[:, None] + np.pi) % (2 * np.pi) - np.pi)
    entering = np.abs((headings[nearest] + np.pi - along + np.pi) % (2 * np.pi) - np.pi)
    leaving[still] = 0.0
    entering[still[nearest] | (at_once & still[:, None])] = 0.0
    turns: NDArray[np.float64] = leaving + entering
    return turns


def _first_tour(net: Net, search: Search, places: Line, costs: Costs) -> NDArray[np.int32]:
    """Return a tour that makes the cheapest connections, and goes on to the nearest free end.

    What the latter cost is noted in ``costs``.
    """
    links: NDArray[np.int32] = greedy_links(costs)
    first_of, place_at = places_by_block(net, places)
    found = np.empty(64, np.int32)
    lengths = np.empty(64, np.float64)
    last = len(places) - 1
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
        count = nearest_places(
            net, search, places, first_of, place_at, free, at, 1, _EVERYWHERE, found, lengths
        )
        if count:
            nearest = int(np.argmin(lengths[:count]))
            to, cost = int(found[nearest]), float(lengths[nearest])
        else:
            to, cost = int(np.flatnonzero(free)[0]), _EVERYWHERE
        note_pair(costs, at, to, cost)
        free[to] = False
        tour = np.concatenate((tour, _followed(links, to)))
    straight = np.hypot(*(places[tour[-1]] - places[tail[-1]]))
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
