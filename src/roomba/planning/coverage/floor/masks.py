"""Compiled work on masks for coverage: growing them, filling them, and straight ways over them.

Lengths and places in cells: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, entry
from roomba.raster.growing import with_room

_TILE = 32
"""Side, in cells, of the squares that are transposed at once: as many lines as the cache holds."""


def half_widths(radius: float, to_squares: bool = False) -> NDArray[np.int32]:
    """Return how many cells a disc covers to each side of its middle, row by row from there up.

    ``radius`` in cells; int32 [n], -1 for a row without any. A cell counts if its centre is at most
    ``radius`` away, or, with ``to_squares``, if any point of its square is.
    """
    away = 0.5 if to_squares else 0.0
    rows = np.maximum(np.arange(math.ceil(radius) + 2) - away, 0.0)
    inside = rows <= radius
    widths = np.floor(np.sqrt(np.where(inside, radius * radius - rows * rows, 0.0)) + away)
    return np.where(inside, widths, -1).astype(np.int32)[: int(inside.sum())]


def grown(mask: Mask, widths: NDArray[np.int32]) -> Mask:
    """Return ``mask`` grown by a disc, given as :func:`half_widths` does; bool, same shape."""
    rows, columns = mask.shape
    changes = np.zeros((rows, columns + 1), np.int16)
    _mark_changes(np.ascontiguousarray(mask), widths, changes)
    result = np.empty(mask.shape, np.bool_)
    _sum_changes(changes, result)
    result |= mask
    return result


@entry
def _mark_changes(mask: Mask, widths: NDArray[np.int32], changes: NDArray[np.int16]) -> None:
    """Note where discs around the outermost true cells begin and end in each row."""
    rows, columns = mask.shape
    for row in range(rows):
        for column in range(columns):
            if not mask[row, column]:
                continue
            if (
                (row == 0 or mask[row - 1, column])
                and (row == rows - 1 or mask[row + 1, column])
                and (column == 0 or mask[row, column - 1])
                and (column == columns - 1 or mask[row, column + 1])
            ):
                continue
            for away in range(widths.size):
                first = max(column - widths[away], 0)
                last = min(column + widths[away] + 1, columns)
                if row + away < rows:
                    changes[row + away, first] += 1
                    changes[row + away, last] -= 1
                if away > 0 and row - away >= 0:
                    changes[row - away, first] += 1
                    changes[row - away, last] -= 1


@entry
def _sum_changes(changes: NDArray[np.int16], result: Mask) -> None:
    rows, columns = result.shape
    for row in range(rows):
        depth = 0
        for column in range(columns):
            depth += changes[row, column]
            result[row, column] = depth > 0


@allocating_entry
def transposed(mask: Mask) -> Mask:
    """Return the mask with rows for columns, bool [columns, rows]."""
    rows, columns = mask.shape
    result = np.empty((columns, rows), np.bool_)
    for first_row in range(0, rows, _TILE):
        for first_column in range(0, columns, _TILE):
            for row in range(first_row, min(first_row + _TILE, rows)):
                for column in range(first_column, min(first_column + _TILE, columns)):
                    result[column, row] = mask[row, column]
    return result


@allocating_entry
def filled_from(mask: Mask, row: int, column: int) -> Mask:
    """Return the true cells connected over sides to one of them; bool, same shape."""
    rows, columns = mask.shape
    filled = np.zeros((rows, columns), np.bool_)
    stack = np.empty((1024, 2), np.int32)
    stack[0, 0], stack[0, 1] = row, column
    size = 1
    while size > 0:
        size -= 1
        row, column = stack[size, 0], stack[size, 1]
        if filled[row, column] or not mask[row, column]:
            continue
        first = column
        while first > 0 and mask[row, first - 1] and not filled[row, first - 1]:
            first -= 1
        last = column
        while last < columns - 1 and mask[row, last + 1] and not filled[row, last + 1]:
            last += 1
        if size + 2 * (last - first + 1) > len(stack):
            stack = with_room(stack, size, 2 * len(stack) + 2 * columns)
        for at in range(first, last + 1):
            filled[row, at] = True
        for beside in (row - 1, row + 1):
            if not 0 <= beside < rows:
                continue
            open_before = False
            for at in range(first, last + 1):
                is_open = mask[beside, at] and not filled[beside, at]
                if is_open and not open_before:
                    stack[size, 0], stack[size, 1] = beside, at
                    size += 1
                open_before = is_open
    return filled


@entry
def way_fits(fits: Mask, x: float, y: float, to_x: float, to_y: float) -> bool:
    """Whether the middle may go straight from one point to another.

    The way must run between centres that fit; then it is at most the sagitta of a diagonal step,
    about ``1 / (4 * reach)`` cells, nearer to a corner than the centres are.
    """
    rows, columns = fits.shape
    steep = abs(to_y - y) > abs(to_x - x)
    if steep:
        x, y, to_x, to_y = y, x, to_y, to_x
    if x > to_x:
        x, y, to_x, to_y = to_x, to_y, x, y
    slope = (to_y - y) / (to_x - x) if to_x > x else 0.0
    for along in range(math.floor(x + 1e-6), math.ceil(to_x - 1e-6) + 1):
        across = y + slope * (min(max(float(along), x), to_x) - x)
        for side in range(math.floor(across + 1e-6), math.ceil(across - 1e-6) + 1):
            row, column = (along, side) if steep else (side, along)
            if not (0 <= row < rows and 0 <= column < columns and fits[row, column]):
                return False
    return True
