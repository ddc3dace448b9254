"""Straight walls that lie oblique on a map's grid: where they are within the cells.

A map tells how much of each cell is solid. From these shares follows the wall's height in each of
neighbouring cells, to some millimetres. If the heights lie along a line, the wall is that line, and
the part of the cells before it is floor.

Lengths and places in cells of the map: whole numbers are the cells' sides.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask
from roomba.compilation import allocating_entry, inner_part
from roomba.grid import FREE, OCCUPIED, OccupancyMap

_WINDOW: Final = 7
"""Columns over which a wall must be straight: 35 cm."""
_OFF: Final = 0.1
"""Tolerance of a wall's heights against the line, and of shares against those that it gives."""
_MARGIN: Final = 0.2
"""So much before a wall counts as solid: more than the errors of shares and of the robot's pose."""
_FLATTEST, _STEEPEST = 0.03, 1.05
"""Slopes: a flatter wall has no steps, and a steeper one is found along the other axis."""


def has_shares(map: OccupancyMap) -> bool:
    """Whether any cell of a map is solid in part."""
    return bool(((map.values > FREE) & (map.values < OCCUPIED)).any())


def solid_parts(map: OccupancyMap, parts: int) -> Mask:
    """Return the solid parts, on a grid with ``parts`` x ``parts`` of each of the map's cells.

    Bool [parts * rows, parts * columns]. Cells that are solid in part count in full, but for the
    parts that lie clear of straight walls.
    """
    solid = np.repeat(np.repeat(map.solid, parts, axis=0), parts, axis=1)
    if not has_shares(map):
        return solid
    shares = np.where(map.values < FREE, 1.0, map.values / OCCUPIED)
    floor = _floor_above(shares, parts)
    floor |= _floor_above(np.ascontiguousarray(shares[::-1]), parts)[::-1]
    floor |= _floor_above(np.ascontiguousarray(shares.T), parts).T
    floor |= _floor_above(np.ascontiguousarray(shares.T[::-1]), parts)[::-1].T
    return solid & ~floor


@allocating_entry
def _floor_above(shares: Floats, parts: int) -> Mask:
    """Return the parts of cells that are floor above a straight wall, which is in lower rows.

    ``shares``, float64 [rows, columns], is how much of each cell is solid, 0..1.
    """
    rows, columns = shares.shape
    floor = np.zeros((rows * parts, columns * parts), np.bool_)
    tops, heights = np.empty(_WINDOW, np.int64), np.empty(_WINDOW)
    for row in range(1, rows - 1):
        for column in range(columns - _WINDOW + 1):
            if not _find_tops(shares, row, column, tops, heights):
                continue
            middle, slope = _line(heights)
            is_aslant = _FLATTEST <= abs(slope) <= _STEEPEST
            if is_aslant and _is_along(shares, column, tops, heights, middle, slope):
                _free(floor, parts, column, tops, middle, slope)
    return floor


@inner_part
def _find_tops(
    shares: Floats, row: int, column: int, tops: NDArray[np.int64], heights: Floats
) -> bool:
    """Follow the top of the solid cells over a window of columns; return whether it goes on so far.

    ``tops`` gets the highest rows that are not free, ``heights`` the mean height in each column.
    A top of full cells alone returns False, too.
    """
    rows = len(shares)
    is_partly = False
    for step in range(_WINDOW):
        at = column + step
        found = False
        for near in (0, 1, -1):
            if 1 <= row + near < rows - 1 and _is_top(shares, row + near, at):
                row, found = row + near, True
                break
        if not found:
            return False
        tops[step], heights[step] = row, row - 1 + shares[row, at] + shares[row - 1, at]
        is_partly |= shares[row, at] < 1.0
    return is_partly


@inner_part
def _is_top(shares: Floats, row: int, column: int) -> bool:
    is_top: bool = shares[row, column] > 0.0 and shares[row + 1, column] == 0.0
    return is_top


@inner_part
def _line(heights: Floats) -> tuple[float, float]:
    """Return the line nearest to heights of columns: its height in the middle, and its slope."""
    total, moment, squares = 0.0, 0.0, 0.0
    for step in range(_WINDOW):
        aside = step - 0.5 * (_WINDOW - 1)
        total += heights[step]
        moment += aside * heights[step]
        squares += aside * aside
    return total / _WINDOW, moment / squares


@inner_part
def _is_along(
    shares: Floats,
    column: int,
    tops: NDArray[np.int64],
    heights: Floats,
    middle: float,
    slope: float,
) -> bool:
    """Whether all heights, and the shares from which they follow, fit a wall along a line."""
    for step in range(_WINDOW):
        height = middle + (step - 0.5 * (_WINDOW - 1)) * slope
        if abs(heights[step] - height) > _OFF:
            return False
        for row in (tops[step], tops[step] - 1):
            share = _share_below(height - 0.5 * slope - row, height + 0.5 * slope - row)
            if abs(shares[row, column + step] - share) > _OFF:
                return False
    return True


@inner_part
def _share_below(left: float, right: float) -> float:
    """Return how much of a cell is below a line, whose heights at its sides are given."""
    if abs(right - left) < 1e-9:
        return min(max(left, 0.0), 1.0)
    return (_area_up_to(right) - _area_up_to(left)) / (right - left)


@inner_part
def _area_up_to(height: float) -> float:
    """Return the integral of the share of a cell below a height, from 0 to ``height``."""
    if height <= 0.0:
        return 0.0
    return 0.5 * height * height if height <= 1.0 else height - 0.5


@inner_part
def _free(
    floor: Mask, parts: int, column: int, tops: NDArray[np.int64], middle: float, slope: float
) -> None:
    """Mark the parts of the top cells that lie clear above a line, but for the outermost cells.

    In these a corner may begin that their shares hardly show.
    """
    clear = _MARGIN * math.sqrt(1.0 + slope * slope)
    for step in range(1, _WINDOW - 1):
        for part in range(parts):
            left = middle + (step + part / parts - 0.5 * _WINDOW) * slope
            highest = max(left, left + slope / parts) + clear
            first = math.ceil(parts * highest - 1e-6)
            for row in range(max(first, parts * (tops[step] - 1)), parts * (tops[step] + 1)):
                floor[row, parts * (column + step) + part] = True
