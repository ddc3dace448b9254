"""Growing masks and numbering their regions: compiled.

OpenCV does both, but costs each process that loads it 100 MB (ADR 4).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, entry, part

Labels = NDArray[np.int32]


def dilated(mask: Mask, reach: Mask) -> Mask:
    """Return ``mask`` grown: a cell is true where ``reach``, laid over it, meets a true cell.

    Both bool; ``reach`` is [2 n + 1, 2 n + 1], symmetric, true in its middle and without dents.
    """
    grown = np.empty(mask.shape, np.bool_)
    heights = ((reach.sum(axis=0) - 1) // 2).astype(np.int16)
    _grow(np.ascontiguousarray(mask), heights, int(heights.max()) + 1, grown)
    return grown


def numbered_regions(mask: Mask, *, by_corners: bool = False) -> Labels:
    """Return the regions of true cells connected over sides, numbered from 1; 0 elsewhere.

    ``by_corners`` they are connected over corners as well.
    """
    labels: Labels = np.zeros(mask.shape, np.int32)
    _number(np.ascontiguousarray(mask), by_corners, labels)
    return labels


def large_regions(mask: Mask, resolution: float, least: float, *, by_corners: bool = False) -> Mask:
    """Return the true cells, ``resolution`` m wide, in regions of ``least`` m2 or more.

    Regions are those of :func:`numbered_regions`.
    """
    labels = numbered_regions(mask, by_corners=by_corners)
    is_large = np.bincount(labels.ravel()) * resolution**2 >= least
    is_large[0] = False
    return np.asarray(is_large[labels])


@allocating_entry
def _grow(mask: Mask, heights: NDArray[np.int16], most: int, grown: Mask) -> None:
    """Set the cells that have a true cell near enough in their column or one beside it.

    ``heights`` [2 n + 1] is how far the reach goes up and down, in each of its columns, less than
    ``most``; -1 where it is empty.
    """
    rows, columns = mask.shape
    away = np.empty((rows, columns), np.int16)
    cells_along_columns(mask, most, away)
    aside = heights.size // 2
    grown[:] = False
    for row in range(rows):
        for index in range(heights.size):
            right, height = index - aside, heights[index]
            # Slices of one length let the compiler vectorize over columns.
            beside = away[row, max(right, 0) : max(columns + right, 0)]
            into = grown[row, max(-right, 0) : max(columns - right, 0)]
            for column in range(min(beside.size, into.size)):
                into[column] |= beside[column] <= height


@part
def cells_along_columns(mask: Mask, most: int, away: NDArray[np.int16]) -> None:
    """Write how many cells it is to the nearest true one of the same column, at most ``most``."""
    rows, columns = mask.shape
    for column in range(columns):
        away[0, column] = 0 if mask[0, column] else most
    for row in range(1, rows):
        for column in range(columns):
            on = min(away[row - 1, column] + 1, most)
            away[row, column] = 0 if mask[row, column] else on
    for row in range(rows - 2, -1, -1):
        for column in range(columns):
            away[row, column] = min(away[row, column], away[row + 1, column] + 1)


@entry
def root_of(parents: Labels, label: int) -> int:
    """Return the first of the labels that were joined; shortens the way to it (union-find)."""
    while parents[label] != label:
        parents[label] = parents[parents[label]]
        label = parents[label]
    return label


@entry
def join(parents: Labels, one: int, other: int) -> int:
    """Make the regions of two labels one; return the first of its labels (union-find)."""
    low, high = root_of(parents, one), root_of(parents, other)
    parents[max(low, high)] = min(low, high)
    return min(low, high)


@allocating_entry
def _number(mask: Mask, by_corners: bool, labels: Labels) -> None:
    """Number the regions in two passes with union-find, in the order of their first cells."""
    rows, columns = mask.shape
    parents = np.zeros(rows * columns // 2 + 2, np.int32)
    count = 0
    for row in range(rows):
        for column in range(columns):
            if not mask[row, column]:
                continue
            above = labels[row - 1, column] if row > 0 else 0
            before = labels[row, column - 1] if column > 0 else 0
            if by_corners and above == 0 and row > 0:
                # If the cell above is true, these two belong to its region already.
                if before == 0 and column > 0:
                    before = labels[row - 1, column - 1]
                if column + 1 < columns:
                    above = labels[row - 1, column + 1]
            if above == 0 and before == 0:
                count += 1
                parents[count] = count
                labels[row, column] = count
            elif above == 0 or before == 0:
                labels[row, column] = max(above, before)
            else:
                labels[row, column] = join(parents, above, before)
    numbers = np.zeros(count + 1, np.int32)
    regions = 0
    for label in range(1, count + 1):
        root = root_of(parents, label)
        if root == label:
            regions += 1
            numbers[label] = regions
        else:
            numbers[label] = numbers[root]
    for row in range(rows):
        for column in range(columns):
            labels[row, column] = numbers[labels[row, column]]
