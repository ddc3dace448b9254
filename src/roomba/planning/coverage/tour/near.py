"""Compiled search for the places nearest to a place, by the way that the middle has to go.

Places in cells of the window: (x, y) is (column, row).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Ints32
from roomba.compilation import allocating_entry, allocating_part, inner_part
from roomba.planning.coverage.floor.masks import way_fits
from roomba.planning.coverage.tour.net import STEP_X, STEP_Y, UNIT, Net, blocks_near, leg_to

_BUCKETS = 128
_NEVER = np.int32(1 << 30)
_SQUARE = 64.0
"""cells; places are looked for square by square, outwards."""
_TOUCHED, _QUEUED, _WAITING = 0, 1, 2
"""Counters of a search: blocks with a cost, entries queued so far, and entries still waiting."""
_TRIED = 3
"""So many times the wanted places are tried: those that are nearest in a straight line."""


class Places(NamedTuple):
    """Places over a net, float64 [n, 2] ``at``.

    The places near block b that see its knot are ``of_block[block_first[b]:block_first[b + 1]]``.
    """

    at: Floats
    block_first: Ints32
    of_block: Ints32


class NearestSearch(NamedTuple):
    """Work arrays of a search over a net, int32.

    ``costs`` are those of the net's blocks, and ``touched`` the blocks that have one. ``queued``
    has the queued blocks, ``next_of`` the index of the next one in the same bucket.
    """

    costs: Ints32
    touched: Ints32
    queued: Ints32
    next_of: Ints32
    first_of: Ints32
    last_of: Ints32
    counts: Ints32


@allocating_entry
def search_over(net: Net) -> NearestSearch:
    """Return work arrays for searches over a net."""
    size = net.links.size // 8
    most = net.links.size + 9  # each link, and the blocks that a search begins with
    return NearestSearch(
        np.full(size, _NEVER, np.int32),
        np.zeros(size, np.int32),
        np.zeros(most, np.int32),
        np.zeros(most, np.int32),
        np.full(_BUCKETS, -1, np.int32),
        np.zeros(_BUCKETS, np.int32),
        np.zeros(3, np.int32),
    )


@allocating_entry
def places_over(net: Net, places: Floats) -> Places:
    """Return places, float64 [n, 2], with lists of those near each block."""
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
    """Write the places nearest to place ``origin`` over the net, and the lengths of the ways.

    Only ``wanted`` places, bool [n], count. The search ends after ``enough`` of them or ``limit``
    cells. Returns how many were found; they are not sorted.
    """
    counts = search.counts
    counts[:] = 0
    x, y = places.at[origin]
    near = np.empty(9, np.int32)
    for n in range(blocks_near(net, x, y, near)):
        _put_in(search, near[n], int(leg_to(net, near[n], x, y) * UNIT))
    count = 0
    level = 0
    most = int(min(limit, 1e8) * UNIT)
    while counts[_WAITING] > 0 and level <= most and count < enough:
        item = search.first_of[level % _BUCKETS]
        while item >= 0:
            block = search.queued[item]
            counts[_WAITING] -= 1
            if search.costs[block] == level:
                for n in range(places.block_first[block], places.block_first[block + 1]):
                    place = places.of_block[n]
                    if wanted[place] and place != origin:
                        to_x, to_y = places.at[place]
                        length = level / UNIT + leg_to(net, block, to_x, to_y)
                        count = _note_place(place, length, found, lengths, count)
                _put_in_linked(net, search, block)
            item = search.next_of[item]
        search.first_of[level % _BUCKETS] = -1
        level += 1
    for n in range(counts[_TOUCHED]):
        search.costs[search.touched[n]] = _NEVER
    search.first_of[:] = -1
    return count


@inner_part
def _put_in_linked(net: Net, search: NearestSearch, block: int) -> None:
    """Queue the neighbours of a block that are reached cheaper over it."""
    columns = net.links.shape[1]
    links = net.links[block // columns, block % columns]
    for step in range(8):
        if links[step] != 0:
            other = block + STEP_Y[step] * columns + STEP_X[step]
            cost = search.costs[block] + links[step]
            if cost < search.costs[other]:
                _put_in(search, other, cost)


@inner_part
def _put_in(search: NearestSearch, block: int, cost: int) -> None:
    """Queue a block at its cost, behind those already queued at that cost."""
    counts = search.counts
    if search.costs[block] == _NEVER:
        search.touched[counts[_TOUCHED]] = block
        counts[_TOUCHED] += 1
    search.costs[block] = cost
    bucket = cost % _BUCKETS
    item = counts[_QUEUED]
    search.queued[item] = block
    search.next_of[item] = -1
    if search.first_of[bucket] < 0:
        search.first_of[bucket] = item
    else:
        search.next_of[search.last_of[bucket]] = item
    search.last_of[bucket] = item
    counts[_QUEUED] += 1
    counts[_WAITING] += 1


@inner_part
def _note_place(
    place: int, length: float, found: Ints32, lengths: NDArray[np.float64], count: int
) -> int:
    """Store a place that was found, or a shorter way to it; return how many are found."""
    for known in range(count):
        if found[known] == place:
            lengths[known] = min(lengths[known], length)
            return count
    if count == len(found):
        return count
    found[count], lengths[count] = place, length
    return count + 1


@allocating_part
def _twice_as_long(queue: Ints32) -> Ints32:
    """Return the rows of a queue with as much room again behind them."""
    longer = np.empty((queue.shape[0], 2 * queue.shape[1]), np.int32)
    # Copied cell by cell: the check for equal shapes of a copy at once takes long to compile.
    for row in range(queue.shape[0]):
        for at in range(queue.shape[1]):
            longer[row, at] = queue[row, at]
    return longer


@allocating_entry
def neighbours(
    net: Net, search: NearestSearch, places: Places, most: int, limit: float
) -> tuple[Ints32, NDArray[np.float64]]:
    """Return the nearest places of each, the nearest first, and the lengths of the ways to them.

    int32 and float64 [n, most]; -1 and infinite if there are fewer within ``limit`` cells. The way
    to a place in sight is straight; the net is searched only for others that may be nearer.
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
def _squares(at: Floats) -> tuple[int, Ints32, Ints32]:
    """Return the number of squares in a row, and lists of the places in each square."""
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
    at: Floats,
    columns: int,
    first: Ints32,
    inside: Ints32,
    origin: int,
    enough: int,
    limit: float,
    near: Ints32,
    away: NDArray[np.float64],
) -> tuple[int, float]:
    """Write the places nearest in a straight line, and their distances.

    Return how many were written, and the distance within which there are no others.
    """
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
    """Give both directions of a way the same length: searches from its two ends can differ."""
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
