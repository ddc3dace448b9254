"""Counting floor without dirt, compiled: one function for ticks and for bursts of them."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry

DUST: Final = np.dtype(
    [
        ("least_grains", "f8"),  # grains/s; with fewer none comes in
        ("silent_cells", "i8"),  # of the floor that became clean since a grain came in
        ("silent_way", "f8"),  # m; driven since then
        ("heard", "?"),  # whether a grain came in since the bin was emptied
    ],
    align=True,
)
"""What the dirt sensor tells of the bin, one row."""


@entry
def note_dust(rows: NDArray[np.void], grains: float, way: float, cells: int) -> None:
    """Note what the dirt sensor counts, 1/s, over ``way`` m that made so many cells clean."""
    row: Any = rows[0]
    if grains >= row.least_grains:
        row.silent_cells = 0
        row.silent_way = 0.0
        row.heard = True
    else:
        row.silent_cells += cells
        row.silent_way += way
