"""Stage swaths: straight parallel ways over the floor that the edges leave.

Places in cells of the window: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.mask_kernels import Mask
from roomba.planning.coverage_regions import regions

Line = NDArray[np.float64]

_SPECK = 20
"""cells; patches smaller than this are left."""
_NEW_SWATH = 30.0
"""cells of way that getting to another swath costs, when the rows are chosen."""
_GAP = 30
"""cells; over swept floor narrower than this a swath goes on."""


def swaths(left: Mask, middles: Mask, radius: float) -> list[Line]:
    """Return lines, float64 [2, 2], that sweep the floor in ``left``, bool [rows, columns].

    The lines stay in ``middles``, bool of the same shape. Every cell of ``left`` must be so far
    from where the middle may not be that the middle may be anywhere within ``radius``, cells, of
    it. Each region is swept along rows or along columns, whichever takes less way.
    """
    labels = regions(left)
    sizes = np.bincount(labels.ravel())
    lines: list[Line] = []
    for label, box in _boxes(labels, sizes):
        if sizes[label] < _SPECK:
            continue
        region = np.ascontiguousarray(labels[box] == label)
        offset = np.array([box[1].start, box[0].start], np.float64)
        floor = middles[box]
        flat, flat_cost = _along_rows(region, floor, radius)
        upright, upright_cost = _along_rows(np.ascontiguousarray(region.T), floor.T, radius)
        if flat_cost <= upright_cost:
            lines.extend(line + offset for line in flat)
        else:
            lines.extend(line[:, ::-1] + offset for line in upright)
    return lines


def _boxes(
    labels: NDArray[np.int32], sizes: NDArray[np.int64]
) -> list[tuple[int, tuple[slice, slice]]]:
    """Return each region's number and the window that it fills."""
    bounds = np.empty((len(sizes), 4), np.int64)
    _find_bounds(labels, bounds)
    return [
        (label, (slice(b[0], b[1] + 1), slice(b[2], b[3] + 1)))
        for label, b in enumerate(bounds.tolist())
        if label > 0
    ]


@njit(cache=True, nogil=True)
def _find_bounds(labels: NDArray[np.int32], bounds: NDArray[np.int64]) -> None:
    bounds[:, 0::2] = 1 << 40
    bounds[:, 1::2] = -1
    for row in range(labels.shape[0]):
        for column in range(labels.shape[1]):
            bound = bounds[labels[row, column]]
            bound[0] = min(bound[0], row)
            bound[1] = max(bound[1], row)
            bound[2] = min(bound[2], column)
            bound[3] = max(bound[3], column)


def _along_rows(region: Mask, floor: Mask, radius: float) -> tuple[list[Line], float]:
    """Return swaths along rows that sweep a region, and what they cost, in cells of way."""
    runs = _runs_by_row(region, np.ascontiguousarray(floor), int(radius + 1e-6), _GAP)
    costs = np.zeros(len(region))
    np.add.at(costs, runs[:, 0], runs[:, 2] - runs[:, 1] + _NEW_SWATH)
    rows = _cheapest_rows(region.any(axis=1), costs, int(2 * radius + 1e-6))
    chosen = runs[np.isin(runs[:, 0], rows)]
    lines = [
        np.array([[first, row], [last, row]], np.float64) for row, first, last in chosen.tolist()
    ]
    return lines, float(costs[rows].sum())


@njit(cache=True, nogil=True)
def _runs_by_row(region: Mask, floor: Mask, radius: int, gap: int) -> NDArray[np.int64]:
    """Return the swaths that each row would need, int64 [n, 3]: row, first and last column."""
    rows, columns = region.shape
    runs = np.empty((1024, 3), np.int64)
    size = 0
    depth = np.zeros(columns, np.int32)
    for row in range(min(radius, rows)):
        _add(depth, region[row], 1)
    for row in range(rows):
        if row + radius < rows:
            _add(depth, region[row + radius], 1)
        if row - radius - 1 >= 0:
            _add(depth, region[row - radius - 1], -1)
        along = floor[row]
        last = -gap - 2
        for column in range(columns):
            if not along[column]:
                last = -gap - 2
                continue
            if depth[column] == 0:
                continue
            if column - last > gap:
                if size == len(runs):
                    larger = np.empty((2 * size, 3), np.int64)
                    larger[:size] = runs
                    runs = larger
                runs[size, 0], runs[size, 1] = row, column
                size += 1
            runs[size - 1, 2] = column
            last = column
    return runs[:size]


@njit(cache=True, nogil=True)
def _add(depth: NDArray[np.int32], cells: NDArray[np.bool_], change: int) -> None:
    for column in range(depth.size):
        depth[column] += change * np.int32(cells[column])


@njit(cache=True, nogil=True)
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
