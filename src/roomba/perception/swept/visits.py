"""How often each piece of floor was swept: what a page shows as once, twice, and more."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.grid import GridFrame
from roomba.perception.swept.coverage_bits import SWEPT
from roomba.perception.swept.coverage_kernels import sweep
from roomba.perception.swept.coverage_map import LONGEST_STEP

CELL: Final = 0.05
"""m; side of a cell, as fine as can be seen on a page."""
_ANOTHER_VISIT: Final = 6.0
"""s after which a cell that is swept again counts once more: neighbouring swaths overlap."""
_MOST: Final = 3


class Visits:
    """Counts of visits, uint8 [rows, columns] over ``frame``: 0 to 3."""

    def __init__(self, frame: GridFrame, tool_width: float) -> None:
        """Lay cells over all of a frame, with nothing visited."""
        rows = math.ceil(frame.rows * frame.resolution / CELL)
        columns = math.ceil(frame.columns * frame.resolution / CELL)
        self.frame = GridFrame(CELL, frame.origin_x, frame.origin_y, rows, columns)
        self.counts: NDArray[np.uint8] = np.zeros(self.frame.shape, np.uint8)
        self._swept_at = np.full(self.frame.shape, -np.inf)
        self._radius = 0.5 * tool_width
        self._at: tuple[float, float] | None = None

    def clear(self) -> None:
        """Begin with nothing visited."""
        self.counts[:] = 0
        self._swept_at[:] = -np.inf
        self._at = None

    def lift(self) -> None:
        """Interrupt the path: the next place does not continue the last one."""
        self._at = None

    def sweep(self, now: float, x: float, y: float) -> None:
        """Count what the tool passes on a straight way to (x, y), m, at a time, s."""
        from_x, from_y = self._at or (x, y)
        if math.hypot(x - from_x, y - from_y) > LONGEST_STEP:
            from_x, from_y = x, y
        self._at = (x, y)
        reach, frame = self._radius, self.frame
        low_row, low_column = frame.cell_of(min(x, from_x) - reach, min(y, from_y) - reach)
        high_row, high_column = frame.cell_of(max(x, from_x) + reach, max(y, from_y) + reach)
        rows = np.arange(max(low_row, 0), min(high_row + 1, frame.rows))
        columns = np.arange(max(low_column, 0), min(high_column + 1, frame.columns))
        if not (rows.size and columns.size):
            return
        first_x, first_y = frame.centre_of(rows[0], columns[0])
        passed = np.zeros((rows.size, columns.size), np.uint8)
        sweep(passed, np.array([first_x, first_y, CELL]), from_x, from_y, x, y, reach)
        under = passed == SWEPT
        area = np.ix_(rows, columns)
        counts, swept_at = self.counts[area], self._swept_at[area]
        fresh = under & (now - swept_at > _ANOTHER_VISIT)
        self.counts[area] = np.where(fresh, np.minimum(counts + 1, _MOST), counts)
        self._swept_at[area] = np.where(under, now, swept_at)
