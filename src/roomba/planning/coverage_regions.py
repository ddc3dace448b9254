"""Stage regions: cuts the floor at its narrow places, so that each part is swept its own way."""

from __future__ import annotations

import numpy as np
from numba import njit

from roomba.distance import distance_to_nearest
from roomba.mask_kernels import Labels, Mask, numbered_regions

_BLOCK = 5
"""Cells to a side of the blocks that are told apart."""
_NARROW = 6.0
"""Blocks from the middle of a place to its sides: a narrower one parts the floor."""
_SMALL = 300
"""Blocks; parts with a smaller wide place are no parts of their own."""


def regions(floor: Mask) -> Labels:
    """Return the number of the region of each cell of ``floor``, int32 [rows, columns]; 0: none.

    A region is a connected wide place with all that is nearer to it than to other wide places, or
    connected floor without any.
    """
    rows, columns = floor.shape
    padded = np.pad(floor, ((0, -rows % _BLOCK), (0, -columns % _BLOCK)))
    parts = padded.reshape(padded.shape[0] // _BLOCK, _BLOCK, padded.shape[1] // _BLOCK, _BLOCK)
    middles = parts[:, _BLOCK // 2, :, _BLOCK // 2]
    wide = numbered_regions(distance_to_nearest(~middles) > _NARROW)
    sizes = np.bincount(wide.ravel())
    wide[(sizes < _SMALL)[wide]] = 0
    _spread(parts.any(axis=(1, 3)), wide)
    fine = np.repeat(np.repeat(wide, _BLOCK, axis=0), _BLOCK, axis=1)[:rows, :columns]
    labels: Labels = np.zeros(floor.shape, np.int32)
    _number(floor, fine, labels)
    return labels


@njit(cache=True, nogil=True)
def _spread(floor: Mask, labels: Labels) -> None:
    """Give each unnumbered cell of the floor the number that is the fewest steps away."""
    rows, columns = floor.shape
    queue = np.empty((floor.size, 2), np.int32)
    size = 0
    for row in range(rows):
        for column in range(columns):
            if labels[row, column] > 0:
                queue[size, 0], queue[size, 1] = row, column
                size += 1
    head = 0
    while head < size:
        at_row, at_column = np.int64(queue[head, 0]), np.int64(queue[head, 1])
        head += 1
        for to_row, to_column in (
            (at_row - 1, at_column),
            (at_row + 1, at_column),
            (at_row, at_column - 1),
            (at_row, at_column + 1),
        ):
            if (
                0 <= to_row < rows
                and 0 <= to_column < columns
                and floor[to_row, to_column]
                and labels[to_row, to_column] == 0
            ):
                labels[to_row, to_column] = labels[at_row, at_column]
                queue[size, 0], queue[size, 1] = to_row, to_column
                size += 1


@njit(cache=True, nogil=True)
def _number(floor: Mask, kinds: Labels, labels: Labels) -> None:
    """Number the floor that is connected over sides and of one kind, in the order of cells."""
    rows, columns = floor.shape
    stack = np.empty((floor.size + 1, 2), np.int32)
    count = 0
    for row in range(rows):
        for column in range(columns):
            if not floor[row, column] or labels[row, column] > 0:
                continue
            count += 1
            labels[row, column] = count
            stack[0, 0], stack[0, 1] = row, column
            size = 1
            while size > 0:
                size -= 1
                at_row, at_column = np.int64(stack[size, 0]), np.int64(stack[size, 1])
                for to_row, to_column in (
                    (at_row - 1, at_column),
                    (at_row + 1, at_column),
                    (at_row, at_column - 1),
                    (at_row, at_column + 1),
                ):
                    if (
                        0 <= to_row < rows
                        and 0 <= to_column < columns
                        and floor[to_row, to_column]
                        and labels[to_row, to_column] == 0
                        and kinds[to_row, to_column] == kinds[at_row, at_column]
                    ):
                        labels[to_row, to_column] = count
                        stack[size, 0], stack[size, 1] = to_row, to_column
                        size += 1
