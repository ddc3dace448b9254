"""Compiled walk around the places where the middle fits, and its straightening.

Places in cells: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, inner_part
from roomba.planning.coverage.floor.masks import way_fits
from roomba.raster.growing import with_room

Chain = NDArray[np.int32]
"""Cells, each touching the next, int32 [n, 2] (x, y)."""

_EAST = 0
_STEP_X = (1, 0, -1, 0)
_STEP_Y = (0, 1, 0, -1)
_LEFT_X = (0, -1, -1, 0)
"""From a corner of cells, heading east, north, west or south: the cell ahead on the left."""
_LEFT_Y = (0, 0, -1, -1)


def outlines(mask: Mask) -> list[Chain]:
    """Return the closed chains of true cells along all borders of a mask, true on the left.

    The outermost ones are counter-clockwise. The last cell of a chain touches the first.
    """
    cells, ends = _trace(np.pad(mask, 1))
    return [part - 1 for part in np.split(cells, ends[:-1])] if len(ends) else []


@allocating_entry
def _trace(mask: Mask) -> tuple[Chain, NDArray[np.int64]]:
    """Follow the borders between true and false cells, each from a side that leads east."""
    rows, columns = mask.shape
    followed = np.zeros((rows, columns), np.bool_)
    cells = np.empty((4096, 2), np.int32)
    ends = np.empty(64, np.int64)
    size, chains = 0, 0
    for row in range(1, rows):
        for column in range(columns):
            if not mask[row, column] or mask[row - 1, column] or followed[row, column]:
                continue
            begin = size
            x, y, heading = column, row, _EAST
            while True:
                left_x, left_y = x + _LEFT_X[heading], y + _LEFT_Y[heading]
                if heading == _EAST:
                    if followed[left_y, left_x]:
                        break
                    followed[left_y, left_x] = True
                if size == begin or cells[size - 1, 0] != left_x or cells[size - 1, 1] != left_y:
                    if size == len(cells):
                        cells = with_room(cells, size, 2 * size)
                    cells[size, 0], cells[size, 1] = left_x, left_y
                    size += 1
                x, y = x + _STEP_X[heading], y + _STEP_Y[heading]
                right = (heading + 3) % 4
                if not mask[y + _LEFT_Y[heading], x + _LEFT_X[heading]]:
                    heading = (heading + 1) % 4
                elif mask[y + _LEFT_Y[right], x + _LEFT_X[right]]:
                    heading = right
            while (
                size - begin > 1
                and cells[size - 1, 0] == cells[begin, 0]
                and cells[size - 1, 1] == cells[begin, 1]
            ):
                size -= 1
            if chains == len(ends):
                ends = np.concatenate((ends, np.empty(chains, np.int64)))
            ends[chains] = size
            chains += 1
    return cells[:size], ends[:chains]


@allocating_entry
def straightened(fits: Mask, chain: NDArray[np.float64], tolerance: float) -> NDArray[np.int64]:
    """Return which points of an open chain to keep, ascending int64 [k], both ends among them.

    The straight ways between kept points fit, and pass all other points within ``tolerance`` cells.
    """
    count = len(chain)
    kept = np.ones(count, np.bool_)
    before = np.arange(-1, count - 1)
    after = np.arange(1, count + 1)
    changed = True
    while changed:
        changed = False
        at = after[0]
        while at < count - 1:
            first, last = before[at], after[at]
            if _is_near(chain, first, last, tolerance) and way_fits(
                fits, chain[first, 0], chain[first, 1], chain[last, 0], chain[last, 1]
            ):
                kept[at] = False
                after[first], before[last] = last, first
                changed = True
                at = after[last]
            else:
                at = last
    return np.flatnonzero(kept)


@inner_part
def _is_near(chain: NDArray[np.float64], first: int, last: int, tolerance: float) -> bool:
    """Whether all points between two of a chain are within ``tolerance`` of the straight way."""
    x, y = chain[first]
    along_x, along_y = chain[last, 0] - x, chain[last, 1] - y
    length = np.hypot(along_x, along_y)
    if length == 0.0:
        return False
    for at in range(first + 1, last):
        off_x, off_y = chain[at, 0] - x, chain[at, 1] - y
        share = (off_x * along_x + off_y * along_y) / length
        if share < -tolerance or share > length + tolerance:
            return False
        if abs(off_x * along_y - off_y * along_x) > tolerance * length:
            return False
    return True
