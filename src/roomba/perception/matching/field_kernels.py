"""Compiled lookups in a surface field: distance and gradient."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, allocating_part, inlined_entry
from roomba.raster.regions import cells_along_columns

Field = NDArray[np.float32]
"""[rows, columns], m: see :class:`roomba.perception.matching.surface_field.SurfaceField`."""
Place = NDArray[np.float64]
"""[3]: x and y of the middle of the first cell, and the resolution, m."""

OFF_MAP: Final = 1e3
"""m; the distance to surfaces where there is no map."""


@inlined_entry
def look(field: Field, place: Place, x: float, y: float) -> tuple[float, float, float]:
    """Return the distance to the nearest surface at a point, m, and its gradient along x and y.

    Outside of the map that is OFF_MAP, 0, 0.
    """
    inverse = 1.0 / place[2]
    u, v = (x - place[0]) * inverse, (y - place[1]) * inverse
    rows, columns = field.shape
    if not (0.0 <= u < columns - 1 and 0.0 <= v < rows - 1):
        return OFF_MAP, 0.0, 0.0
    column, row = int(u), int(v)
    a, b = u - column, v - row
    low, low_next = field[row, column], field[row, column + 1]
    high, high_next = field[row + 1, column], field[row + 1, column + 1]
    lower = low + a * (low_next - low)
    upper = high + a * (high_next - high)
    slope_x = ((1.0 - b) * (low_next - low) + b * (high_next - high)) * inverse
    return lower + b * (upper - lower), slope_x, (upper - lower) * inverse


@allocating_entry
def fill_near_surfaces(
    solid: NDArray[np.bool_], metres: NDArray[np.float32], values: Field
) -> None:
    """Fill ``values`` with signed distances, exact where these are short.

    ``metres`` [most**2 + 1] is a table: the distance, m, by the squared distance, in cells, to the
    nearest cell of the other kind. Its last entry is for all cells that are farther off.
    """
    rows, columns = solid.shape
    last = metres.size - 1
    most = round(math.sqrt(last))
    free = ~solid
    to_solid, to_free = np.empty(solid.shape, np.int16), np.empty(solid.shape, np.int16)
    cells_along_columns(solid, most, to_solid)
    cells_along_columns(free, most, to_free)
    outside, inside = np.empty(columns, np.int32), np.empty(columns, np.int32)
    for row in range(rows):
        _nearest_squares(to_solid[row], most, outside)
        _nearest_squares(to_free[row], most, inside)
        for column in range(columns):
            # One of the two is 0: the distance to the cell's own kind.
            off = metres[max(outside[column], inside[column])]
            values[row, column] = off if free[row, column] else -off


@allocating_part
def _nearest_squares(up: NDArray[np.int16], most: int, squares: NDArray[np.int32]) -> None:
    """Fill a row with squared distances, in cells, from the distances ``up`` along each column.

    Distances end at ``most`` cells.
    """
    columns = up.size
    squares[:] = most * most
    for right in range(-most, most + 1):
        # Slices of one length let the compiler vectorize over columns.
        beside = up[max(right, 0) : max(columns + right, 0)]
        into = squares[max(-right, 0) : max(columns - right, 0)]
        aside = np.int32(right * right)
        for column in range(min(into.size, beside.size)):
            into[column] = min(into[column], np.int32(beside[column] * beside[column] + aside))
