"""Growing masks and numbering their regions: compiled.

OpenCV does both, but costs each process that loads it 100 MB (ADR 4).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]


def dilated(mask: Mask, reach: Mask) -> Mask:
    """Return ``mask`` grown: a cell is true where ``reach``, laid over it, meets a true cell.

    Both bool; ``reach`` is [2 n + 1, 2 n + 1], symmetric, true in its middle.
    """
    grown = mask.copy()
    offsets = np.argwhere(reach) - reach.shape[0] // 2
    _stamp(mask, np.ascontiguousarray(offsets.astype(np.int32)), grown)
    return grown


def numbered_regions(mask: Mask) -> Labels:
    """Return the regions of true cells connected over sides, numbered from 1; 0 elsewhere."""
    labels: Labels = np.zeros(mask.shape, np.int32)
    _number(np.ascontiguousarray(mask), labels)
    return labels


@njit(cache=True, nogil=True)
def _stamp(mask: Mask, offsets: NDArray[np.int32], grown: Mask) -> None:
    """Set the cells around true cells; inner ones, with true cells on all sides, add nothing new.

    That holds for reaches without dents, whose cells' neighbours towards the middle are in it too.
    """
    rows, columns = mask.shape
    for row in range(rows):
        for column in range(columns):
            if not mask[row, column] or _is_inner(mask, row, column):
                continue
            for index in range(offsets.shape[0]):
                at_row = row + offsets[index, 0]
                at_column = column + offsets[index, 1]
                if 0 <= at_row < rows and 0 <= at_column < columns:
                    grown[at_row, at_column] = True


@njit(cache=True, nogil=True)
def _is_inner(mask: Mask, row: int, column: int) -> bool:
    rows, columns = mask.shape
    return (
        (row == 0 or mask[row - 1, column])
        and (row == rows - 1 or mask[row + 1, column])
        and (column == 0 or mask[row, column - 1])
        and (column == columns - 1 or mask[row, column + 1])
    )


@njit(cache=True, nogil=True)
def root_of(parents: Labels, label: int) -> int:
    """Return the first of the labels that were joined; shortens the way to it (union-find)."""
    while parents[label] != label:
        parents[label] = parents[parents[label]]
        label = parents[label]
    return label


@njit(cache=True, nogil=True)
def _number(mask: Mask, labels: Labels) -> None:
    """Two passes with union-find; the numbers are in the order of the regions' first cells."""
    rows, columns = mask.shape
    parents = np.zeros(rows * columns // 2 + 2, np.int32)
    count = 0
    for row in range(rows):
        for column in range(columns):
            if not mask[row, column]:
                continue
            above = labels[row - 1, column] if row > 0 else 0
            before = labels[row, column - 1] if column > 0 else 0
            if above == 0 and before == 0:
                count += 1
                parents[count] = count
                labels[row, column] = count
            elif above == 0 or before == 0:
                labels[row, column] = max(above, before)
            else:
                low, high = root_of(parents, above), root_of(parents, before)
                parents[max(low, high)] = min(low, high)
                labels[row, column] = min(low, high)
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
