"""Resampling: the values of one map's cells on the grid of another map of the same home."""

from __future__ import annotations

import math
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry
from roomba.geometry import Pose
from roomba.grid import GridFrame

Value = TypeVar("Value", bound=np.generic)
Place = tuple[float, float, float]


def carried(
    values: NDArray[Value], before: GridFrame, after: GridFrame, moved: Pose, nothing: float = 0.0
) -> NDArray[Value]:
    """Return ``values``, [rows, columns] over the grid ``before``, over the grid ``after``.

    ``moved`` is where the frame of the old map lies in that of the new one. Each new cell gets what
    the old one at its middle had, or ``nothing`` where there was none. Raises ValueError for
    values of another shape than their grid.
    """
    if values.shape != before.shape:
        raise ValueError(f"expected values of shape {before.shape}, got {values.shape}")
    over = np.full(after.shape, nothing, values.dtype)
    back = moved.inverse()
    _carry(values, _place(before), over, _place(after), (back.x, back.y, back.theta))
    return over


def _place(frame: GridFrame) -> Place:
    return frame.origin_x, frame.origin_y, frame.resolution


@entry
def _carry(values: Any, old: Place, over: Any, new: Place, back: Place) -> None:
    """Fill ``over``; ``old`` and ``new``: x, y, resolution, m; ``back``: x, y, theta, m and rad."""
    cos, sin = math.cos(back[2]), math.sin(back[2])
    for row in range(over.shape[0]):
        y = new[1] + (row + 0.5) * new[2]
        for column in range(over.shape[1]):
            x = new[0] + (column + 0.5) * new[2]
            old_x, old_y = back[0] + cos * x - sin * y, back[1] + sin * x + cos * y
            old_row = math.floor((old_y - old[1]) / old[2])
            old_column = math.floor((old_x - old[0]) / old[2])
            if 0 <= old_row < values.shape[0] and 0 <= old_column < values.shape[1]:
                over[row, column] = values[old_row, old_column]
