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
"""Cells; larger squares count as this, so that a byte is enough for each."""
QUADRANTS: Final = 4
RIGHT: Final = 1
UP: Final = 2
"""A quadrant's number: RIGHT if it extends to larger x, plus UP if it extends to larger y."""
MARGIN: Final = 1
"""Cells around the grid for which squares are kept as well; they are solid."""


def free_squares(solid: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return the sides of the squares, cells, uint8 [QUADRANTS, rows + 2, columns + 2].

    ``solid`` is bool [rows, columns]; all outside is solid. A solid cell has 0.
    """
    squares = np.zeros((QUADRANTS, *(size + 2 * MARGIN for size in solid.shape)), np.uint8)
    _note_squares(np.ascontiguousarray(solid), squares)
    return squares


@entry
def _note_squares(solid: NDArray[np.bool_], squares: NDArray[np.uint8]) -> None:
    """Fill in all squares: each is one cell larger than the least of three squares next to it.

    Those are the squares of the next cell along either axis, and of the cell diagonally ahead.
    """
    rows, columns = solid.shape
    for quadrant in range(QUADRANTS):
        to_column = 1 if quadrant & RIGHT else -1
        to_row = 1 if quadrant & UP else -1
        for i in range(rows):
            row = rows - 1 - i if to_row > 0 else i
            for j in range(columns):
                column = columns - 1 - j if to_column > 0 else j
                if solid[row, column]:
                    continue
                here, beyond = row + MARGIN, row + MARGIN + to_row
                beside = column + MARGIN + to_column
                least = min(
                    squares[quadrant, here, beside],
                    squares[quadrant, beyond, column + MARGIN],
                    squares[quadrant, beyond, beside],
                )
                squares[quadrant, here, column + MARGIN] = min(LARGEST, 1 + least)
