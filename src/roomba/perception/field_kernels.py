"""Compiled looks into a surface field: distances, their slopes, and how far a ray goes."""

from __future__ import annotations

from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

Field = NDArray[np.float32]
"""[rows, columns], m: see :class:`roomba.perception.surface_field.SurfaceField`."""
Place = NDArray[np.float64]
"""[3]: x and y of the middle of the first cell, and the resolution, m."""

OFF_MAP: Final = 1e3
"""m; the distance to surfaces, where there is no map: as far from fitting as can be."""
_TOUCH: Final = 0.005
"""m; a ray that is this near to a surface has met it."""
_LEAST_STEP: Final = 0.02
"""m; a ray that grazes a surface goes on by at least this."""


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def look(field: Field, place: Place, x: float, y: float) -> tuple[float, float, float]:
    """Return the distance to the nearest surface at a point, m, and its slopes along x and y."""
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


@njit(cache=True, nogil=True, error_model="numpy")
def expected_range(
    field: Field, place: Place, x: float, y: float, cosine: float, sine: float, most: float
) -> float:
    """Return how far a beam from a point goes before it meets a surface, m, at most ``most``.

    It strides by the distance to the nearest surface (sphere tracing, Hart 1996).
    """
    way = 0.0
    while way < most:
        distance, _, _ = look(field, place, x + way * cosine, y + way * sine)
        if distance < _TOUCH or distance >= OFF_MAP:
            return min(way + min(distance, 0.0), most) if distance < _TOUCH else most
        way += max(distance, _LEAST_STEP)
    return most
