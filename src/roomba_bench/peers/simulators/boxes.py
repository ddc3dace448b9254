"""Covers solid cells with few rectangles, for engines that know no grids."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def boxes_of(solid: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return rectangles that cover the solid cells, each cell once.

    int [n, 4]: first column, first row, end column, end row; the ends are exclusive. Greedy: as
    wide as can be, and then as high.
    """
    left = solid.copy()
    boxes = []
    for row in range(left.shape[0]):
        for column in np.flatnonzero(left[row]).tolist():
            if not left[row, column]:
                continue
            free = np.flatnonzero(~left[row, column:])
            end_column = column + int(free[0]) if len(free) else left.shape[1]
            whole = left[row:, column:end_column].all(axis=1)
            end_row = row + (len(whole) if whole.all() else int(np.argmin(whole)))
            left[row:end_row, column:end_column] = False
            boxes.append((column, row, end_column, end_row))
    return np.array(boxes, np.int64).reshape(-1, 4)
