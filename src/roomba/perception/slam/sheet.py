"""The sheet that scans are drawn on: an occupancy grid that grows with what is seen."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.grid import UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.slam import drawing_kernels
from roomba.perception.slam.drawing_kernels import INTO_EDGE, draw, occupancy

Floats = NDArray[np.float64]

_STEP: Final = 5.0
"""m; it grows by so much at a time."""
_NONE: Final = 2**40
"""The first row and column with counts, as long as there are none."""
_MARGIN: Final = 1
"""Cells of the unknown around what is known."""


class Sheet:
    """Counts of beams in cells of ``resolution``, m.

    The corners of cells lie at whole multiples of it, plus ``phase``, x and y in m.
    """

    def __init__(self, resolution: float, phase: tuple[float, float] = (0.0, 0.0)) -> None:
        """Begin empty."""
        self._resolution, self._phase = resolution, phase
        self._row = self._column = 0
        self._hits = np.zeros((0, 0), np.uint16)
        self._passes = np.zeros((0, 0), np.uint16)
        self._offsets = np.zeros((0, 0, 2), np.float32)
        self._bounds = np.array([_NONE, -1, _NONE, -1])

    def draw(self, points: NDArray[np.float32], lidar: Floats, pose: Floats, reach: float) -> None:
        """Add a scan, float32 [n, 4], robot's frame, seen from ``pose`` [3], map frame.

        ``lidar`` is x, y in the robot's frame, ``reach`` how far its beams go, m.
        """
        self._cover(pose, reach)
        draw(self._arrays(), points, lidar, pose, INTO_EDGE)

    def occupancy(self, share: float, least: int) -> OccupancyMap:
        """Return the map of what was drawn; see :func:`.drawing_kernels.occupancy`.

        Raises ValueError while nothing was drawn.
        """
        first_row, last_row, first_column, last_column = self._bounds.tolist()
        if last_row < first_row:
            raise ValueError("expected a sheet with at least one scan on it, got an empty one")
        values = np.empty((last_row - first_row + 1, last_column - first_column + 1), np.int8)
        occupancy(self._arrays(), share, least, values)
        size = self._resolution
        frame = GridFrame(
            size,
            self._phase[0] + (self._column + first_column - _MARGIN) * size,
            self._phase[1] + (self._row + first_row - _MARGIN) * size,
            values.shape[0] + 2 * _MARGIN,
            values.shape[1] + 2 * _MARGIN,
        )
        return OccupancyMap(frame, np.pad(values, _MARGIN, constant_values=UNKNOWN))

    def _arrays(self) -> drawing_kernels.Sheet:
        resolution = self._resolution
        corner = (
            self._phase[0] + self._column * resolution,
            self._phase[1] + self._row * resolution,
        )
        place = np.array([*corner, resolution])
        counts = self._hits, self._passes
        return drawing_kernels.Sheet(*counts, place, self._bounds, self._offsets)

    def _cover(self, pose: Floats, reach: float) -> None:
        """Make room for all that can be seen from a pose."""
        size = self._resolution
        column, row = ((pose[:2] - reach - self._phase) // size).astype(int).tolist()
        last_column, last_row = ((pose[:2] + reach - self._phase) // size).astype(int).tolist()
        rows, columns = self._hits.shape
        if rows == 0:
            self._row, self._column = row, column
        step = int(_STEP / size)
        below = -(-max(self._row - row, 0) // step) * step
        left = -(-max(self._column - column, 0) // step) * step
        above = -(-max(last_row + 1 - self._row - rows, 0) // step) * step
        right = -(-max(last_column + 1 - self._column - columns, 0) // step) * step
        if below or left or above or right:
            around = ((below, above), (left, right))
            self._hits, self._passes = np.pad(self._hits, around), np.pad(self._passes, around)
            self._offsets = np.pad(self._offsets, (*around, (0, 0)))
            self._row -= below
            self._column -= left
            if self._bounds[0] != _NONE:
                self._bounds += (below, below, left, left)
