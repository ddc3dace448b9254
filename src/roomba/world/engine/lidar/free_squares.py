"""How far rays of the lidar can go on from a cell without meeting anything solid.

For each cell and each of the four quadrants of directions: the side of the largest square of free
cells that has this cell in its corner and extends along both axes that way. A ray that is in the
cell and points there meets nothing inside of that square.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry

LARGEST: Final = 255
"""Cells; larger squares are told as this: a byte for each quadrant."""
RIGHT: Final = 8
UP: Final = 16
"""Bits by which the side is shifted whose square extends to larger x, and to larger y."""


def free_squares(solid: NDArray[np.bool_]) -> NDArray[np.uint32]:
    """Return the sides of the squares, in cells, uint32 [rows, columns], four bytes in each.

    ``solid`` is bool [rows, columns]; all outside is solid. A solid cell has 0.
    """
    squares: NDArray[np.uint32] = np.zeros(solid.shape, np.uint32)
    _note_squares(np.ascontiguousarray(solid), squares)
    return squares


@entry
def _note_squares(solid: NDArray[np.bool_], squares: NDArray[np.uint32]) -> None:
    """Fill in all squares: one is a cell longer than the least of the three that begin next to it.

    Those are the squares of the next cell along either axis, and of the one diagonally ahead.
    """
    rows, columns = solid.shape
    for shift in (0, RIGHT, UP, RIGHT + UP):
        to_column = 1 if shift & RIGHT else -1
        to_row = 1 if shift & UP else -1
        for i in range(rows):
            row = rows - 1 - i if to_row > 0 else i
            for j in range(columns):
                column = columns - 1 - j if to_column > 0 else j
                if solid[row, column]:
                    continue
                next_row, next_column = row + to_row, column + to_column
                side = 1
                if 0 <= next_row < rows and 0 <= next_column < columns:
                    beside = squares[row, next_column] >> shift & LARGEST
                    above = squares[next_row, column] >> shift & LARGEST
                    beyond = squares[next_row, next_column] >> shift & LARGEST
                    side = min(LARGEST, 1 + min(beside, above, beyond))
                squares[row, column] |= np.uint32(side << shift)
