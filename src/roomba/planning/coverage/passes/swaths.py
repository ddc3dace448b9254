"""Stage swaths: straight parallel ways over the floor that the edges leave.

Places in cells of the window: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask, Polyline
from roomba.compilation import allocating_entry, inner_part
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.floor.masks import transposed
from roomba.planning.coverage.floor.regions import mask_of, regions
from roomba.planning.coverage.passes.directions import main_directions
from roomba.planning.coverage.passes.turned_cells import TurnedCells, turned_mask
from roomba.raster.growing import with_room

_OVERLAP = 0.4
"""cells; overlap of two slanted swaths beside each other."""


def swaths(left: Mask, middles: Mask, radius: float, config: CoverageConfig) -> list[Polyline]:
    """Return lines, float64 [2, 2], that sweep the floor in ``left``, bool [rows, columns].

    The lines stay in ``middles``, bool of the same shape. The middle must be allowed anywhere
    within ``radius``, cells, of each cell of ``left``. Each region is swept along rows, along
    columns, or along or across a main direction of slanted walls, as takes the least way.
    """
    parts = regions(left, config.narrow, config.least_part)
    across = transposed(middles)
    directions = main_directions(middles)
    roomy = _roomy(middles) if directions else middles
    lines: list[Polyline] = []
    for region in np.flatnonzero(parts.sizes >= config.speck).tolist():
        mask = mask_of(parts, region)
        top, _, left_side, _ = parts.bounds[region].tolist()
        offset = np.array([left_side, top], np.float64)
        flat, cost = _along_rows(mask, middles, top, left_side, radius, config)
        upright, upright_cost = _along_rows(
            transposed(mask), across, left_side, top, radius, config
        )
        best = flat
        if upright_cost < cost:
            best, cost = upright[:, :, ::-1], upright_cost
        for angle in directions:
            slanted, slanted_cost = _slanted(mask, roomy, top, left_side, radius, config, angle)
            if slanted_cost < cost:
                best, cost = slanted, slanted_cost
        lines.extend(line + offset for line in best)
    return lines


def _roomy(middles: Mask) -> Mask:
    """Return the cells with all eight neighbours in ``middles``, bool of the same shape.

    A way whose places are each nearest to such a cell fits, wherever it crosses the cells.
    """
    fenced = np.pad(middles, 1)
    rows, columns = middles.shape
    roomy = middles.copy()
    for up in range(3):
        for right in range(3):
            roomy &= fenced[up : up + rows, right : right + columns]
    return roomy


def _slanted(
    region: Mask,
    roomy: Mask,
    top: int,
    left: int,
    radius: float,
    config: CoverageConfig,
    angle: float,
) -> tuple[Polyline, float]:
    """Return swaths along or across a direction, rad, and what they cost, as :func:`_along_rows`.

    The rows are a little narrower than cells, and the tool a whole number of rows wide. So swaths
    overlap: their seams cross cells at any place, and the least error of the drive would leave
    some of these cells.
    """
    wide = int(2 * radius + 1e-6)
    cell = (2 * radius - _OVERLAP) / wide
    rows, columns = region.shape
    cells = TurnedCells.over(rows, columns, angle, cell)
    wanted, floor = turned_mask(region, cells, 0, 0), turned_mask(roomy, cells, left, top)
    flat, flat_cost = _along_rows(wanted, floor, 0, 0, 0.5 * wide, config)
    upright, upright_cost = _along_rows(
        transposed(wanted), transposed(floor), 0, 0, 0.5 * wide, config
    )
    if upright_cost < flat_cost:
        return cells.places(upright[:, :, ::-1]), cell * upright_cost
    return cells.places(flat), cell * flat_cost


def _along_rows(
    region: Mask, floor: Mask, top: int, left: int, radius: float, config: CoverageConfig
) -> tuple[Polyline, float]:
    """Return swaths along rows that sweep a region, and what they cost, in cells of way.

    float64 [n, 2, 2]. The first cell of ``region`` is the one at (``top``, ``left``) of ``floor``.
    """
    runs = _runs_by_row(region, floor, top, left, int(radius + 1e-6), config.swath_gap)
    ways = runs[:, 2] - runs[:, 1] + config.swath_cost
    costs = np.bincount(runs[:, 0], ways, len(region)).astype(np.float64)
    rows = _cheapest_rows(region.any(axis=1), costs, int(2 * radius + 1e-6))
    chosen = runs[np.isin(runs[:, 0], rows)]
    return chosen[:, [[1, 0], [2, 0]]].astype(np.float64), float(costs[rows].sum())


@allocating_entry
def _runs_by_row(
    region: Mask, floor: Mask, top: int, left: int, radius: int, gap: int
) -> NDArray[np.int64]:
    """Return the swaths that each row would need, int64 [n, 3]: row, first and last column."""
    rows, columns = region.shape
    runs = np.empty((1024, 3), np.int64)
    size = 0
    # For each column the last row, up to ``radius`` ahead, with floor to sweep.
    seen = np.full(columns, -radius - 1, np.int32)
    for row in range(min(radius, rows)):
        _look(seen, region[row], row)
    for row in range(rows):
        if row + radius < rows:
            _look(seen, region[row + radius], row + radius)
        if size + columns > len(runs):
            runs = with_room(runs, size, 2 * len(runs) + columns)
        along = floor[top + row, left : left + columns]
        last = -gap - 2
        for column in range(columns):
            if not along[column]:
                last = -gap - 2
                continue
            if seen[column] < row - radius:
                continue
            if column - last > gap:
                runs[size, 0], runs[size, 1] = row, column
                size += 1
            runs[size - 1, 2] = column
            last = column
    return runs[:size]


@inner_part
def _look(seen: NDArray[np.int32], cells: NDArray[np.bool_], row: int) -> None:
    for column in range(seen.size):
        if cells[column]:
            seen[column] = row


@allocating_entry
def _cheapest_rows(
    needed: NDArray[np.bool_], costs: NDArray[np.float64], width: int
) -> NDArray[np.int64]:
    """Return the cheapest rows to sweep along of which no two are more than ``width`` apart."""
    count = len(needed)
    half = width // 2
    best = np.full(count, np.inf)
    before = np.full(count, -1)
    first = np.flatnonzero(needed)[0]
    last = np.flatnonzero(needed)[-1]
    for row in range(count):
        if row <= first + half:
            best[row] = costs[row]
        for other in range(max(row - width, 0), row):
            if best[other] + costs[row] < best[row]:
                best[row] = best[other] + costs[row]
                before[row] = other
    at = max(last - half, 0)
    for row in range(at, count):
        if best[row] < best[at]:
            at = row
    chosen = np.empty(count, np.int64)
    size = 0
    while at >= 0:
        chosen[size] = at
        size += 1
        at = before[at]
    return chosen[:size][::-1].copy()
