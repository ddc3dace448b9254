"""How often each piece of floor was swept: what a page shows as once, twice, and more."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.grid import GridFrame

CELL: Final = 0.05
"""m; side of a cell, as fine as can be seen on a page."""
_ANOTHER_VISIT: Final = 6.0
"""s after which a cell that is swept again counts once more: neighbouring swaths overlap."""
_MOST: Final = 3
_LONGEST_STEP: Final = 0.3
"""m between two ticks; a longer one means that the robot was carried."""


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
        if math.hypot(x - from_x, y - from_y) > _LONGEST_STEP:
            from_x, from_y = x, y
        self._at = (x, y)
        reach, frame = self._radius, self.frame
        low_row, low_column = frame.cell_of(min(x, from_x) - reach, min(y, from_y) - reach)
        high_row, high_column = frame.cell_of(max(x, from_x) + reach, max(y, from_y) + reach)
        rows = np.arange(max(low_row, 0), min(high_row + 1, frame.rows))
        columns = np.arange(max(low_column, 0), min(high_column + 1, frame.columns))
        if not (rows.size and columns.size):
            return
        cell_x, cell_y = frame.centres(rows, columns)
        distance = _to_segment(cell_x[None, :], cell_y[:, None], from_x, from_y, x, y)
        under = distance <= reach
        area = np.ix_(rows, columns)
        counts, swept_at = self.counts[area], self._swept_at[area]
        fresh = under & (now - swept_at > _ANOTHER_VISIT)
        self.counts[area] = np.where(fresh, np.minimum(counts + 1, _MOST), counts)
        self._swept_at[area] = np.where(under, now, swept_at)


def _to_segment(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    from_x: float,
    from_y: float,
    to_x: float,
    to_y: float,
) -> NDArray[np.float64]:
    """Return the distance of points from a line between two points, m."""
    along_x, along_y = to_x - from_x, to_y - from_y
    length = along_x**2 + along_y**2
    share = np.zeros(np.broadcast_shapes(x.shape, y.shape))
    if length > 0.0:
        share = np.clip(((x - from_x) * along_x + (y - from_y) * along_y) / length, 0.0, 1.0)
    distance: NDArray[np.float64] = np.hypot(
        x - from_x - share * along_x, y - from_y - share * along_y
    )
    return distance
