"""A grid that is turned against that of the floor, so that rows of its cells run along walls.

Places in cells of the floor's window: (x, y) is (column, row), whole numbers are the cells'
centres.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from roomba.arrays import Floats, Mask
from roomba.compilation import allocating_entry


class TurnedCells(NamedTuple):
    """Cells, ``rows`` x ``columns``, whose first one is at (``x``, ``y``).

    The next column is a step (``step_x``, ``step_y``) further, the next row the same step turned
    to the left.
    """

    x: float
    y: float
    step_x: float
    step_y: float
    rows: int
    columns: int

    @classmethod
    def over(cls, rows: int, columns: int, angle: float, cell: float) -> TurnedCells:
        """Return turned cells that cover a window of the floor; ``angle`` is in rad.

        The window has ``rows`` x ``columns`` cells; the sides of turned cells are ``cell`` long.
        """
        cosine, sine = math.cos(angle), math.sin(angle)
        x, y = np.array([[0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0]])
        x, y = x * (columns - 1), y * (rows - 1)
        along, aside = x * cosine + y * sine, y * cosine - x * sine
        left, top = float(along.min()), float(aside.min())
        return cls(
            left * cosine - top * sine,
            left * sine + top * cosine,
            cell * cosine,
            cell * sine,
            math.ceil((float(aside.max()) - top) / cell) + 1,
            math.ceil((float(along.max()) - left) / cell) + 1,
        )

    def places(self, cells: Floats) -> Floats:
        """Return the places of (column, row) of these cells, float64 [..., 2] both."""
        column, row = cells[..., 0], cells[..., 1]
        places: Floats = np.stack(
            (
                self.x + column * self.step_x - row * self.step_y,
                self.y + column * self.step_y + row * self.step_x,
            ),
            axis=-1,
        )
        return places


@allocating_entry
def turned_mask(mask: Mask, cells: TurnedCells, x: int, y: int) -> Mask:
    """Return for each of ``cells`` the value of ``mask`` at its centre, bool [rows, columns].

    The cells cover a window of ``mask`` that begins at column ``x`` and row ``y``; false outside.
    """
    rows, columns = mask.shape
    found = np.zeros((cells.rows, cells.columns), np.bool_)
    for row in range(cells.rows):
        begin_x = cells.x + x + 0.5 - row * cells.step_y
        begin_y = cells.y + y + 0.5 + row * cells.step_x
        for column in range(cells.columns):
            at_x = math.floor(begin_x + column * cells.step_x)
            at_y = math.floor(begin_y + column * cells.step_y)
            if 0 <= at_x < columns and 0 <= at_y < rows:
                found[row, column] = mask[at_y, at_x]
    return found
