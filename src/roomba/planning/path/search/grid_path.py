"""Shortest 8-connected paths over the cells of a grid; diagonal steps never cut a closed corner.

Jump point search (Harabor & Grastien, "Online graph pruning for pathfinding on grid maps", AAAI
2011, in its variant without corner cutting) on rows of bits: of all the equally long paths only
those that step diagonally first are followed, and only the cells where they must turn are nodes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, entry, inner_part, part
from roomba.planning.path.search.bit_rows import NOWHERE, Bits, bit_rows, is_set, jump
from roomba.planning.path.search.heap_kernels import heap_pop, heap_push

Cell = tuple[int, int]

_DIAGONAL = math.sqrt(2.0)
_ANY, _RIGHT, _LEFT, _UP, _DOWN = range(5)
"""How a cell was entered; up is to the next row. From the start all eight ways lead on."""
_STEPS = ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class GridPath:
    """A shortest 8-connected path: ``corners`` int [n, 2] (row, column) with straight or diagonal
    legs between them, and its ``length`` in cells."""

    corners: NDArray[np.int64]
    length: float

    @property
    def cells(self) -> NDArray[np.int64]:
        """Every cell on the path, int [m, 2] (row, column), from the start to the goal."""
        legs = [self.corners[:1]]
        for start, end in zip(self.corners[:-1], self.corners[1:], strict=True):
            steps = int(np.abs(end - start).max())
            legs.append(start + np.outer(np.arange(1, steps + 1), np.sign(end - start)))
        return np.concatenate(legs)


class GridSearch:
    """Finds shortest paths over grids; keeps its work arrays, so one search at a time."""

    def __init__(self) -> None:
        """Hold no arrays yet: they are made for the first grid and renewed for a larger one."""
        self._work = _new_work(0)
        self._epoch = 0

    def shortest_path(self, fits: NDArray[np.bool_], start: Cell, goal: Cell) -> GridPath | None:
        """Return a shortest path between two (row, column) cells, or None when there is none.

        ``fits`` is bool [rows, columns]: the cells that may be entered. Raises ValueError for a
        start or a goal outside it.
        """
        for name, cell in (("start", start), ("goal", goal)):
            if not (0 <= cell[0] < fits.shape[0] and 0 <= cell[1] < fits.shape[1]):
                raise ValueError(f"expected a {name} on the grid of {fits.shape} cells, got {cell}")
        if not (fits[start] and fits[goal]):
            return None
        rows = bit_rows(fits.view(np.uint8))
        columns = bit_rows(np.ascontiguousarray(fits.T).view(np.uint8))
        width = fits.shape[1] + 2
        size = (fits.shape[0] + 2) * width
        if self._work.costs.size < size:
            self._work, self._epoch = _new_work(size), 0
        self._epoch += 1
        first = (start[0] + 1) * width + start[1] + 1
        last = (goal[0] + 1) * width + goal[1] + 1
        if not _search(rows, columns, width, first, last, self._work, self._epoch):
            return None
        corners = [(goal[0], goal[1])]
        index = last
        while index != first:
            before = int(self._work.before[index])
            row, column = before // width - 1, before % width - 1
            # A jump is a diagonal leg and then a straight one.
            to_row, to_column = corners[-1]
            up, right = to_row - row, to_column - column
            steps = min(abs(up), abs(right))
            turn = (row + steps * _sign(up), column + steps * _sign(right))
            if turn not in ((row, column), (to_row, to_column)):
                corners.append(turn)
            corners.append((row, column))
            index = before
        return GridPath(np.array(corners[::-1], np.int64), float(self._work.costs[last]))


def shortest_grid_path(fits: NDArray[np.bool_], start: Cell, goal: Cell) -> GridPath | None:
    """Return a shortest 8-connected path; see :meth:`GridSearch.shortest_path`."""
    return GridSearch().shortest_path(fits, start, goal)


class _Work(NamedTuple):
    """Arrays over the padded cells, and the heap; a cell counts in this search if stamped so."""

    stamps: NDArray[np.int32]
    costs: NDArray[np.float64]
    before: NDArray[np.int32]
    entered: NDArray[np.int8]
    keys: NDArray[np.float64]
    items: NDArray[np.int32]


def _new_work(size: int) -> _Work:
    return _Work(
        np.zeros(size, np.int32),
        np.zeros(size, np.float64),
        np.zeros(size, np.int32),
        np.zeros(size, np.int8),
        np.zeros(size // 4 + 1, np.float64),
        np.zeros(size // 4 + 1, np.int32),
    )


@entry
def _sign(value: int) -> int:
    return (value > 0) - (value < 0)


@inner_part
def _may_lead_on(rows: Bits, y: int, x: int, entered: int, up: int, right: int) -> bool:
    """Whether a shortest path that entered a cell like that may leave it like this."""
    if entered == _ANY:
        return True
    # Back is never shorter, and aside only past a closed cell, which could not be rounded before.
    if entered in (_RIGHT, _LEFT):
        ahead = 1 if entered == _RIGHT else -1
        return right != -ahead and (up == 0 or not is_set(rows, y + up, x - ahead))
    ahead = 1 if entered == _UP else -1
    return up != -ahead and (right == 0 or not is_set(rows, y - ahead, x + right))


@part
def _reach(work: _Work, epoch: int, index: int, cost: float, before: int, entered: int) -> bool:
    """Note a way to a cell if it is the shortest yet."""
    stamp = work.stamps[index]
    if stamp == 2 * epoch + 1 or (stamp == 2 * epoch and work.costs[index] <= cost + _ROUNDING):
        return False
    work.stamps[index] = 2 * epoch
    work.costs[index] = cost
    work.before[index] = before
    work.entered[index] = entered
    return True


@part
def _estimate(index: int, width: int, goal: int) -> float:
    """Return the length of the way to the goal over an empty grid (the heuristic)."""
    across, along = abs(index // width - goal // width), abs(index % width - goal % width)
    return max(across, along) + (_DIAGONAL - 1.0) * min(across, along)


@allocating_entry
def _search(
    rows: Bits, columns: Bits, width: int, start: int, goal: int, work: _Work, epoch: int
) -> bool:
    """Leave the way back from the goal in ``work.before`` and its cost, if there is a way."""
    goal_y, goal_x = goal // width, goal % width
    keys, items = work.keys, work.items
    most_new = 8 * (rows.shape[0] + width)
    keys[0], items[0] = 0.0, start
    size = 1
    _reach(work, epoch, start, 0.0, start, _ANY)
    while size > 0:
        index = items[0]
        if index == goal:
            return True
        heap_pop(keys, items, size)
        size -= 1
        if work.stamps[index] == 2 * epoch + 1:
            continue
        work.stamps[index] = 2 * epoch + 1
        if size + most_new > keys.size:
            keys = np.concatenate((keys, np.empty(keys.size + most_new, keys.dtype)))
            items = np.concatenate((items, np.empty(items.size + most_new, items.dtype)))
        from_y, from_x = index // width, index % width
        for up, right in _STEPS:
            if not _may_lead_on(rows, from_y, from_x, work.entered[index], up, right):
                continue
            y, x, cost = from_y, from_x, work.costs[index]
            while True:
                if up != 0 and right != 0:
                    if not (
                        is_set(rows, y + up, x)
                        and is_set(rows, y, x + right)
                        and is_set(rows, y + up, x + right)
                    ):
                        break
                    y, x, cost = y + up, x + right, cost + _DIAGONAL
                    if y == goal_y and x == goal_x and _reach(work, epoch, goal, cost, index, _ANY):
                        heap_push(keys, items, size, cost, goal)
                        size += 1
                if right != 0:
                    to = jump(rows, y, x, right, goal_x if y == goal_y else NOWHERE)
                    found, far = y * width + to, cost + abs(to - x)
                    entered = _RIGHT if right > 0 else _LEFT
                    if to != NOWHERE and _reach(work, epoch, found, far, index, entered):
                        heap_push(keys, items, size, far + _estimate(found, width, goal), found)
                        size += 1
                if up != 0:
                    to = jump(columns, x, y, up, goal_y if x == goal_x else NOWHERE)
                    found, far = to * width + x, cost + abs(to - y)
                    entered = _UP if up > 0 else _DOWN
                    if to != NOWHERE and _reach(work, epoch, found, far, index, entered):
                        heap_push(keys, items, size, far + _estimate(found, width, goal), found)
                        size += 1
                if up == 0 or right == 0:
                    break
    return False
