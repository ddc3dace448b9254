"""Exact Euclidean distances over a grid, compiled.

After Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions" (2012): along
columns first, then the lower envelope of parabolas along rows. OpenCV has it too, but costs each
process that loads it 100 MB (ADR 4).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, inner_part

_FAR = 1e12


def distance_to_nearest(targets: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Return for each cell the distance to the nearest true cell, between middles, in cells.

    ``targets`` is bool [rows, columns]; float32 of the same shape; infinite where there is none.
    """
    distances: NDArray[np.float32] = np.empty(targets.shape, np.float32)
    _transform(np.ascontiguousarray(targets), distances)
    return distances


@allocating_entry
def _transform(targets: NDArray[np.bool_], distances: NDArray[np.float32]) -> None:
    rows, columns = targets.shape
    squared = np.empty((rows, columns), np.float64)
    _along_columns(targets, squared)
    feet = np.empty(columns, np.int64)
    bounds = np.empty(columns + 1, np.float64)
    for row in range(rows):
        _along_row(squared[row], feet, bounds, distances[row])


@inner_part
def _along_columns(targets: NDArray[np.bool_], squared: NDArray[np.float64]) -> None:
    """Write the squared distance to the nearest true cell of the same column."""
    rows, columns = targets.shape
    for column in range(columns):
        squared[0, column] = 0.0 if targets[0, column] else _FAR
    for row in range(1, rows):
        for column in range(columns):
            if targets[row, column]:
                squared[row, column] = 0.0
            else:
                squared[row, column] = squared[row - 1, column] + 1.0
    for row in range(rows - 2, -1, -1):
        for column in range(columns):
            squared[row, column] = min(squared[row, column], squared[row + 1, column] + 1.0)
    for row in range(rows):
        for column in range(columns):
            squared[row, column] *= squared[row, column]


@inner_part
def _along_row(
    squared: NDArray[np.float64],
    feet: NDArray[np.int64],
    bounds: NDArray[np.float64],
    distances: NDArray[np.float32],
) -> None:
    """Write the distances of a row: the lower envelope of a parabola on each cell of it."""
    columns = squared.size
    last = 0
    feet[0] = 0
    bounds[0] = -math.inf
    bounds[1] = math.inf
    for column in range(1, columns):
        height = squared[column] + column * column
        while True:
            foot = feet[last]
            crossing = (height - squared[foot] - foot * foot) / (2.0 * (column - foot))
            if crossing > bounds[last]:
                break
            last -= 1
        last += 1
        feet[last] = column
        bounds[last] = crossing
        bounds[last + 1] = math.inf
    last = 0
    for column in range(columns):
        while bounds[last + 1] < column:
            last += 1
        foot = feet[last]
        total = (column - foot) * (column - foot) + squared[foot]
        distances[column] = math.sqrt(total) if total < _FAR else math.inf
