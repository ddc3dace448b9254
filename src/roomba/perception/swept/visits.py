"""How often each cell of floor was swept, as a page shows it: once, twice, or more often."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.perception.swept.coverage_kernels import visit
from roomba.raster.carried import carried

CELL: Final = 0.05
"""m; side of a cell, as fine as can be seen on a page."""
_ANOTHER_VISIT: Final = 6.0
"""s after which a cell that is swept again counts once more: neighbouring swaths overlap."""
_MOST: Final = 3


class Visits:
    """Counts of visits, uint8 [rows, columns] over ``frame``: 0 to 3."""

    def __init__(self, frame: GridFrame, tool_width: float) -> None:
        """Begin with nothing visited, on cells over all of a frame."""
        self.frame = _over(frame)
        self.counts: NDArray[np.uint8] = np.zeros(self.frame.shape, np.uint8)
        self._swept_at = np.full(self.frame.shape, -np.inf)
        self._place = _place(self.frame)
        self._rule = (0.5 * tool_width, _ANOTHER_VISIT, _MOST)
        self._at: NDArray[np.float64] | None = None

    def clear(self) -> None:
        """Begin with nothing visited."""
        self.counts[:] = 0
        self._swept_at[:] = -np.inf
        self._at = None

    def carry(self, frame: GridFrame) -> None:
        """Go on over another frame of the same map, which has grown."""
        before, self.frame = self.frame, _over(frame)
        self.counts = carried(self.counts, before, self.frame, Pose())
        self._swept_at = carried(self._swept_at, before, self.frame, Pose(), -np.inf)
        self._place = _place(self.frame)

    def lift(self) -> None:
        """Interrupt the path: the next place does not continue the last one."""
        self._at = None

    def sweep(self, now: float, x: float, y: float) -> None:
        """Count the cells that the tool passes on a straight way to (x, y), m, at a time, s."""
        self.sweep_all(np.array([(now, x, y)]))

    def sweep_all(self, poses: NDArray[np.float64]) -> None:
        """Count the cells that the tool passes from pose to pose, float64 [n, 3]: s, m, m."""
        if not len(poses):
            return
        begin = poses[:1] if self._at is None else self._at
        visit(self.counts, self._swept_at, self._place, self._rule, np.vstack((begin, poses)))
        self._at = poses[-1:].copy()


def _over(frame: GridFrame) -> GridFrame:
    """Return a frame with cells of CELL that covers all of another frame."""
    rows = math.ceil(frame.rows * frame.resolution / CELL)
    columns = math.ceil(frame.columns * frame.resolution / CELL)
    return GridFrame(CELL, frame.origin_x, frame.origin_y, rows, columns)


def _place(frame: GridFrame) -> NDArray[np.float64]:
    return np.array([*frame.centre_of(0, 0), CELL])
