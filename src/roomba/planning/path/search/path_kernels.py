"""Compiled search for the shortest any-angle path over a floor of cells that fit.

Lengths in cells; the floor, its squares and flags are those of :mod:`.floor_kernels`.

The search is exact, after Anya (Harabor, Grastien, Öz & Aksakalli, "Optimal any-angle pathfinding
in practice", JAIR 56, 2016): A* over *roots*, the points where a path may bend, and over *fans*,
what a root sees of one row of centres. A fan is driven to the next row and so finds the next roots.
"""

from __future__ import annotations

import math

from roomba.arrays import Floats, Ints32
from roomba.compilation import entry, inner_part, part
from roomba.planning.path.search.fan_kernels import (
    EPOCH,
    EPSILON,
    FANS,
    GOAL,
    GOAL_SQUARE,
    HEAP_SIZE,
    Work,
    add_fan,
    drive_fan,
    offer_goal,
    offer_root,
    see,
)
from roomba.planning.path.search.floor_kernels import BEND, CROSSING, EXIT, SIDE_X, SIDE_Y
from roomba.planning.path.search.heap_kernels import heap_pop

START = -1
"""Stands for the start in place of a root."""
FULL, NO_PATH, FOUND = 0, 1, 2
EVERYWHERE = 1e18


@part
def _look(work: Work, x: int, y: int, direction: int, low: float, high: float) -> None:
    """Open the fan of the root at centre (x, y) to the next row, from x = low to high there."""
    strip = y if direction > 0 else y - 1
    squares = work.open_squares[strip]
    left, right = x, x
    while left > low and squares[left - 1]:
        left -= 1
    while right < high and squares[right]:
        right += 1
    root = y * work.fits.shape[1] + x
    cost = work.costs[root]
    if work.state[GOAL_SQUARE] == strip:
        away = abs(work.ends[3] - y)
        goal_left = max(left, x + (low - x) * away)
        goal_right = min(right, x + (high - x) * away)
        if goal_left - EPSILON <= work.ends[2] <= goal_right + EPSILON:
            offer_goal(work, root, cost + math.hypot(work.ends[2] - x, away))
    seen_left, seen_right = max(float(left), low), min(float(right), high)
    if seen_left <= seen_right + EPSILON:
        add_fan(
            work, root, float(x), float(y), cost, y + direction, direction, seen_left, seen_right
        )


@inner_part
def _look_along(work: Work, x: int, y: int, step: int) -> None:
    """See the centres in the root's own row, to the right (step 1) or to the left (-1)."""
    root = y * work.fits.shape[1] + x
    at = x
    while work.fits[y, at + step]:
        at += step
        see(work, at, y, root, x, y, work.costs[root])
        if work.flags[y, at] & CROSSING:
            break


@inner_part
def _expand_root(work: Work, root: int, everywhere: bool) -> None:
    """Look from a root: around the closed square at which the path bends, or everywhere."""
    columns = work.fits.shape[1]
    y, x = root // columns, root % columns
    flag = work.flags[y, x]
    if everywhere or flag & CROSSING:
        for step in (-1, 1):
            _look(work, x, y, step, -EVERYWHERE, EVERYWHERE)
            _look_along(work, x, y, step)
            if work.fits[y + step, x]:
                offer_root(work, x, y + step, root, work.costs[root] + 1.0)
        return
    before = work.before[root]
    if before == START:
        along_x, along_y = x - work.ends[0], y - work.ends[1]
    else:
        along_x, along_y = float(x - before % columns), float(y - before // columns)
    for side in range(4):
        if not flag & BEND[side]:
            continue
        side_x, side_y = SIDE_X[side], SIDE_Y[side]
        along, across = along_x * side_x, along_y * side_y
        if along < 0.0 <= across:
            # Past the square's corner below it: from straight on up to along its upright edge.
            lean = EVERYWHERE if across == 0.0 else -along / across
            low, high = (x - lean, float(x)) if side_x > 0 else (float(x), x + lean)
            _look(work, x, y, side_y, low, high)
        elif across < 0.0 <= along:
            lean = along / -across
            low, high = (x + lean, EVERYWHERE) if side_x > 0 else (-EVERYWHERE, x - lean)
            _look(work, x, y, -side_y, low, high)
            _look_along(work, x, y, side_x)


@inner_part
def _expand_start(work: Work) -> None:
    """Look everywhere from a start inside an open square."""
    x, y = work.ends[0], work.ends[1]
    strip = math.floor(y)
    squares = work.open_squares[strip]
    left = right = math.floor(x)
    while squares[left - 1]:
        left -= 1
    while squares[right]:
        right += 1
    if work.state[GOAL_SQUARE] == strip and left <= work.ends[2] <= right:
        offer_goal(work, START, math.hypot(work.ends[2] - x, work.ends[3] - y))
    for up in range(2):
        add_fan(work, int(START), x, y, 0.0, strip + up, 2 * up - 1, float(left), float(right))


@entry
def search(
    work: Work, entries: Ints32, entry_legs: Floats, exits: Ints32, exit_legs: Floats, inside: bool
) -> int:
    """Find the shortest path from the start to the goal in ``work.ends``; return how it went.

    ``entries`` are roots that the start, when it is not ``inside`` an open square, reaches straight
    by ``entry_legs``; ``exits`` those that reach the goal by ``exit_legs``. FOUND leaves the length
    in ``work.ends[4]`` and the roots in ``work.before`` from ``work.state[BEFORE_GOAL]`` on; FULL
    asks for larger heap and fan arrays.
    """
    columns = work.fits.shape[1]
    work.state[HEAP_SIZE] = 0
    work.state[FANS] = 0
    work.ends[4] = EVERYWHERE
    done = 2 * work.state[EPOCH] + 1
    for index in exits:
        work.flags[index // columns, index % columns] |= EXIT
    if inside:
        _expand_start(work)
    for n in range(entries.size):
        offer_root(work, entries[n] % columns, entries[n] // columns, int(START), entry_legs[n])
    outcome = NO_PATH
    # One expansion adds at most a fan and a few roots for each column.
    room = 3 * columns + 8
    while work.state[HEAP_SIZE] > 0:
        if work.state[HEAP_SIZE] + room > work.keys.size or work.state[FANS] + room > len(
            work.fans
        ):
            outcome = FULL
            break
        item = work.items[0]
        heap_pop(work.keys, work.items, work.state[HEAP_SIZE])
        work.state[HEAP_SIZE] -= 1
        if item == GOAL:
            outcome = FOUND
            break
        if item >= work.stamps.size:
            drive_fan(work, item - work.stamps.size)
        elif work.stamps[item] != done:
            work.stamps[item] = done
            if work.flags[item // columns, item % columns] & EXIT:
                for n in range(exits.size):
                    if exits[n] == item:
                        offer_goal(work, item, work.costs[item] + exit_legs[n])
            _expand_root(work, item, work.before[item] == START and not inside)
    for index in exits:
        work.flags[index // columns, index % columns] &= ~EXIT
    return outcome
