"""Compiled shortest ways for the middle from place to place.

The search runs on a coarse net; the way found on it is then pulled straight. Places in cells of the
window: (x, y) is (column, row).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask, Polyline
from roomba.compilation import allocating_entry, allocating_part, inner_part
from roomba.planning.coverage.floor.masks import way_fits
from roomba.planning.coverage.tour.net import STEP_X, STEP_Y, Net, blocks_near, leg_to
from roomba.planning.path.search.heap_kernels import heap_pop, heap_push


@allocating_entry
def way_between(
    net: Net, costs: NDArray[np.float64], x: float, y: float, to_x: float, to_y: float
) -> Polyline:
    """Return the shortest way over the net from one place to another, pulled straight.

    float64 [n, 2] with both ends; empty if there is no way. ``costs`` is a work array, float64
    [blocks]: all infinite, before and after.
    """
    if way_fits(net.fits, x, y, to_x, to_y):
        return np.array([[x, y], [to_x, to_y]])
    before, last = _search(net, costs, x, y, to_x, to_y)
    for block in before:
        costs[block] = np.inf
    if last < 0:
        return np.empty((0, 2))
    return taut(net.fits, _knots_to(net, before, last, x, y, to_x, to_y))


@allocating_part
def _search(
    net: Net, costs: NDArray[np.float64], x: float, y: float, to_x: float, to_y: float
) -> tuple[dict[int, int], int]:
    """Search from place to place by A*; return the block before each, and the way's last block.

    The block before the first one is -1; the last block is -1 if there is no way. Writes the costs
    of the blocks.
    """
    columns = net.links.shape[1]
    goals = np.empty(9, np.int32)
    goal_count = blocks_near(net, to_x, to_y, goals)
    near = np.empty(9, np.int32)
    keys = np.empty(4096, np.float64)
    items = np.empty(4096, np.int32)
    heap = 0
    before: dict[int, int] = {}
    best, best_block = np.inf, -1
    for n in range(blocks_near(net, x, y, near)):
        block = int(np.int64(near[n]))  # as wide as the sums that follow
        cost = leg_to(net, block, x, y)
        costs[block] = cost
        before[block] = -1
        heap_push(keys, items, heap, cost + leg_to(net, block, to_x, to_y), block)
        heap += 1
    while heap > 0 and keys[0] < best:
        block = items[0]
        key = keys[0]
        heap_pop(keys, items, heap)
        heap -= 1
        cost = costs[block]
        if key > cost + leg_to(net, block, to_x, to_y) + 1e-9:
            continue
        for n in range(goal_count):
            if goals[n] == block and cost + leg_to(net, block, to_x, to_y) < best:
                best, best_block = cost + leg_to(net, block, to_x, to_y), block
        if heap + 8 > len(keys):
            keys = np.concatenate((keys, np.empty_like(keys)))
            items = np.concatenate((items, np.empty_like(items)))
        row, column = block // columns, block % columns
        knot = net.knots[row, column]
        for step in range(8):
            if net.links[row, column, step] == 0:
                continue
            other = block + STEP_Y[step] * columns + STEP_X[step]
            reached = cost + leg_to(net, other, knot[0], knot[1])
            if reached < costs[other] - 1e-9:
                costs[other] = reached
                before[other] = block
                heap_push(keys, items, heap, reached + leg_to(net, other, to_x, to_y), other)
                heap += 1
    return before, best_block


@allocating_part
def _knots_to(
    net: Net, before: dict[int, int], last: int, x: float, y: float, to_x: float, to_y: float
) -> Polyline:
    """Return a way over the knots of the blocks before the last one, with both its ends."""
    columns = net.links.shape[1]
    count = 2
    block = last
    while block >= 0:
        count += 1
        block = before[block]
    way = np.empty((count, 2))
    way[0, 0], way[0, 1] = x, y
    way[count - 1, 0], way[count - 1, 1] = to_x, to_y
    block = last
    for at in range(count - 2, 0, -1):
        knot = net.knots[block // columns, block % columns]
        way[at, 0], way[at, 1] = knot[0], knot[1]
        block = before[block]
    return way


@allocating_entry
def taut(fits: Mask, way: Polyline) -> Polyline:
    """Return a way pulled straight: bends are cut short and moved until none can be."""
    line = _shortcut(fits, way)
    for _ in range(4):
        # New points halfway along the legs let each bend slide towards its obstacle.
        finer = np.empty((2 * len(line) - 1, 2))
        for at in range(len(line)):
            for axis in range(2):
                finer[2 * at, axis] = line[at, axis]
                if at > 0:
                    finer[2 * at - 1, axis] = (line[at - 1, axis] + line[at, axis]) / 2
        for _ in range(3):
            for at in range(1, len(finer) - 1):
                _pull(fits, finer, at)
        shorter = _shortcut(fits, finer)
        if _length(shorter) > _length(line) - 0.05:
            break
        line = shorter
    return line


@inner_part
def _length(line: Polyline) -> float:
    length = 0.0
    for at in range(1, len(line)):
        length += math.hypot(line[at, 0] - line[at - 1, 0], line[at, 1] - line[at - 1, 1])
    return length


@inner_part
def _pull(fits: Mask, line: Polyline, at: int) -> None:
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


@allocating_part
def _shortcut(fits: Mask, way: Polyline) -> Polyline:
    """Return the way without needless bends: from each point straight to the farthest in view."""
    line = np.empty_like(way)
    line[0, 0], line[0, 1] = way[0, 0], way[0, 1]
    size = 1
    at = 0
    while at < len(way) - 1:
        to = len(way) - 1
        while to > at + 1 and not way_fits(fits, way[at, 0], way[at, 1], way[to, 0], way[to, 1]):
            to -= 1
        line[size, 0], line[size, 1] = way[to, 0], way[to, 1]
        size += 1
        at = to
    return line[:size].copy()
