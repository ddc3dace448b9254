"""Stage regions: cuts the floor at its narrow places, so that each part is swept its own way."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, entry
from roomba.raster.distance import distance_to_nearest
from roomba.raster.growing import with_room
from roomba.raster.regions import Labels, join, numbered_regions, root_of

_BLOCK = 5
"""Side of a block, in cells: the floor is cut into regions block by block."""


class Regions(NamedTuple):
    """Floor in parts, each given by runs of cells along rows.

    ``runs`` int32 [n, 4]: row, first and last column, and number of the region, from 0 on, row by
    row. ``bounds`` int64 [regions, 4]: first and last row and column of each. ``sizes`` int64
    [regions], cells.
    """

    runs: NDArray[np.int32]
    bounds: NDArray[np.int64]
    sizes: NDArray[np.int64]


def regions(floor: Mask, narrow: float, least: int) -> Regions:
    """Return the regions of ``floor``, bool [rows, columns], numbered by their first cells.

    A place is wide if it is more than ``narrow`` blocks of 5 cells away from the edge of the floor.
    A region is a connected wide place of ``least`` blocks or more, with all floor that is nearer to
    it than to other wide places, or connected floor without a wide place.
    """
    shape = (-(-floor.shape[0] // _BLOCK), -(-floor.shape[1] // _BLOCK))
    middles, blocks = np.zeros(shape, np.bool_), np.zeros(shape, np.bool_)
    _to_blocks(floor, middles, blocks)
    wide = numbered_regions(distance_to_nearest(~middles) > narrow)
    sizes = np.bincount(wide.ravel())
    wide[(sizes < least)[wide]] = 0
    _spread(blocks, wide)
    found: Regions = _joined(_runs(floor, wide))
    return found


@entry
def _to_blocks(floor: Mask, middles: Mask, blocks: Mask) -> None:
    """Write which blocks have floor in their middle, and which have any."""
    rows, columns = floor.shape
    for row in range(rows):
        at_row = row // _BLOCK
        for at_column in range(blocks.shape[1]):
            for column in range(at_column * _BLOCK, min((at_column + 1) * _BLOCK, columns)):
                if floor[row, column]:
                    blocks[at_row, at_column] = True
                    break
    half = _BLOCK // 2
    for at_row in range((rows - half + _BLOCK - 1) // _BLOCK):
        for at_column in range((columns - half + _BLOCK - 1) // _BLOCK):
            middles[at_row, at_column] = floor[at_row * _BLOCK + half, at_column * _BLOCK + half]


@allocating_entry
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


@allocating_entry
def _runs(floor: Mask, kinds: Labels) -> NDArray[np.int32]:
    """Return the runs of floor of one kind: row, first and last column, and kind; row by row."""
    rows, columns = floor.shape
    runs = np.empty((4096, 4), np.int32)
    size = 0
    for row in range(rows):
        if size + columns > len(runs):
            runs = with_room(runs, size, 2 * len(runs) + columns)
        kind = np.int32(-1)
        for at_column in range(kinds.shape[1]):
            here = kinds[row // _BLOCK, at_column]
            for column in range(at_column * _BLOCK, min((at_column + 1) * _BLOCK, columns)):
                if not floor[row, column]:
                    kind = np.int32(-1)
                    continue
                if kind != here:
                    kind = here
                    runs[size, 0], runs[size, 1], runs[size, 3] = row, column, here
                    size += 1
                runs[size - 1, 2] = column
    return runs[:size]


@allocating_entry
def _joined(runs: NDArray[np.int32]) -> Regions:
    """Number the runs that are connected over sides and of one kind."""
    count = len(runs)
    parents = np.arange(count).astype(np.int32)
    above = 0
    for at in range(count):
        row, first, last = runs[at, 0], runs[at, 1], runs[at, 2]
        while runs[above, 0] < row - 1 or (runs[above, 0] == row - 1 and runs[above, 2] < first):
            above += 1
        other = above
        while runs[other, 0] == row - 1 and runs[other, 1] <= last:
            if runs[other, 3] == runs[at, 3]:
                join(parents, other, at)
            other += 1
    regions = 0
    for at in range(count):
        root = root_of(parents, at)
        if root == at:
            runs[at, 3] = regions
            regions += 1
        else:
            runs[at, 3] = runs[root, 3]
    bounds = np.empty((regions, 4), np.int64)
    bounds[:, 0::2] = 1 << 40
    bounds[:, 1::2] = -1
    sizes = np.zeros(regions, np.int64)
    for at in range(count):
        row, first, last, region = runs[at]
        bound = bounds[region]
        bound[0], bound[1] = min(bound[0], row), max(bound[1], row)
        bound[2], bound[3] = min(bound[2], first), max(bound[3], last)
        sizes[region] += last - first + 1
    return Regions(runs, bounds, sizes)


@allocating_entry
def mask_of(found: Regions, region: int) -> Mask:
    """Return a region's cells within its bounds, bool [rows, columns]."""
    top, bottom, left, right = found.bounds[region]
    mask = np.zeros((bottom - top + 1, right - left + 1), np.bool_)
    low, high = 0, len(found.runs)
    while low < high:
        middle = (low + high) // 2
        if found.runs[middle, 0] < top:
            low = middle + 1
        else:
            high = middle
    while low < len(found.runs) and found.runs[low, 0] <= bottom:
        row, first, last, number = found.runs[low]
        if number == region:
            mask[row - top, first - left : last - left + 1] = True
        low += 1
    return mask
