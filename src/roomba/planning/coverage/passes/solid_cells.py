"""The solid cells around outlines, and the search for the nearest point of them.

Places in cells: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from roomba.arrays import Floats, Ints32, Mask
from roomba.compilation import entry, inner_part


class Beside(NamedTuple):
    """For each cell the nearest solid cells of its row to both sides, and where cell (0, 0) lies.

    ``before`` and ``after`` are columns, int32 [rows, columns]: of the nearest solid cell up to
    this one, -1 if there is none; and from this one on, the number of columns if there is none.
    """

    before: Ints32
    after: Ints32
    column: int
    row: int


@dataclass(frozen=True, eq=False)
class SolidCells:
    """The solid cells: ``solid`` is bool [rows, columns].

    Cell (0, 0) of the outlines is at ``column`` and ``row`` of it. ``reach`` is the distance that
    the middle keeps from solid cells, cells. ``things`` are round and not part of ``solid``,
    float64 [n, 3]: x, y and radius.
    """

    solid: Mask
    column: int
    row: int
    reach: float
    things: Floats

    @cached_property
    def beside(self) -> Beside:
        """The nearest solid cells of each row to both sides; they are found once and kept."""
        shape = self.solid.shape
        beside = Beside(np.empty(shape, np.int32), np.empty(shape, np.int32), self.column, self.row)
        _note_beside(np.ascontiguousarray(self.solid), beside.before, beside.after)
        return beside


@entry
def _note_beside(solid: Mask, before: Ints32, after: Ints32) -> None:
    rows, columns = solid.shape
    for row in range(rows):
        nearest = -1
        for column in range(columns):
            if solid[row, column]:
                nearest = column
            before[row, column] = nearest
        nearest = columns
        for column in range(columns - 1, -1, -1):
            if solid[row, column]:
                nearest = column
            after[row, column] = nearest


@inner_part
def nearest_solid(beside: Beside, x: float, y: float, far: float) -> tuple[float, float, float]:
    """Return the nearest solid point, x and y, and how far away it is, cells.

    If there is none within ``far`` cells, return (0, 0) and an infinite distance.
    """
    rows, columns = beside.before.shape
    span = math.ceil(far) + 1
    row = math.floor(y + 0.5) + beside.row
    column = min(max(math.floor(x + 0.5) + beside.column, 0), columns - 1)
    best, best_x, best_y = far * far, 0.0, 0.0
    is_found = False
    for at_row in range(max(row - span, 0), min(row + span + 1, rows)):
        to_y = min(max(y, at_row - beside.row - 0.5), at_row - beside.row + 0.5)
        down = (to_y - y) * (to_y - y)
        if down > best:
            continue
        for side in range(2):
            at_column = beside.before[at_row, column] if side == 0 else beside.after[at_row, column]
            if not 0 <= at_column < columns:
                continue
            left = at_column - beside.column - 0.5
            to_x = min(max(x, left), left + 1.0)
            away = (to_x - x) * (to_x - x) + down
            if away < best or (not is_found and away <= best):
                best, best_x, best_y, is_found = away, to_x, to_y, True
    return best_x, best_y, math.sqrt(best) if is_found else math.inf
