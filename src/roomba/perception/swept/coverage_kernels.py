"""Compiled sweeping: which floor the tool passed over."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.perception.swept.coverage_bits import SWEPT, WANTED

Cells = NDArray[np.uint8]


@njit(cache=True, nogil=True, error_model="numpy")
def sweep(
    cells: Cells,
    place: NDArray[np.float64],
    from_x: float,
    from_y: float,
    to_x: float,
    to_y: float,
    radius: float,
) -> int:
    """Mark as SWEPT the cells whose middle a disc passes over that goes straight from one point to
    another, m; return how many of the WANTED ones are new.

    ``place`` is x and y of the middle of the first cell, and the resolution, m.
    """
    rows, columns = cells.shape
    step = place[2]
    inverse = 1.0 / step
    low_x, high_x = min(from_x, to_x) - radius, max(from_x, to_x) + radius
    low_y, high_y = min(from_y, to_y) - radius, max(from_y, to_y) + radius
    first_column = max(math.ceil((low_x - place[0]) * inverse), 0)
    last_column = min(math.floor((high_x - place[0]) * inverse), columns - 1)
    first_row = max(math.ceil((low_y - place[1]) * inverse), 0)
    last_row = min(math.floor((high_y - place[1]) * inverse), rows - 1)
    way_x, way_y = to_x - from_x, to_y - from_y
    square = way_x * way_x + way_y * way_y
    per_square = 1.0 / square if square > 0.0 else 0.0
    most = radius * radius
    found = 0
    for row in range(first_row, last_row + 1):
        dy = place[1] + row * step - from_y
        for column in range(first_column, last_column + 1):
            value = cells[row, column]
            if value & SWEPT:
                continue
            dx = place[0] + column * step - from_x
            share = min(max((dx * way_x + dy * way_y) * per_square, 0.0), 1.0)
            off_x, off_y = dx - share * way_x, dy - share * way_y
            if off_x * off_x + off_y * off_y <= most:
                cells[row, column] = value | SWEPT
                if value & WANTED:
                    found += 1
    return found
