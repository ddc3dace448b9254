"""Lines and doorways that a map of segments leaves out: they cut floor that is joined in the home.

Some robots leave lines of a cell or two between two segments, or around a carpet; others tell
nothing of the floor in a doorway. All masks and labels are [rows, columns].
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.raster.regions import numbered_regions

Owners = NDArray[np.int16]

WIDEST_SEAM: Final = 2
"""Cells; a line that is no wall and has floor on both sides is floor up to this width."""
DEEPEST_DOORWAY: Final = 0.3
"""m; longest way from one room to the next through the wall between them."""
DOORWAY_WIDTHS: Final = (0.5, 1.5)
"""m; from post to post: what is narrower or wider is no door."""
_POST: Final = 0.5
"""0..1; at each side of a doorway, more than this share of the cells beside it is wall."""


def without_seams(owners: Owners, nothing: Mask, wall: Mask, resolution: float) -> Owners:
    """Return ``owners`` with each cell of a seam or a doorway given to the floor nearest to it.

    ``owners`` holds the segment of each cell, from 1 on; 0 is a cell of which ``nothing`` is told,
    a ``wall``, or floor of no segment, which bounds no seam. ``resolution`` is m per cell.
    """
    found = np.zeros_like(owners)
    _find_doorways(owners, nothing, wall, resolution, found)
    _find_doorways(owners.T, nothing.T, wall.T, resolution, found.T)
    joined = np.where(found > 0, found, owners)
    # The second round is for corners of lines: they lie between cells that the first one filled.
    for widest in (WIDEST_SEAM, 1):
        found = joined.copy()
        _find_seams(joined, nothing, widest, found)
        _find_seams(joined.T, nothing.T, widest, found.T)
        joined = found
    return joined


def _find_seams(owners: Owners, nothing: Mask, widest: int, found: Owners) -> None:
    """Write into ``found`` the owners of cells of seams that a walk along a row crosses."""
    for cells, owner, _, _ in _crossings(owners, nothing & (owners == 0), widest):
        found[cells] = owner


def _find_doorways(
    owners: Owners, nothing: Mask, wall: Mask, resolution: float, found: Owners
) -> None:
    """Write into ``found`` the owners of cells of doorways that a walk along a row crosses."""
    nearest, low, high = (np.zeros_like(owners) for _ in range(3))
    deepest = int(DEEPEST_DOORWAY / resolution + 1e-9)
    for cells, owner, before, after in _crossings(owners, nothing, deepest):
        nearest[cells] = owner
        low[cells], high[cells] = np.minimum(before, after), np.maximum(before, after)
    pieces = numbered_regions(nearest > 0)
    is_doorway = _are_doorways(pieces, low, high, wall, resolution)
    chosen = is_doorway[pieces]
    found[chosen] = nearest[chosen]


def _are_doorways(
    pieces: NDArray[np.int32], low: Owners, high: Owners, wall: Mask, resolution: float
) -> Mask:
    """Return for each piece whether it joins segments, is as wide as a door and has two posts."""
    count = int(pieces.max(initial=0)) + 1
    rows, columns = np.nonzero(pieces)
    numbers = pieces[rows, columns]
    first, last = np.zeros(count, np.int64), np.zeros(count, np.int64)
    # Cells come row by row: of several written to the same index the last one stays.
    first[numbers[::-1]], last[numbers] = rows[::-1], rows
    width = (last - first + 1) * resolution
    is_doorway = (width >= DOORWAY_WIDTHS[0] - 1e-9) & (width <= DOORWAY_WIDTHS[1] + 1e-9)
    lowest, highest = np.full(count, np.iinfo(np.int16).max), np.zeros(count, np.int64)
    np.minimum.at(lowest, numbers, low[rows, columns])
    np.maximum.at(highest, numbers, high[rows, columns])
    is_doorway &= lowest < highest
    bounded = np.pad(wall, ((1, 1), (0, 0)))
    for end, beyond in ((first, 0), (last, 2)):
        at_end = rows == end[numbers]
        posts = bounded[rows[at_end] + beyond, columns[at_end]]
        sides = np.bincount(numbers[at_end], minlength=count)
        walls = np.bincount(numbers[at_end], posts, minlength=count)
        is_doorway &= walls > _POST * sides
    is_doorway[0] = False
    return np.asarray(is_doorway)


def _crossings(
    owners: Owners, nothing: Mask, most: int
) -> Iterator[tuple[tuple[NDArray[np.int64], NDArray[np.int64]], Owners, Owners, Owners]]:
    """Yield cells of runs along rows of up to ``most`` cells of nothing between two owned ones.

    With them come their nearest owner, and the owners before and after the run.
    """
    for width in range(1, min(most, owners.shape[1] - 2) + 1):
        before, after = owners[:, : -width - 1], owners[:, width + 1 :]
        is_run = (before > 0) & (after > 0)
        for step in range(1, width + 1):
            is_run &= nothing[:, step : step + is_run.shape[1]]
        rows, columns = np.nonzero(is_run)
        ends = before[rows, columns], after[rows, columns]
        for step in range(1, width + 1):
            nearer = ends[0] if 2 * (step - 1) < width else ends[1]
            yield (rows, columns + step), nearer, *ends
