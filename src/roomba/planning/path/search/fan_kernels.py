"""Compiled fans of the any-angle search: what a root sees of one row, driven on to the next row.

See :mod:`roomba.planning.path.search.path_kernels` for the search. Lengths in cells.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Ints32
from roomba.compilation import entry, inner_part, part
from roomba.planning.path.search.floor_kernels import BEND, CROSSING, SIDE_X, SIDE_Y
from roomba.planning.path.search.heap_kernels import heap_push

Bytes = NDArray[np.uint8]

GOAL = -2
"""The goal's item in the heap."""
EPSILON = 1e-9
"""cells; rays through centres pass other centres exactly or by more than 1e-4 cells."""


class Work(NamedTuple):
    """What the search reads and writes; it is reused, by one search at a time."""

    fits: Bytes
    """uint8 [rows, columns], as are the next two; from :func:`.floor_kernels.survey`."""
    open_squares: Bytes
    flags: Bytes
    stamps: Ints32
    """int32 [rows * columns]: 2 * epoch where this search found a root, + 1 where it is done."""
    costs: Floats
    """float64 [rows * columns]: length of the way from the start to a root."""
    before: Ints32
    """int32 [rows * columns]: the root before a root, or START."""
    keys: Floats
    """float64 [capacity] and int32: the heap of roots, fans (from rows * columns on) and GOAL."""
    items: Ints32
    fan_roots: Ints32
    """int32 [capacity] and float64 [capacity, 7]: the fans, see ROOT_X."""
    fans: Floats
    state: NDArray[np.int64]
    """int64 [5], see HEAP_SIZE."""
    ends: Floats
    """float64 [5]: start x, y, goal x, y, and the length of the best way to the goal yet."""


HEAP_SIZE, FANS, EPOCH, BEFORE_GOAL, GOAL_SQUARE = range(5)
"""Slots of ``Work.state``; GOAL_SQUARE is the row of open squares in which the goal lies, or -1."""
ROOT_X, ROOT_Y, ROOT_COST, ROW, DIRECTION, LEFT, RIGHT = range(7)
"""Slots of a fan: what its root sees of a row, from LEFT to RIGHT, going on in y by
DIRECTION (+-1)."""


@part
def offer_goal(work: Work, root: int, cost: float) -> None:
    """Take a way to the goal over ``root`` if it is the shortest yet."""
    if cost < work.ends[4]:
        work.ends[4] = cost
        work.state[BEFORE_GOAL] = root
        heap_push(work.keys, work.items, work.state[HEAP_SIZE], cost, GOAL)
        work.state[HEAP_SIZE] += 1


@entry
def offer_root(work: Work, x: int, y: int, root: int, cost: float) -> None:
    """Take a way to the centre (x, y) over ``root`` if it is the shortest yet."""
    index = y * work.fits.shape[1] + x
    found = 2 * work.state[EPOCH]
    if work.stamps[index] >= found and work.costs[index] <= cost + EPSILON * 1e-3:
        return
    if work.stamps[index] == found + 1:
        return
    work.stamps[index] = found
    work.costs[index] = cost
    work.before[index] = root
    key = cost + math.hypot(x - work.ends[2], y - work.ends[3])
    heap_push(work.keys, work.items, work.state[HEAP_SIZE], key, index)
    work.state[HEAP_SIZE] += 1


@inner_part
def see(
    work: Work, x: int, y: int, root: int, root_x: float, root_y: float, root_cost: float
) -> None:
    """Let a root see a centre: offer it where a taut path can bend, at a crossing or exit."""
    flag = work.flags[y, x]
    if flag == 0:
        return
    wanted = flag >= CROSSING
    if not wanted:
        for side in range(4):
            if flag & BEND[side]:
                along = (x - root_x) * SIDE_X[side]
                across = (y - root_y) * SIDE_Y[side]
                wanted |= (along < 0.0 <= across) or (across < 0.0 <= along)
    if wanted:
        offer_root(work, x, y, root, root_cost + math.hypot(x - root_x, y - root_y))


@entry
def add_fan(
    work: Work,
    root: int,
    root_x: float,
    root_y: float,
    root_cost: float,
    row: int,
    direction: int,
    left: float,
    right: float,
) -> None:
    """Note what a root sees of a row from left to right, its roots at once, and go on later."""
    for x in range(math.ceil(left - EPSILON), math.floor(right + EPSILON) + 1):
        see(work, x, row, root, root_x, root_y, root_cost)
    if right - left <= EPSILON:
        return
    # The shortest way over this row leads straight to the goal, or to its image if it lies behind.
    goal_x, goal_y = work.ends[2], work.ends[3]
    beyond = abs(goal_y - row)
    before = abs(row - root_y)
    over = root_x + (goal_x - root_x) * before / (before + beyond)
    over = min(max(over, left), right)
    key = root_cost + math.hypot(over - root_x, before) + math.hypot(over - goal_x, beyond)
    index = work.state[FANS]
    work.state[FANS] += 1
    work.fan_roots[index] = root
    fan = work.fans[index]
    fan[ROOT_X], fan[ROOT_Y], fan[ROOT_COST] = root_x, root_y, root_cost
    fan[ROW], fan[DIRECTION], fan[LEFT], fan[RIGHT] = row, direction, left, right
    heap_push(work.keys, work.items, work.state[HEAP_SIZE], key, work.stamps.size + index)
    work.state[HEAP_SIZE] += 1


@entry
def drive_fan(work: Work, index: int) -> None:
    """Drive a fan through the open squares before it to the next row."""
    fan = work.fans[index]
    root = work.fan_roots[index]
    root_x, root_y, root_cost = fan[ROOT_X], fan[ROOT_Y], fan[ROOT_COST]
    direction = int(fan[DIRECTION])
    row = int(fan[ROW])
    squares = work.open_squares[row if direction > 0 else row - 1]
    spread = (row + direction - root_y) / (row - root_y)
    goal_x = work.ends[2]
    goal_spread = 0.0
    if work.state[GOAL_SQUARE] == (row if direction > 0 else row - 1):
        goal_spread = (work.ends[3] - root_y) / (row - root_y)
    first = math.floor(fan[LEFT] + EPSILON)
    last = math.ceil(fan[RIGHT] - EPSILON)
    column = first
    while column < last:
        if not squares[column]:
            column += 1
            continue
        left = max(fan[LEFT], column)
        end = column
        while end < last and squares[end]:
            end += 1
        right = min(fan[RIGHT], end)
        # Rays that lean outwards see more of the next row, up to the next closed square.
        wall_left, wall_right = column, end
        far_left = root_x + (left - root_x) * spread
        far_right = root_x + (right - root_x) * spread
        while wall_left > far_left and squares[wall_left - 1]:
            wall_left -= 1
        while wall_right < far_right and squares[wall_right]:
            wall_right += 1
        if goal_spread > 0.0:
            goal_left = max(root_x + (left - root_x) * goal_spread, wall_left)
            goal_right = min(root_x + (right - root_x) * goal_spread, wall_right)
            if goal_left - EPSILON <= goal_x <= goal_right + EPSILON:
                way = math.hypot(goal_x - root_x, work.ends[3] - root_y)
                offer_goal(work, root, root_cost + way)
        far_left, far_right = max(far_left, wall_left), min(far_right, wall_right)
        if far_left <= far_right + EPSILON:
            add_fan(
                work,
                root,
                root_x,
                root_y,
                root_cost,
                row + direction,
                direction,
                far_left,
                far_right,
            )
        column = end
