"""Whether a map that has grown shows something new on a way that was planned before."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.planning.path.costmap import FitMap


def is_walled(
    points: NDArray[np.float64],
    occupancy: OccupancyMap,
    before: OccupancyMap,
    body_radius: float,
    clearance: float,
) -> bool:
    """Whether cells are occupied that were free ``before`` and are too near to a way.

    The way is ``points``, float64 [n, 2], m; too near is less than ``body_radius`` + ``clearance``,
    m. Both maps have cells of one size at the same places.
    """
    frame, reach = occupancy.frame, body_radius + clearance
    beyond = reach + 2.0 * frame.resolution
    row, column = frame.cell_of(*(points.min(axis=0) - beyond).tolist())
    last_row, last_column = frame.cell_of(*(points.max(axis=0) + beyond).tolist())
    row, column = max(row, 0), max(column, 0)
    window = occupancy.values[row : max(last_row + 1, 0), column : max(last_column + 1, 0)]
    cells = np.argwhere(window == OCCUPIED)
    new = cells[_was_free(cells + np.array((row, column)), frame, before)]
    if not len(new):
        return False
    # Beyond the window nothing may count as solid: a margin around it is free.
    margin = math.ceil(beyond / frame.resolution)
    rows, columns = (size + 2 * margin for size in window.shape)
    values = np.full((rows, columns), FREE, np.int8)
    values[new[:, 0] + margin, new[:, 1] + margin] = OCCUPIED
    corner = (
        frame.origin_x + (column - margin) * frame.resolution,
        frame.origin_y + (row - margin) * frame.resolution,
    )
    around = OccupancyMap(GridFrame(frame.resolution, *corner, rows, columns), values)
    fit = FitMap.build(around, body_radius, clearance)
    corners = [(float(x), float(y)) for x, y in points]
    return not all(fit.fits_along(start, end) for start, end in pairwise(corners))


def _was_free(
    cells: NDArray[np.int64], frame: GridFrame, before: OccupancyMap
) -> NDArray[np.bool_]:
    """Tell which cells of a frame, int64 [n, 2], row and column, were free on a map."""
    there, size = before.frame, frame.resolution
    rows = cells[:, 0] + round((frame.origin_y - there.origin_y) / size)
    columns = cells[:, 1] + round((frame.origin_x - there.origin_x) / size)
    inside = (rows >= 0) & (rows < there.rows) & (columns >= 0) & (columns < there.columns)
    was_free = np.zeros(len(cells), np.bool_)
    was_free[inside] = before.values[rows[inside], columns[inside]] == FREE
    return was_free
