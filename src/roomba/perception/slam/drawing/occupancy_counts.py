"""Occupancy counts: how many beams ended in each cell and went through it, on a growing grid."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.slam.drawing import drawing_kernels
from roomba.perception.slam.drawing.drawing_kernels import (
    INTO_EDGE,
    MARGIN,
    Counts,
    draw,
    draw_open,
    occupancy,
)
from roomba.perception.slam.drawing.seen_surfaces import only_seen

Offsets = NDArray[np.float32]

_STEP: Final = 5.0
_SHARE: Final = 0.25
"""m, and share of its size: the grid grows by the larger of both, as copying a large grid takes
long."""
_NO_WAYS: Final = np.zeros((0, 2), np.float32)
_NONE: Final = 2**40
"""The first row and column with counts, as long as there are none."""


class OccupancyCounts:
    """Counts of beams in cells of ``resolution``, m.

    The corners of cells lie at whole multiples of ``resolution``, plus ``phase``, x and y in m.
    """

    def __init__(self, resolution: float, phase: tuple[float, float] = (0.0, 0.0)) -> None:
        """Begin empty."""
        self._resolution, self._phase = resolution, phase
        self._row = self._column = 0
        nothing = np.zeros((0, 0), np.uint16)
        offsets = np.zeros((0, 0, 2), np.float32)
        self._lay(nothing, nothing, nothing, offsets, np.array([_NONE, -1, _NONE, -1]))

    def draw(
        self,
        points: NDArray[np.float32],
        lidar: Floats,
        pose: Floats,
        open_ways: NDArray[np.float32] = _NO_WAYS,
    ) -> None:
        """Add a scan, float32 [n, 4], robot's frame, seen from ``pose`` [3], map frame.

        ``lidar`` is x, y in the robot's frame; ``open_ways``, float32 [m, 2], are the ends of the
        scan's open ways, on which no beam met anything.
        """
        ends = np.vstack((points[:, :2], open_ways, lidar))
        reach = float(np.hypot(ends[:, 0], ends[:, 1]).max())
        # A wall is drawn into the cell behind its surface.
        self._cover(pose, reach + MARGIN * self._resolution)
        draw(self._arrays, points, lidar, pose, INTO_EDGE, 1)
        draw_open(self._arrays, open_ways, lidar, pose, 1)

    def erase(
        self,
        points: NDArray[np.float32],
        lidar: Floats,
        pose: Floats,
        open_ways: NDArray[np.float32] = _NO_WAYS,
    ) -> None:
        """Take a scan away that was drawn."""
        draw(self._arrays, points, lidar, pose, INTO_EDGE, -1)
        draw_open(self._arrays, open_ways, lidar, pose, -1)

    def occupancy(self, share: float, least: int, least_floor: float = 0.0) -> OccupancyMap:
        """Return the map of what was drawn; see :func:`.drawing_kernels.occupancy`.

        Cells behind surfaces are left out by :func:`.seen_surfaces.only_seen`, which takes
        ``least_floor``, m2. Raises ValueError while nothing was drawn.
        """
        first_row, last_row, first_column, last_column = self._arrays.bounds.tolist()
        if last_row < first_row:
            raise ValueError("expected counts of at least one scan, got an empty one")
        around = 1 + 2 * MARGIN
        shape = last_row - first_row + around, last_column - first_column + around
        values = np.empty(shape, np.int8)
        occupancy(self._arrays, share, least, values)
        size = self._resolution
        frame = GridFrame(
            size,
            self._phase[0] + (self._column + first_column - MARGIN) * size,
            self._phase[1] + (self._row + first_row - MARGIN) * size,
            *shape,
        )
        return only_seen(OccupancyMap(frame, values), least_floor)

    def _lay(
        self,
        hits: Counts,
        passes: Counts,
        opens: Counts,
        offsets: Offsets,
        bounds: NDArray[np.int64],
    ) -> None:
        """Replace the counts by those of a grid with the new first row and column."""
        size = self._resolution
        corner = self._phase[0] + self._column * size, self._phase[1] + self._row * size
        place = np.array([*corner, size])
        self._arrays = drawing_kernels.CountArrays(hits, passes, place, bounds, offsets, opens)

    def _cover(self, pose: Floats, reach: float) -> None:
        """Make room for all within ``reach``, m, of a pose."""
        size, (phase_x, phase_y) = self._resolution, self._phase
        x, y = float(pose[0]) - phase_x, float(pose[1]) - phase_y
        column, last_column = math.floor((x - reach) / size), math.floor((x + reach) / size)
        row, last_row = math.floor((y - reach) / size), math.floor((y + reach) / size)
        hits, passes, _, bounds, offsets, opens = self._arrays
        rows, columns = hits.shape
        if rows == 0:
            self._row, self._column = row, column
        step = max(int(_STEP / size), int(_SHARE * max(rows, columns)))
        below = -(-max(self._row - row, 0) // step) * step
        left = -(-max(self._column - column, 0) // step) * step
        above = -(-max(last_row + 1 - self._row - rows, 0) // step) * step
        right = -(-max(last_column + 1 - self._column - columns, 0) // step) * step
        if below or left or above or right:
            around = ((below, above), (left, right))
            self._row -= below
            self._column -= left
            if bounds[0] != _NONE:
                bounds += (below, below, left, left)
            offsets = np.pad(offsets, (*around, (0, 0)))
            wider = [np.pad(each, around) for each in (hits, passes, opens)]
            self._lay(wider[0], wider[1], wider[2], offsets, bounds)
