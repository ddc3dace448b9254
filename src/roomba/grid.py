"""Grids laid over the floor: metres to cells and back, and occupancy maps.

Row 0 is the lowest y, column 0 the lowest x, as in nav_msgs/OccupancyGrid; a map has no rotation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

UNKNOWN = -1
FREE = 0
OCCUPIED = 100

MOST_CELLS = 20_000_000
"""Most cells of a map: 50,000 m2 in cells of 5 cm."""
FINEST_CELL, COARSEST_CELL = 1e-3, 1.0
"""m; no map is finer than a millimetre, and no robot fits on a map coarser than a metre."""

_Floats = NDArray[np.float64]
_Indices = NDArray[np.int64] | NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class GridFrame:
    """Where a grid lies: its lower left corner, m, its cell size, m, and its shape in cells."""

    resolution: float
    origin_x: float
    origin_y: float
    rows: int
    columns: int

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns) of an array over this grid."""
        return self.rows, self.columns

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Lowest x, highest x, lowest y, highest y, m."""
        return (
            self.origin_x,
            self.origin_x + self.columns * self.resolution,
            self.origin_y,
            self.origin_y + self.rows * self.resolution,
        )

    def with_cells(self, size: float) -> GridFrame:
        """Return a grid of cells of another ``size``, m, from the same corner over all of this."""
        return GridFrame(
            size,
            self.origin_x,
            self.origin_y,
            math.ceil(self.rows * self.resolution / size),
            math.ceil(self.columns * self.resolution / size),
        )

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        """Return the (row, column) in which a point lies; may be outside the grid."""
        return (
            math.floor((y - self.origin_y) / self.resolution),
            math.floor((x - self.origin_x) / self.resolution),
        )

    def cells_of(self, x: _Floats, y: _Floats) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the rows and columns in which points lie; some may be outside the grid."""
        rows = np.floor((y - self.origin_y) / self.resolution).astype(np.int64)
        columns = np.floor((x - self.origin_x) / self.resolution).astype(np.int64)
        return rows, columns

    def holds(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return which cells are on the grid."""
        inside: NDArray[np.bool_] = (
            (rows >= 0) & (rows < self.rows) & (columns >= 0) & (columns < self.columns)
        )
        return inside

    def centre_of(self, row: float, column: float) -> tuple[float, float]:
        """Return the (x, y) of a cell's centre, m; ``row`` and ``column`` may be fractions."""
        return (
            self.origin_x + (column + 0.5) * self.resolution,
            self.origin_y + (row + 0.5) * self.resolution,
        )

    def centres(
        self, rows: _Indices | None = None, columns: _Indices | None = None
    ) -> tuple[_Floats, _Floats]:
        """Return x and y, m, of the centres of cells.

        x has the shape of ``columns``, y that of ``rows``; both may be fractions, and are all of
        the grid by default.
        """
        rows = np.arange(self.rows) if rows is None else rows
        columns = np.arange(self.columns) if columns is None else columns
        x: _Floats = self.origin_x + (columns + 0.5) * self.resolution
        y: _Floats = self.origin_y + (rows + 0.5) * self.resolution
        return x, y

    def contains(self, x: float, y: float) -> bool:
        """Whether a point lies on the grid."""
        row, column = self.cell_of(x, y)
        return 0 <= row < self.rows and 0 <= column < self.columns


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyMap:
    """What is known of a floor: int8 [rows, columns]; 0 free, 100 occupied, -1 unknown.

    A value between 0 and 100 is how much of the cell is occupied, in percent.
    """

    frame: GridFrame
    values: NDArray[np.int8]

    def __post_init__(self) -> None:
        """Check that the array fits the frame."""
        if self.values.shape != self.frame.shape:
            raise ValueError(
                f"expected map values of shape {self.frame.shape}, got {self.values.shape}"
            )

    @property
    def solid(self) -> NDArray[np.bool_]:
        """Cells that no body may enter: all that is not known to be free, bool [rows, columns]."""
        solid: NDArray[np.bool_] = self.values != FREE
        return solid

    @property
    def likely_solid(self) -> NDArray[np.bool_]:
        """Cells that are unknown, or at least half occupied: bool [rows, columns]."""
        solid: NDArray[np.bool_] = (self.values >= OCCUPIED // 2) | (self.values < FREE)
        return solid

    @property
    def free_area(self) -> float:
        """How much floor is known to be free, m2."""
        return float(np.count_nonzero(self.values == FREE)) * self.frame.resolution**2
