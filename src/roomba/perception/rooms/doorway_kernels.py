"""Compiled search for narrow places: basins of the distance to walls, and the walls at openings.

Grids are [rows, columns]; lengths in cells; ``clearance`` is the distance to the nearest wall.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, allocating_part, entry, inner_part
from roomba.raster.regions import root_of

Labels = NDArray[np.int32]
Clearance = NDArray[np.float32]

_OPPOSITE = -0.5
"""Cosine: the second end of an opening is more than 120 degrees away from the first."""
NOWHERE = 1e9
"""Cells; the distance to something that was not found."""


@allocating_entry
def flood_basins(
    order: NDArray[np.int64], clearance: Clearance, least_step: float, basins: Labels
) -> NDArray[np.float32]:
    """Number the basins around the widest places; return the clearance there, by number.

    ``order`` are the flat indices of the cells to flood, widest first; ``basins`` is 0 at first,
    and stays 0 in cells that are not flooded. Two basins that meet become one if the clearance at
    the smaller peak exceeds that at the meeting place by less than ``least_step``.
    """
    rows, columns = clearance.shape
    parents = np.zeros(order.size + 1, np.int32)
    peaks = np.zeros(order.size + 1, np.float32)
    count = 0
    for cell in order:
        row, column = cell // columns, cell % columns
        here = clearance[row, column]
        joined, widest = 0, np.float32(-1.0)
        for near_row in range(max(0, row - 1), min(rows, row + 2)):
            for near_column in range(max(0, column - 1), min(columns, column + 2)):
                if basins[near_row, near_column] > 0 and clearance[near_row, near_column] > widest:
                    widest = clearance[near_row, near_column]
                    joined = root_of(parents, basins[near_row, near_column])
        if joined == 0:
            count += 1
            parents[count], peaks[count] = count, here
            joined = count
        for near_row in range(max(0, row - 1), min(rows, row + 2)):
            for near_column in range(max(0, column - 1), min(columns, column + 2)):
                if basins[near_row, near_column] == 0:
                    continue
                other = root_of(parents, basins[near_row, near_column])
                if other != joined and min(peaks[other], peaks[joined]) - here < least_step:
                    if peaks[other] > peaks[joined]:
                        joined, other = other, joined
                    parents[other] = joined
        basins[row, column] = joined
    return _renumbered(basins, parents, peaks, count)


@allocating_part
def _renumbered(
    basins: Labels, parents: Labels, peaks: NDArray[np.float32], count: int
) -> NDArray[np.float32]:
    numbers = np.zeros(count + 1, np.int32)
    kept = 0
    for label in range(1, count + 1):
        if parents[label] == label:
            kept += 1
            numbers[label] = kept
    kept_peaks = np.zeros(kept + 1, np.float32)
    for label in range(1, count + 1):
        if parents[label] == label:
            kept_peaks[numbers[label]] = peaks[label]
    for row in range(basins.shape[0]):
        for column in range(basins.shape[1]):
            if basins[row, column] > 0:
                basins[row, column] = numbers[root_of(parents, basins[row, column])]
    return kept_peaks


@entry
def opening_at(solid: Mask, row: int, column: int, clearance: float) -> tuple[int, int, int, int]:
    """Return row and column of the nearest solid cell, and of the nearest on the other side.

    ``row``, ``column`` lies in a passage, ``clearance`` away from the first solid cell. If there is
    no second one within twice the clearance, all four are -1.
    """
    reach = math.ceil(2.0 * clearance) + 1
    low, high = max(0, row - reach), min(solid.shape[0], row + reach + 1)
    left, right = max(0, column - reach), min(solid.shape[1], column + reach + 1)
    first_row, first_column, nearest = -1, -1, NOWHERE
    for at_row in range(low, high):
        for at_column in range(left, right):
            if solid[at_row, at_column]:
                distance = math.hypot(at_row - row, at_column - column)
                if distance < nearest:
                    first_row, first_column, nearest = at_row, at_column, distance
    if first_row < 0 or nearest == 0.0:
        return -1, -1, -1, -1
    to_row, to_column = (first_row - row) / nearest, (first_column - column) / nearest
    second_row, second_column, second = -1, -1, NOWHERE
    for at_row in range(low, high):
        for at_column in range(left, right):
            if solid[at_row, at_column]:
                distance = math.hypot(at_row - row, at_column - column)
                along = (at_row - row) * to_row + (at_column - column) * to_column
                if distance < second and along < _OPPOSITE * distance:
                    second_row, second_column, second = at_row, at_column, distance
    if second_row < 0:
        return -1, -1, -1, -1
    return first_row, first_column, second_row, second_column


@allocating_entry
def wall_thicknesses(
    solid: Mask,
    row: int,
    column: int,
    to_row: int,
    to_column: int,
    look: int,
    jamb: float,
) -> tuple[float, float]:
    """Return how thick the wall is at either end of an opening, NOWHERE if it does not end there.

    The ends are solid cells. On the way through the middle of the opening, up to ``look`` to either
    side, the wall ends where the floor is wider by ``jamb`` on that end. The thickness is the way
    between the two places where it ends.
    """
    length = math.hypot(to_row - row, to_column - column)
    if length == 0.0:
        return NOWHERE, NOWHERE
    along_row, along_column = (to_row - row) / length, (to_column - column) / length
    middle_row, middle_column = (row + to_row) / 2.0, (column + to_column) / 2.0
    thickness = np.zeros(2, np.float64)
    for side in (1.0, -1.0):
        for end in range(2):
            way = 2.0 * end - 1.0
            found = NOWHERE
            for step in range(look + 1):
                at_row = middle_row + side * step * along_column
                at_column = middle_column - side * step * along_row
                if _is_solid(solid, at_row, at_column):
                    break
                if _is_free_along(
                    solid, at_row, at_column, way * along_row, way * along_column,
                    length / 2.0 - 0.5 + jamb,
                ):  # fmt: skip
                    found = float(step)
                    break
            thickness[end] += found
    return thickness[0], thickness[1]


@inner_part
def _is_free_along(
    solid: Mask, row: float, column: float, row_step: float, column_step: float, length: float
) -> bool:
    for half_step in range(math.floor(2.0 * length) + 1):
        way = 0.5 * half_step
        if _is_solid(solid, row + way * row_step, column + way * column_step):
            return False
    return True


@inner_part
def _is_solid(solid: Mask, row: float, column: float) -> bool:
    at_row, at_column = math.floor(row + 0.5), math.floor(column + 0.5)
    if not (0 <= at_row < solid.shape[0] and 0 <= at_column < solid.shape[1]):
        return True
    return bool(solid[at_row, at_column])


@allocating_entry
def gaps(
    solid: Mask, narrowest: float, widest: float, thickest: int, jamb: float
) -> NDArray[np.int32]:
    """Return gaps between two ends of walls: int32 [n, 5].

    A row has row and column of both solid cells, and the sum of both walls' thicknesses, see
    :func:`wall_thicknesses`. The cells are corners that see each other, with ``narrowest`` to
    ``widest`` between them. A doorway is found several times, as ends of walls have several
    corners.
    """
    corners = _corners(solid)
    found = np.empty((64, 5), np.int32)
    count = 0
    for index in range(corners.shape[0]):
        row, column = corners[index]
        for other in range(index + 1, corners.shape[0]):
            to_row, to_column = corners[other]
            if to_row - row > widest + 1.0:
                break
            width = math.hypot(to_row - row, to_column - column) - 1.0
            if not narrowest <= width <= widest:
                continue
            if not _sees(solid, row, column, to_row, to_column):
                continue
            ends = wall_thicknesses(solid, row, column, to_row, to_column, thickest, jamb)
            if max(ends) > thickest:
                continue
            if count == found.shape[0]:
                found = np.concatenate((found, np.empty_like(found)))
            found[count, 0], found[count, 1] = row, column
            found[count, 2], found[count, 3] = to_row, to_column
            found[count, 4] = ends[0] + ends[1]
            count += 1
    return found[:count]


@allocating_part
def _corners(solid: Mask) -> NDArray[np.int32]:
    """Return the solid cells with free cells above or below and beside, in the order of rows."""
    rows, columns = solid.shape
    corners = np.empty((0, 2), np.int32)
    for attempt in range(2):
        count = 0
        for row in range(1, rows - 1):
            for column in range(1, columns - 1):
                is_end = not (solid[row - 1, column] and solid[row + 1, column])
                is_side = not (solid[row, column - 1] and solid[row, column + 1])
                if solid[row, column] and is_end and is_side:
                    if attempt == 1:
                        corners[count, 0], corners[count, 1] = row, column
                    count += 1
        if attempt == 0:
            corners = np.empty((count, 2), np.int32)
    return corners


@inner_part
def _sees(solid: Mask, row: int, column: int, to_row: int, to_column: int) -> bool:
    """Whether all cells on the line between two cells are free."""
    length = math.hypot(to_row - row, to_column - column)
    row_step, column_step = (to_row - row) / length, (to_column - column) / length
    return _is_free_along(
        solid, row + row_step, column + column_step, row_step, column_step, length - 2.0
    )
