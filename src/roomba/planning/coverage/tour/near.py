"""Compiled search for the places nearest to a place, by the way that the middle has to go.

Places in cells of the window: (x, y) is (column, row).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Ints32
from roomba.compilation import allocating_entry, allocating_part, inner_part
from roomba.planning.coverage.floor.masks import way_fits
from roomba.planning.coverage.tour.net import STEP_X, STEP_Y, UNIT, Net, blocks_near, leg_to

Line = NDArray[np.float64]

_BUCKETS = 128
_NEVER = np.int32(1 << 30)
_SQUARE = 64.0
"""cells; places are looked for square by square, outwards."""
_TRIED = 3
"""Times as many places as are wanted are tried, the nearest as the crow flies."""


class Places(NamedTuple):
    """Places over a net, float64 [n, 2] ``at``.

    Those near block b, whose knot they see, are ``of_block[block_first[b]:block_first[b + 1]]``.
    """

    at: Line
    block_first: Ints32
    of_block: Ints32


class NearestSearch(NamedTuple):
    """Work arrays of a search over a net, int32 over its blocks, and the queue's bucket heads."""

    costs: Ints32
    queue: Ints32
    touched: Ints32


@allocating_entry
def search_over(net: Net) -> NearestSearch:
    """Return work arrays for searches over a net."""
    size = net.links.size // 8
    return NearestSearch(
        np.full(size, _NEVER, np.int32),
        np.zeros((_BUCKETS, 256), np.int32),
        np.zeros(size, np.int32),
    )


