"""Compiled work on masks for coverage: growing them, filling them, and what a tool sweeps.

Lengths and places in cells: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.mask_kernels import Mask

Counts = NDArray[np.int16]
"""How many pieces of a path sweep each cell, int16 [rows, columns]."""


def half_widths(radius: float, to_squares: bool = False) -> NDArray[np.int32]:
    """Return how many cells a disc covers to each side of its middle, row by row from there up.

    ``radius`` in cells; int32 [n], -1 where nothing. A cell counts when its centre is at most
    ``radius`` away, or with ``to_squares`` when any of its square is.
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


@njit(cache=True, nogil=True)
def _mark_changes(mask: Mask, widths: NDArray[np.int32], changes: Counts) -> None:
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


@njit(cache=True, nogil=True)
def _sum_changes(changes: Counts, result: Mask) -> None:
    rows, columns = result.shape
    for row in range(rows):
        depth = 0
        for column in range(columns):
            depth += changes[row, column]
            result[row, column] = depth > 0


@njit(cache=True, nogil=True)
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
            larger = np.empty((2 * len(stack) + 2 * columns, 2), np.int32)
            larger[:size] = stack[:size]
            stack = larger
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


@njit(cache=True, nogil=True)
def side_of(x: float, y: float, to_x: float, to_y: float, radius: float) -> tuple[float, float]:
    """Return the step from a way to the side of the strip that is swept along it."""
    length = math.hypot(to_x - x, to_y - y)
    if length == 0.0:
        return 0.0, 0.0
    return -(to_y - y) / length * radius, (to_x - x) / length * radius


@njit(cache=True, nogil=True)
def swept_columns(
    x: float,
    y: float,
    to_x: float,
    to_y: float,
    side: tuple[float, float],
    radius: float,
    row: int,
) -> tuple[int, int]:
    """Return the first and last column of a row whose centres are within ``radius`` of a way.

    ``side`` is what :func:`side_of` returns for it.
    """
    low, high = np.inf, -np.inf
    square = radius * radius - (row - y) * (row - y)
    if square >= 0.0:
        half = math.sqrt(square)
        low, high = x - half, x + half
    square = radius * radius - (row - to_y) * (row - to_y)
    if square >= 0.0:
        half = math.sqrt(square)
        low, high = min(low, to_x - half), max(high, to_x + half)
    if to_y != y:
        # The sides of the strip, between its ends, lie beside the way.
        slope = (to_x - x) / (to_y - y)
        for sign in (-1.0, 1.0):
            begin = y + sign * side[1]
            end = to_y + sign * side[1]
            if min(begin, end) <= row <= max(begin, end):
                at = x + sign * side[0] + (row - begin) * slope
                low, high = min(low, at), max(high, at)
    if low > high:
        return 1, 0
    return math.ceil(low - 1e-6), math.floor(high + 1e-6)


@njit(cache=True, nogil=True)
def sweep(counts: Counts, points: NDArray[np.float64], radius: float, change: int) -> None:
    """Add ``change`` to the counts of all cells within ``radius`` of each leg of a path.

    ``points`` is float64 [n, 2] (x, y); a path of one point is a leg without length.
    """
    rows, columns = counts.shape
    reach = radius + 1e-7
    for leg in range(max(len(points) - 1, 1)):
        x, y = points[leg]
        to_x, to_y = points[min(leg + 1, len(points) - 1)]
        side = side_of(x, y, to_x, to_y, reach)
        first_row = max(math.ceil(min(y, to_y) - reach), 0)
        last_row = min(math.floor(max(y, to_y) + reach), rows - 1)
        for row in range(first_row, last_row + 1):
            first, last = swept_columns(x, y, to_x, to_y, side, reach, row)
            for column in range(max(first, 0), min(last, columns - 1) + 1):
                counts[row, column] += change


def unswept(need: Mask, lines: list[NDArray[np.float64]], radius: float) -> Mask:
    """Return the needed cells that no line, float64 [n, 2], sweeps; bool [rows, columns]."""
    counts = np.zeros(need.shape, np.int16)
    for line in lines:
        sweep(counts, line, radius, 1)
    left: Mask = need & (counts == 0)
    return left


@njit(cache=True, nogil=True)
def newly_swept(
    need: Mask, counts: Counts, x: float, y: float, to_x: float, to_y: float, radius: float
) -> int:
    """Return how many needed cells within ``radius`` of a leg nothing has swept yet."""
    rows, columns = counts.shape
    reach = radius + 1e-7
    found = 0
    side = side_of(x, y, to_x, to_y, reach)
    first_row = max(math.ceil(min(y, to_y) - reach), 0)
    last_row = min(math.floor(max(y, to_y) + reach), rows - 1)
    for row in range(first_row, last_row + 1):
        first, last = swept_columns(x, y, to_x, to_y, side, reach, row)
        for column in range(max(first, 0), min(last, columns - 1) + 1):
            if need[row, column] and counts[row, column] == 0:
                found += 1
    return found


@njit(cache=True, nogil=True)
def way_fits(fits: Mask, x: float, y: float, to_x: float, to_y: float) -> bool:
    """Whether the middle may go straight from one point to another.

    The way must run between centres that fit; then it is at most the sagitta of a step of one cell,
    ``1 / (8 * reach)`` cells, nearer to a corner than the centres are.
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
