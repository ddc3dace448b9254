"""Compiled: lengths of the ways to each cell, and the cells of frontiers."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, entry, inner_part, part
from roomba.grid import FREE, OCCUPIED, UNKNOWN

Values = NDArray[np.int8]

_DIAGONAL: Final = math.sqrt(2.0)
_SMALL: Final = 1
_LARGE: Final = 2
"""What is known of a cell's unknown patch: that it is large, or small; 0 is nothing yet."""


@allocating_entry
def ways_from(fits: NDArray[np.bool_], row: int, column: int, ways: NDArray[np.float64]) -> None:
    """Fill ``ways`` with the lengths, in cells, of the shortest ways over cells that fit.

    Steps go to eight neighbours and cut no closed corner. Where no way leads, the length is
    infinite. The first cell need not fit.
    """
    rows, columns = fits.shape
    ways[:] = math.inf
    ways[row, column] = 0.0
    # A queue of cells whose neighbours are to be looked at, each in it once at most. Steps are
    # about equally long, so that hardly any cell comes twice; a heap would take five times as long.
    queue, waits = np.empty(fits.size, np.int64), np.zeros(fits.shape, np.bool_)
    queue[0] = row * columns + column
    first, count = 0, 1
    while count > 0:
        at_row, at_column = queue[first] // columns, queue[first] % columns
        first, count = (first + 1) % fits.size, count - 1
        waits[at_row, at_column] = False
        for down in range(-1, 2):
            for right in range(-1, 2):
                to_row, to_column = at_row + down, at_column + right
                if not (0 <= to_row < rows and 0 <= to_column < columns):
                    continue
                is_diagonal = down != 0 and right != 0
                on = ways[at_row, at_column] + (_DIAGONAL if is_diagonal else 1.0)
                if not (on < ways[to_row, to_column] and fits[to_row, to_column]):
                    continue
                if is_diagonal and not (fits[at_row, to_column] and fits[to_row, at_column]):
                    continue
                ways[to_row, to_column] = on
                if not waits[to_row, to_column]:
                    waits[to_row, to_column] = True
                    queue[(first + count) % fits.size] = to_row * columns + to_column
                    count += 1


@allocating_entry
def frontier_cells(values: Values, least: int, frontier: NDArray[np.bool_]) -> None:
    """Mark free cells with a side to an unknown patch of ``least`` connected cells or more.

    Smaller patches of the unknown are shadows of chair legs and gaps between beams.
    """
    rows, columns = values.shape
    sizes = np.zeros(values.shape, np.int8)
    patch = np.empty(least, np.int64)
    _mark_sides(values, frontier)
    for row in range(1, rows - 1):
        for column in range(1, columns - 1):
            if frontier[row, column]:
                frontier[row, column] = (
                    _is_large(values, row - 1, column, sizes, patch)
                    or _is_large(values, row + 1, column, sizes, patch)
                    or _is_large(values, row, column - 1, sizes, patch)
                    or _is_large(values, row, column + 1, sizes, patch)
                )


@inner_part
def _mark_sides(values: Values, marked: NDArray[np.bool_]) -> None:
    """Mark free cells with a side to an unknown cell, but no cells at the border of the map."""
    marked[:] = False
    for row in range(1, values.shape[0] - 1):
        below, own, above = values[row - 1, 1:-1], values[row], values[row + 1, 1:-1]
        left, middle, right, into = own[:-2], own[1:-1], own[2:], marked[row, 1:-1]
        for index in range(into.size):
            beside = (below[index] == UNKNOWN) | (above[index] == UNKNOWN)
            beside |= (left[index] == UNKNOWN) | (right[index] == UNKNOWN)
            into[index] = beside & (middle[index] == FREE)