@allocating_entry
def places_over(net: Net, places: Line) -> Places:
    """Return places, float64 [n, 2], with which of them are near each block."""
    near = np.empty((len(places), 9), np.int32)
    sizes = np.empty(len(places), np.int64)
    first_of = np.zeros(net.links.size // 8 + 1, np.int32)
    for place in range(len(places)):
        sizes[place] = blocks_near(net, places[place, 0], places[place, 1], near[place])
        for n in range(sizes[place]):
            first_of[near[place, n] + 1] += 1
    for block in range(net.links.size // 8):
        first_of[block + 1] += first_of[block]
    place_at = np.empty(first_of[-1], np.int32)
    filled = first_of.copy()
    for place in range(len(places)):
        for n in range(sizes[place]):
            place_at[filled[near[place, n]]] = place
            filled[near[place, n]] += 1
    return Places(places, first_of, place_at)


@allocating_entry
def nearest_wanted(
    net: Net,
    search: NearestSearch,
    places: Places,
    wanted: NDArray[np.bool_],
    origin: int,
    enough: int,
    limit: float,
    found: Ints32,
    lengths: NDArray[np.float64],
) -> int:
    """Write the places nearest to one of them over the net, and the lengths of the ways.

    Only those ``wanted``, bool [n], count. The search ends after ``enough`` of them or ``limit``
    cells. Returns how many; they are not sorted.
    """
    columns = net.links.shape[1]
    x, y = places.at[origin]
    queue = search.queue
    heads = np.zeros(_BUCKETS, np.int64)
    touched = 0
    waiting = 0
    near = np.empty(9, np.int32)
    for n in range(blocks_near(net, x, y, near)):
        block = near[n]
        cost = int(leg_to(net, block, x, y) * UNIT)
        search.costs[block] = cost
        search.touched[touched] = block
        touched += 1
        bucket = cost % _BUCKETS
        queue[bucket, heads[bucket]] = block
        heads[bucket] += 1
        waiting += 1
    count = 0
    level = 0
    most = int(min(limit, 1e8) * UNIT)
    while waiting > 0 and level <= most and count < enough:
        bucket = level % _BUCKETS
        at = 0
        while at < heads[bucket]:
            block = queue[bucket, at]
            at += 1
            waiting -= 1
            if search.costs[block] != level:
                continue
            for n in range(places.block_first[block], places.block_first[block + 1]):
                place = places.of_block[n]
                if not wanted[place] or place == origin:
                    continue
                to_x, to_y = places.at[place]
                length = level / UNIT + leg_to(net, block, to_x, to_y)
                known = 0
                while known < count and found[known] != place:
                    known += 1
                if known < count:
                    lengths[known] = min(lengths[known], length)
                elif count < len(found):
                    found[count], lengths[count] = place, length
                    count += 1
            links = net.links[block // columns, block % columns]
            for step in range(8):
                if links[step] == 0:
                    continue
                other = block + STEP_Y[step] * columns + STEP_X[step]
                cost = level + links[step]
                if cost >= search.costs[other]:
                    continue
                if search.costs[other] == _NEVER:
                    search.touched[touched] = other
                    touched += 1
                search.costs[other] = cost
                to_bucket = cost % _BUCKETS
                if heads[to_bucket] == queue.shape[1]:
                    queue = _twice_as_long(queue)
                queue[to_bucket, heads[to_bucket]] = other
                heads[to_bucket] += 1
                waiting += 1
        heads[bucket] = 0
        level += 1
    for n in range(touched):
        search.costs[search.touched[n]] = _NEVER
    return count


@allocating_part
def _twice_as_long(queue: Ints32) -> Ints32:
    """Return the rows of a queue with as much room again behind them."""
    longer = np.empty((queue.shape[0], 2 * queue.shape[1]), np.int32)
    # Cell by cell: an array set at once may not fit, and to say so takes longest to compile.
    for row in range(queue.shape[0]):
        for at in range(queue.shape[1]):
            longer[row, at] = queue[row, at]
    return longer


@allocating_entry
def neighbours(
    net: Net, search: NearestSearch, places: Places, most: int, limit: float
) -> tuple[Ints32, NDArray[np.float64]]:
    """Return the nearest places of each, the nearest first, and the lengths of the ways to them.

    int32 and float64 [n, most]; -1 and infinite where there are fewer within ``limit`` cells. Those
    in sight are as far as they look; only for others that may be nearer the net is searched.
    """
    count = len(places.at)
    columns, square_first, of_square = _squares(places.at)
    nearest = np.full((count, most), -1, np.int32)
    lengths = np.full((count, most), np.inf)
    near = np.empty(count, np.int32)
    away = np.empty(count, np.float64)
    hidden = np.zeros(count, np.bool_)
    found = np.empty(4 * most, np.int32)
    ways = np.empty(4 * most, np.float64)
    for place in range(count):
        x, y = places.at[place]
        tried, within = _as_the_crow_flies(
            places.at, columns, square_first, of_square, place, _TRIED * most, limit, near, away
        )
        order = np.argsort(away[:tried], kind="mergesort")
        size, behind = 0, 0
        for n in range(tried):
            other = near[order[n]]
            if away[order[n]] > within or size == most:
                break
            if way_fits(net.fits, x, y, places.at[other, 0], places.at[other, 1]):
                found[size], ways[size] = other, away[order[n]]
                size += 1
            else:
                hidden[other] = True
                behind += 1
        if behind > 0:
            reach = ways[size - 1] if size == most else within
            size += nearest_wanted(
                net,
                search,
                places,
                hidden,
                place,
                min(behind, most),
                reach,
                found[size:],
                ways[size:],
            )
        hidden[near[:tried]] = False
        order = np.argsort(ways[:size], kind="mergesort")
        for n in range(min(size, most)):
            nearest[place, n] = found[order[n]]
            lengths[place, n] = ways[order[n]]
    _make_symmetric(nearest, lengths)
    return nearest, lengths


@allocating_part
def _squares(at: Line) -> tuple[int, Ints32, Ints32]:
    """Return how many squares there are in a row, and which places lie in each, as of blocks."""
    columns, rows = 1, 1
    for place in range(len(at)):
        columns = max(columns, int(at[place, 0] / _SQUARE) + 1)
        rows = max(rows, int(at[place, 1] / _SQUARE) + 1)
    first = np.zeros(rows * columns + 1, np.int32)
    square = np.empty(len(at), np.int64)
    for place in range(len(at)):
        square[place] = int(at[place, 1] / _SQUARE) * columns + int(at[place, 0] / _SQUARE)
        first[square[place] + 1] += 1
    for n in range(rows * columns):
        first[n + 1] += first[n]
    inside = np.empty(len(at), np.int32)
    filled = first.copy()
    for place in range(len(at)):
        inside[filled[square[place]]] = place
        filled[square[place]] += 1
    return columns, first, inside


@inner_part
def _as_the_crow_flies(
    at: Line,
    columns: int,
    first: Ints32,
    inside: Ints32,
    origin: int,
    enough: int,
    limit: float,
    near: Ints32,
    away: NDArray[np.float64],
) -> tuple[int, float]:
    """Write other places and how far they are; return how many, and how far there are no others."""
    x, y = at[origin]
    row, column = int(y / _SQUARE), int(x / _SQUARE)
    rows = (len(first) - 1) // columns
    count, ring, within = 0, 0, 0.0
    while True:
        for to_row in range(max(row - ring, 0), min(row + ring, rows - 1) + 1):
            is_end = abs(to_row - row) == ring
            step = 1 if is_end else max(2 * ring, 1)
            for to_column in range(column - ring, column + ring + 1, step):
                if not 0 <= to_column < columns:
                    continue
                square = to_row * columns + to_column
                for n in range(first[square], first[square + 1]):
                    if inside[n] != origin:
                        near[count] = inside[n]
                        away[count] = math.hypot(at[inside[n], 0] - x, at[inside[n], 1] - y)
                        count += 1
        within = min(
            x - (column - ring) * _SQUARE,
            (column + ring + 1) * _SQUARE - x,
            y - (row - ring) * _SQUARE,
            (row + ring + 1) * _SQUARE - y,
        )
        if within >= limit:
            return count, limit
        ring += 1
        if count >= enough:
            known = 0
            for n in range(count):
                known += away[n] <= within
            if known >= enough:
                return count, within


@inner_part
def _make_symmetric(nearest: Ints32, lengths: NDArray[np.float64]) -> None:
    """Give ways there and back the same length; searches both ways can differ by their steps."""
    for place in range(len(nearest)):
        for n in range(nearest.shape[1]):
            other = nearest[place, n]
            if other <= place:
                continue
            for k in range(nearest.shape[1]):
                if nearest[other, k] == place:
                    shorter = min(lengths[place, n], lengths[other, k])
                    lengths[place, n] = shorter
                    lengths[other, k] = shorter
                    break
