"""Compiled shortest ways for the middle, from place to place and to the nearest of many.

The search runs on a coarse net of cells that fit, one for each block of fine cells; ways found on
it are then pulled straight. Places in cells of the window: (x, y) is (column, row).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.mask_kernels import Mask
from roomba.planning.coverage_masks import way_fits
from roomba.planning.heap_kernels import heap_pop, heap_push

Line = NDArray[np.float64]

_BLOCK = 8
_STEP_X = (1, 1, 0, -1, -1, -1, 0, 1)
_STEP_Y = (0, 1, 1, 1, 0, -1, -1, -1)
_BUCKETS = 128
_UNIT = 2.0
"""Steps of the queue for a cell of way."""
_NEVER = np.int32(1 << 30)


class Net(NamedTuple):
    """Knots, one for each block of fine cells, and which of their eight neighbours each links to.

    ``knots`` int32 [rows, columns, 2] (x, y), x = -1 where nothing fits; ``links`` int16 [rows,
    columns, 8], the length of each in steps of the queue, 0 for none.
    """

    fits: Mask
    knots: NDArray[np.int32]
    links: NDArray[np.int16]


def net_over(fits: Mask) -> Net:
    """Return the net over the cells that fit, bool [rows, columns]."""
    shape = (-(-fits.shape[0] // _BLOCK), -(-fits.shape[1] // _BLOCK))
    net = Net(fits, np.full((*shape, 2), -1, np.int32), np.zeros((*shape, 8), np.int16))
    _knot(net)
    return net


@njit(cache=True, nogil=True)
def _knot(net: Net) -> None:
    rows, columns = net.links.shape[:2]
    height, width = net.fits.shape
    middle = _BLOCK // 2
    for row in range(rows):
        for column in range(columns):
            nearest = 1 << 30
            for y in range(row * _BLOCK, min((row + 1) * _BLOCK, height)):
                for x in range(column * _BLOCK, min((column + 1) * _BLOCK, width)):
                    away = (y - row * _BLOCK - middle) ** 2 + (x - column * _BLOCK - middle) ** 2
                    if net.fits[y, x] and away < nearest:
                        nearest = away
                        net.knots[row, column, 0] = x
                        net.knots[row, column, 1] = y
    for row in range(rows):
        for column in range(columns):
            x, y = net.knots[row, column]
            if x < 0:
                continue
            for step in range(4):
                to_row, to_column = row + _STEP_Y[step], column + _STEP_X[step]
                if not (0 <= to_row < rows and 0 <= to_column < columns):
                    continue
                to_x, to_y = net.knots[to_row, to_column]
                if to_x >= 0 and way_fits(net.fits, x, y, to_x, to_y):
                    steps = max(1, int(math.hypot(to_x - x, to_y - y) * _UNIT + 0.5))
                    net.links[row, column, step] = steps
                    net.links[to_row, to_column, step + 4] = steps


class Search(NamedTuple):
    """Work arrays of a search over a net, int32 over its blocks, and the queue's bucket heads."""

    costs: NDArray[np.int32]
    before: NDArray[np.int32]
    queue: NDArray[np.int32]
    touched: NDArray[np.int32]


def search_over(net: Net) -> Search:
    """Return work arrays for searches over a net."""
    size = net.links.size // 8
    return Search(
        np.full(size, _NEVER, np.int32),
        np.full(size, -1, np.int32),
        np.zeros((_BUCKETS, 64), np.int32),
        np.zeros(size, np.int32),
    )


@njit(cache=True, nogil=True)
def blocks_near(net: Net, x: float, y: float, found: NDArray[np.int32]) -> int:
    """Write the blocks around a place whose knots it sees, at most 9, and return how many."""
    rows, columns = net.links.shape[:2]
    row, column = int(y + 0.5) // _BLOCK, int(x + 0.5) // _BLOCK
    size = 0
    for at_row in range(max(row - 1, 0), min(row + 2, rows)):
        for at_column in range(max(column - 1, 0), min(column + 2, columns)):
            to_x, to_y = net.knots[at_row, at_column]
            if to_x >= 0 and way_fits(net.fits, x, y, to_x, to_y):
                found[size] = at_row * columns + at_column
                size += 1
    return size