@part
def _is_large(
    values: Values, row: int, column: int, sizes: NDArray[np.int8], patch: NDArray[np.int64]
) -> bool:
    """Whether a cell is in an unknown patch of as many cells as ``patch`` has room for, or more.

    ``sizes`` keeps the results. Of a large patch only as many cells are visited as decide it.
    """
    if values[row, column] != UNKNOWN or sizes[row, column] != 0:
        return bool(sizes[row, column] == _LARGE)
    rows, columns = values.shape
    patch[0] = row * columns + column
    sizes[row, column] = _SMALL
    first, count, is_large = 0, 1, patch.size == 1
    while first < count and not is_large:
        at_row, at_column = patch[first] // columns, patch[first] % columns
        first += 1
        for side in range(4):
            to_row = at_row + (1 if side == 0 else -1 if side == 1 else 0)
            to_column = at_column + (1 if side == 2 else -1 if side == 3 else 0)
            if not (0 <= to_row < rows and 0 <= to_column < columns) or is_large:
                continue
            if values[to_row, to_column] == UNKNOWN and sizes[to_row, to_column] != _SMALL:
                is_large = sizes[to_row, to_column] == _LARGE or count + 1 == patch.size
                sizes[to_row, to_column] = _SMALL
                patch[count] = to_row * columns + to_column
                count += 1
    if is_large:
        for index in range(count):
            sizes[patch[index] // columns, patch[index] % columns] = _LARGE
    return is_large


@allocating_entry
def clusters(frontier: NDArray[np.bool_], labels: NDArray[np.int32]) -> int:
    """Fill ``labels`` with the numbers, from 1, of frontiers: cells that touch; return how many."""
    rows, columns = frontier.shape
    labels[:] = 0
    stack = np.empty(frontier.size, np.int64)
    number = 0
    for row in range(rows):
        for column in range(columns):
            if not frontier[row, column] or labels[row, column] != 0:
                continue
            number += 1
            labels[row, column] = number
            stack[0] = row * columns + column
            size = 1
            while size > 0:
                size -= 1
                cell = stack[size]
                for to_row in range(max(cell // columns - 1, 0), min(cell // columns + 2, rows)):
                    for to_column in range(
                        max(cell % columns - 1, 0), min(cell % columns + 2, columns)
                    ):
                        if frontier[to_row, to_column] and labels[to_row, to_column] == 0:
                            labels[to_row, to_column] = number
                            stack[size] = to_row * columns + to_column
                            size += 1
    return number


@entry
def seen_from(
    cells: NDArray[np.int64],
    middles: NDArray[np.float64],
    left_out: NDArray[np.float64],
    away: float,
    values: Values,
    costs: NDArray[np.float64],
    radius: int,
    aside: float,
) -> tuple[int, int, int]:
    """Return the first of ``cells``, int64 [n, 2], that can be looked at, and from which cell.

    Returned are its index, and row and column of the viewpoint, see :func:`viewpoint`; all are -1
    if there is none. Cells whose ``middles`` [n, 2] are nearer than ``away`` to ``left_out``
    [m, 2], m, do not count.
    """
    for index in range(cells.shape[0]):
        is_left_out = False
        for number in range(left_out.shape[0]):
            off_x = middles[index, 0] - left_out[number, 0]
            off_y = middles[index, 1] - left_out[number, 1]
            is_left_out = is_left_out or math.hypot(off_x, off_y) < away
        if is_left_out:
            continue
        row, column, cost = viewpoint(
            values, costs, cells[index, 0], cells[index, 1], radius, aside
        )
        if math.isfinite(cost):
            return index, row, column
    return -1, -1, -1


@entry
def viewpoint(
    values: Values,
    costs: NDArray[np.float64],
    row: int,
    column: int,
    radius: int,
    aside: float,
) -> tuple[int, int, float]:
    """Return the cell from where a frontier cell is best looked at, and its cost in cells.

    The viewpoint can be reached, nothing occupied lies between, and it is at most ``radius`` cells
    away. Its cost is its entry in ``costs``, plus ``aside`` times its distance from the frontier
    cell. An infinite cost means that there is none.
    """
    rows, columns = values.shape
    best, best_row, best_column = math.inf, -1, -1
    for to_row in range(max(row - radius, 0), min(row + radius + 1, rows)):
        for to_column in range(max(column - radius, 0), min(column + radius + 1, columns)):
            away = math.hypot(to_row - row, to_column - column)
            cost = costs[to_row, to_column] + aside * away
            if away > radius or not cost < best:
                continue
            if _sees(values, to_row, to_column, row, column):
                best, best_row, best_column = cost, to_row, to_column
    return best_row, best_column, best


@inner_part
def _sees(values: Values, row: int, column: int, to_row: int, to_column: int) -> bool:
    """Whether nothing occupied lies between two cells."""
    steps = max(abs(to_row - row), abs(to_column - column))
    for step in range(1, steps):
        share = step / steps
        between_row = round(row + share * (to_row - row))
        between_column = round(column + share * (to_column - column))
        if values[between_row, between_column] == OCCUPIED:
            return False
    return True
