"""Compiled steps over the cells of a floor: clearing things, growing labels, touching labels.

Grids are [rows, columns]; lengths in cells; label 0 is nothing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, allocating_part, entry

Labels = NDArray[np.int32]


@allocating_entry
def clear_small_things(solid: Mask, longest: int) -> None:
    """Free small groups of true cells that are connected over sides and corners.

    Small are groups of up to ``longest`` rows and columns. Groups that reach the border of the grid
    stay.
    """
    rows, columns = solid.shape
    seen = np.zeros(solid.shape, np.bool_)
    queue = np.empty(solid.size, np.int32)
    for start in range(solid.size):
        row, column = start // columns, start % columns
        if not solid[row, column] or seen[row, column]:
            continue
        seen[row, column] = True
        queue[0] = start
        count, next_ = 1, 0
        low, high, left, right = row, row, column, column
        while next_ < count:
            row, column = queue[next_] // columns, queue[next_] % columns
            next_ += 1
            low, high = min(low, row), max(high, row)
            left, right = min(left, column), max(right, column)
            for near_row in range(max(0, row - 1), min(rows, row + 2)):
                for near_column in range(max(0, column - 1), min(columns, column + 2)):
                    if solid[near_row, near_column] and not seen[near_row, near_column]:
                        seen[near_row, near_column] = True
                        queue[count] = near_row * columns + near_column
                        count += 1
        is_inside = low > 0 and left > 0 and high < rows - 1 and right < columns - 1
        if is_inside and high - low < longest and right - left < longest:
            for index in range(count):
                solid[queue[index] // columns, queue[index] % columns] = False


@allocating_entry
def grow(labels: Labels, allowed: Mask, reach: int) -> None:
    """Give unlabelled ``allowed`` cells the label from which the fewest steps lead to them.

    Steps lead over sides of cells; cells more than ``reach`` steps away stay unlabelled.
    """
    rows, columns = labels.shape
    queue = np.empty(labels.size, np.int32)
    steps = np.zeros(labels.shape, np.int32)
    count, next_ = 0, 0
    for cell in range(labels.size):
        if labels[cell // columns, cell % columns] > 0:
            queue[count] = cell
            count += 1
    while next_ < count:
        row, column = queue[next_] // columns, queue[next_] % columns
        next_ += 1
        if steps[row, column] >= reach:
            continue
        for side in range(4):
            to_row = row + (side == 0) - (side == 1)
            to_column = column + (side == 2) - (side == 3)
            if not (0 <= to_row < rows and 0 <= to_column < columns):
                continue
            if allowed[to_row, to_column] and labels[to_row, to_column] == 0:
                labels[to_row, to_column] = labels[row, column]
                steps[to_row, to_column] = steps[row, column] + 1
                queue[count] = to_row * columns + to_column
                count += 1


@allocating_entry
def connected_parts(labels: Labels) -> Labels:
    """Return the parts of labelled regions that are connected over sides, numbered from 1."""
    rows, columns = labels.shape
    parts = np.zeros(labels.shape, np.int32)
    queue = np.empty(labels.size, np.int32)
    number = 0
    for start in range(labels.size):
        row, column = start // columns, start % columns
        label = labels[row, column]
        if label == 0 or parts[row, column] > 0:
            continue
        number += 1
        parts[row, column] = number
        queue[0] = start
        count, next_ = 1, 0
        while next_ < count:
            row, column = queue[next_] // columns, queue[next_] % columns
            next_ += 1
            for side in range(4):
                to_row = row + (side == 0) - (side == 1)
                to_column = column + (side == 2) - (side == 3)
                if not (0 <= to_row < rows and 0 <= to_column < columns):
                    continue
                if labels[to_row, to_column] == label and parts[to_row, to_column] == 0:
                    parts[to_row, to_column] = number
                    queue[count] = to_row * columns + to_column
                    count += 1
    return parts


@allocating_entry
def contacts(labels: Labels) -> NDArray[np.int32]:
    """Return where regions touch over a side: int32 [n, 5] of lower and higher label, place.

    A place is the row and column of one of the two cells, and the number, from 0, of the opening.
    Contacts of the same two regions that are up to two cells apart are one opening.
    """
    rows, columns = labels.shape
    found = np.empty((0, 5), np.int32)
    at = np.full(labels.shape, -1, np.int32)
    for attempt in range(2):
        count = 0
        for row in range(rows):
            for column in range(columns):
                label = labels[row, column]
                if label == 0:
                    continue
                beside = labels[row, column + 1] if column + 1 < columns else 0
                above = labels[row + 1, column] if row + 1 < rows else 0
                other = above if above != 0 and above != label else beside
                if other == 0 or other == label:
                    continue
                if attempt == 1:
                    found[count, 0] = min(label, other)
                    found[count, 1] = max(label, other)
                    found[count, 2] = row
                    found[count, 3] = column
                    found[count, 4] = -1
                    at[row, column] = count
                count += 1
        if attempt == 0:
            found = np.empty((count, 5), np.int32)
    _number_openings(found, at)
    return found


@allocating_part
def _number_openings(found: NDArray[np.int32], at: Labels) -> None:
    rows, columns = at.shape
    queue = np.empty(found.shape[0], np.int32)
    openings = 0
    for start in range(found.shape[0]):
        if found[start, 4] >= 0:
            continue
        found[start, 4] = openings
        queue[0] = start
        count, next_ = 1, 0
        while next_ < count:
            index = queue[next_]
            next_ += 1
            row, column = found[index, 2], found[index, 3]
            for near_row in range(max(0, row - 2), min(rows, row + 3)):
                for near_column in range(max(0, column - 2), min(columns, column + 3)):
                    near = at[near_row, near_column]
                    if near < 0 or found[near, 4] >= 0:
                        continue
                    if found[near, 0] == found[index, 0] and found[near, 1] == found[index, 1]:
                        found[near, 4] = openings
                        queue[count] = near
                        count += 1
        openings += 1


@entry
def draw_line(mask: Mask, row: int, column: int, to_row: int, to_column: int) -> None:
    """Set the cells from one cell to another, so that no step over a side leads across."""
    steps = max(abs(to_row - row), abs(to_column - column))
    for step in range(steps + 1):
        share = step / steps if steps else 0.0
        at_row = int(np.floor(row + share * (to_row - row) + 0.5))
        at_column = int(np.floor(column + share * (to_column - column) + 0.5))
        if 0 <= at_row < mask.shape[0] and 0 <= at_column < mask.shape[1]:
            mask[at_row, at_column] = True


@allocating_entry
def border_counts(
    labels: Labels, unknown: Mask, count: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return how many sides of each label's cells border on unknown and on other unlabelled cells.

    Both int64 [count + 1], by label; the outside of the grid is unknown.
    """
    rows, columns = labels.shape
    to_unknown = np.zeros(count + 1, np.int64)
    to_known = np.zeros(count + 1, np.int64)
    for row in range(rows):
        for column in range(columns):
            label = labels[row, column]
            if label == 0:
                continue
            for side in range(4):
                to_row = row + (side == 0) - (side == 1)
                to_column = column + (side == 2) - (side == 3)
                if not (0 <= to_row < rows and 0 <= to_column < columns):
                    to_unknown[label] += 1
                elif labels[to_row, to_column] == 0:
                    if unknown[to_row, to_column]:
                        to_unknown[label] += 1
                    else:
                        to_known[label] += 1
    return to_unknown, to_known