@njit(cache=True, nogil=True)
def _leg(net: Net, block: int, x: float, y: float) -> float:
    columns = net.links.shape[1]
    knot = net.knots[block // columns, block % columns]
    return math.hypot(knot[0] - x, knot[1] - y)


@njit(cache=True, nogil=True)
def nearest_places(
    net: Net,
    search: Search,
    places: Line,
    first_of: NDArray[np.int32],
    place_at: NDArray[np.int32],
    wanted: NDArray[np.bool_],
    origin: int,
    enough: int,
    limit: float,
    found: NDArray[np.int32],
    lengths: NDArray[np.float64],
) -> int:
    """Write the places nearest to one of them, of those ``wanted``, and the lengths of the ways.

    The places near block b are ``place_at[first_of[b]:first_of[b + 1]]``. The search ends after
    ``enough`` of them or ``limit`` cells. Returns how many; they are not sorted. The knots that
    the search came by stay in ``search`` until :func:`forget`; here it is cleaned at once.
    """
    columns = net.links.shape[1]
    x, y = places[origin]
    queue = search.queue
    heads = np.zeros(_BUCKETS, np.int64)
    touched = 0
    waiting = 0
    near = np.empty(9, np.int32)
    for n in range(blocks_near(net, x, y, near)):
        block = near[n]
        cost = int(_leg(net, block, x, y) * _UNIT)
        search.costs[block] = cost
        search.touched[touched] = block
        touched += 1
        bucket = cost % _BUCKETS
        queue[bucket, heads[bucket]] = block
        heads[bucket] += 1
        waiting += 1
    count = 0
    level = 0
    most = int(limit * _UNIT)
    while waiting > 0 and level <= most and count < enough:
        bucket = level % _BUCKETS
        at = 0
        while at < heads[bucket]:
            block = queue[bucket, at]
            at += 1
            waiting -= 1
            if search.costs[block] != level:
                continue
            for n in range(first_of[block], first_of[block + 1]):
                place = place_at[n]
                if not wanted[place] or place == origin:
                    continue
                length = level / _UNIT + _leg(net, block, places[place, 0], places[place, 1])
                known = -1
                for k in range(count):
                    if found[k] == place:
                        known = k
                        break
                if known >= 0:
                    lengths[known] = min(lengths[known], length)
                elif count < len(found):
                    found[count] = place
                    to_x, to_y = places[place]
                    if way_fits(net.fits, x, y, to_x, to_y):
                        length = math.hypot(to_x - x, to_y - y)
                    lengths[count] = length
                    count += 1
            links = net.links[block // columns, block % columns]
            for step in range(8):
                if links[step] == 0:
                    continue
                other = block + _STEP_Y[step] * columns + _STEP_X[step]
                cost = level + links[step]
                if cost < search.costs[other]:
                    if search.costs[other] == _NEVER:
                        search.touched[touched] = other
                        touched += 1
                    search.costs[other] = cost
                    search.before[other] = block
                    to_bucket = cost % _BUCKETS
                    if heads[to_bucket] == queue.shape[1]:
                        larger = np.zeros((_BUCKETS, 2 * queue.shape[1]), np.int32)
                        larger[:, : queue.shape[1]] = queue
                        queue = larger
                    queue[to_bucket, heads[to_bucket]] = other
                    heads[to_bucket] += 1
                    waiting += 1
        heads[bucket] = 0
        level += 1
    for n in range(touched):
        search.costs[search.touched[n]] = _NEVER
        search.before[search.touched[n]] = -1
    return count


@njit(cache=True, nogil=True)
def places_by_block(net: Net, places: Line) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return which places are near each block: ``first_of`` [blocks + 1] and ``place_at``."""
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
    return first_of, place_at


@njit(cache=True, nogil=True)
def neighbours(
    net: Net, search: Search, places: Line, most: int, limit: float
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Return the nearest places of each, the nearest first, and the lengths of the ways to them.

    int32 and float64 [places, most]; -1 and infinite where there are fewer within ``limit`` cells.
    """
    first_of, place_at = places_by_block(net, places)
    wanted = np.ones(len(places), np.bool_)
    nearest = np.full((len(places), most), -1, np.int32)
    lengths = np.full((len(places), most), np.inf)
    found = np.empty(4 * most, np.int32)
    ways = np.empty(4 * most, np.float64)
    for place in range(len(places)):
        count = nearest_places(
            net, search, places, first_of, place_at, wanted, place, most, limit, found, ways
        )
        order = np.argsort(ways[:count], kind="mergesort")
        for n in range(min(count, most)):
            nearest[place, n] = found[order[n]]
            lengths[place, n] = ways[order[n]]
    _make_symmetric(nearest, lengths)
    return nearest, lengths


@njit(cache=True, nogil=True)
def _make_symmetric(nearest: NDArray[np.int32], lengths: NDArray[np.float64]) -> None:
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


@njit(cache=True, nogil=True)
def way_between(
    net: Net, costs: NDArray[np.float64], x: float, y: float, to_x: float, to_y: float
) -> Line:
    """Return the shortest way over the net from one place to another, pulled straight.

    float64 [n, 2] with both ends; empty when there is none. ``costs`` is float64 [blocks], all
    infinite, and is left so.
    """
    if way_fits(net.fits, x, y, to_x, to_y):
        return np.array([[x, y], [to_x, to_y]])
    columns = net.links.shape[1]
    goals = np.empty(9, np.int32)
    goal_count = blocks_near(net, to_x, to_y, goals)
    near = np.empty(9, np.int32)
    keys = np.empty(4096, np.float64)
    items = np.empty(4096, np.int32)
    heap = 0
    before = {}
    best, best_block = np.inf, -1
    for n in range(blocks_near(net, x, y, near)):
        block = near[n]
        cost = _leg(net, block, x, y)
        costs[block] = cost
        before[block] = np.int32(-1)
        heap_push(keys, items, heap, cost + _leg(net, block, to_x, to_y), block)
        heap += 1
    while heap > 0 and keys[0] < best:
        block = items[0]
        key = keys[0]
        heap_pop(keys, items, heap)
        heap -= 1
        cost = costs[block]
        if key > cost + _leg(net, block, to_x, to_y) + 1e-9:
            continue
        for n in range(goal_count):
            if goals[n] == block and cost + _leg(net, block, to_x, to_y) < best:
                best, best_block = cost + _leg(net, block, to_x, to_y), block
        if heap + 8 > len(keys):
            keys = np.concatenate((keys, np.empty_like(keys)))
            items = np.concatenate((items, np.empty_like(items)))
        row, column = block // columns, block % columns
        for step in range(8):
            if net.links[row, column, step] == 0:
                continue
            other = block + _STEP_Y[step] * columns + _STEP_X[step]
            knot = net.knots[row, column]
            reached = cost + _leg(net, other, knot[0], knot[1])
            if reached < costs[other] - 1e-9:
                costs[other] = reached
                before[other] = np.int32(block)
                heap_push(keys, items, heap, reached + _leg(net, other, to_x, to_y), other)
                heap += 1
    for block in before:
        costs[block] = np.inf
    if best_block < 0:
        return np.empty((0, 2))
    count = 2
    block = best_block
    while block >= 0:
        count += 1
        block = before[block]
    way = np.empty((count, 2))
    way[0, 0], way[0, 1] = x, y
    way[count - 1, 0], way[count - 1, 1] = to_x, to_y
    block = best_block
    for at in range(count - 2, 0, -1):
        knot = net.knots[block // columns, block % columns]
        way[at, 0], way[at, 1] = knot[0], knot[1]
        block = before[block]
    return taut(net.fits, way)


@njit(cache=True, nogil=True)
def taut(fits: Mask, way: Line) -> Line:
    """Return a way pulled straight: bends are cut short and moved until none can be."""
    line = _shortcut(fits, way)
    for _ in range(4):
        # New bends halfway along the legs next to each bend let it slide towards its obstacle.
        finer = np.empty((2 * len(line) - 1, 2))
        for at in range(len(line)):
            finer[2 * at] = line[at]
            if at > 0:
                finer[2 * at - 1] = (line[at - 1] + line[at]) / 2
        for _ in range(3):
            for at in range(1, len(finer) - 1):
                _pull(fits, finer, at)
        shorter = _shortcut(fits, finer)
        if _length(shorter) > _length(line) - 0.05:
            break
        line = shorter
    return line


@njit(cache=True, nogil=True)
def _length(line: Line) -> float:
    length = 0.0
    for at in range(1, len(line)):
        length += math.hypot(line[at, 0] - line[at - 1, 0], line[at, 1] - line[at - 1, 1])
    return length


@njit(cache=True, nogil=True)
def _pull(fits: Mask, line: Line, at: int) -> None:
    """Move a bend towards the straight way between its neighbours as far as the legs fit."""
    x, y = line[at - 1]
    to_x, to_y = line[at + 1]
    along_x, along_y = to_x - x, to_y - y
    square = along_x * along_x + along_y * along_y
    if square == 0.0:
        return
    share = ((line[at, 0] - x) * along_x + (line[at, 1] - y) * along_y) / square
    share = min(max(share, 0.0), 1.0)
    off_x, off_y = x + share * along_x - line[at, 0], y + share * along_y - line[at, 1]
    part = 1.0
    while part > 0.02 and part * math.hypot(off_x, off_y) > 0.05:
        mid_x, mid_y = line[at, 0] + part * off_x, line[at, 1] + part * off_y
        if way_fits(fits, x, y, mid_x, mid_y) and way_fits(fits, mid_x, mid_y, to_x, to_y):
            line[at, 0], line[at, 1] = mid_x, mid_y
            return
        part /= 2


@njit(cache=True, nogil=True)
def _shortcut(fits: Mask, way: Line) -> Line:
    """Return the way without the bends that can be left out, farthest view first."""
    line = np.empty_like(way)
    line[0] = way[0]
    size = 1
    at = 0
    while at < len(way) - 1:
        to = len(way) - 1
        while to > at + 1 and not way_fits(fits, way[at, 0], way[at, 1], way[to, 0], way[to, 1]):
            to -= 1
        line[size] = way[to]
        size += 1
        at = to
    return line[:size].copy()
