"""The likelihood of a surface in each cell of a grid over one place, and coarser grids of bounds.

The points of a place, and the lines between neighbours on one plane surface, are spread out over
the cells around them. So few or far beams show a place as well as many. Each coarser grid holds the
maximum over blocks of 2, 4, 8 ... cells (Hess et al., "Real-time loop closure in 2D LIDAR SLAM",
ICRA 2016).
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import entry, inner_part

Likelihoods = NDArray[np.uint8]

FULL: Final = 255
"""The value that stands for a likelihood of 1."""
_CELL: Final = 0.05
"""m; of the finest grid."""
_LEVELS: Final = 6
_BLUR: Final = 0.06
"""m; standard deviation of where a surface may be."""
_PARALLEL: Final = 0.9
"""Cosine between the normals of two points of one plane surface, at least."""
_WIDEST_GAP: Final = 0.6
"""m; between neighbouring beams that meet one surface, at most."""


class LikelihoodField(NamedTuple):
    """The grids ``levels``, uint8 [levels, rows, columns], the finest one first.

    ``corner``, float64 [2], m, is the lower left corner of all grids; ``cell``, m, the side of a
    cell of the finest one.
    """

    levels: Likelihoods
    corner: Floats
    cell: float


def likelihood_field(points: Floats) -> LikelihoodField:
    """Return how likely surfaces are around the points of a place, float64 [n, 4], n > 0.

    Points are x, y, m, and normal; neighbours in a scan come one after the other.
    """
    room = 1 << (_LEVELS - 1)
    first = np.floor(points[:, :2].min(axis=0) / _CELL).astype(np.int64) - 4 - room
    last = np.floor(points[:, :2].max(axis=0) / _CELL).astype(np.int64) + 4
    corner = first * _CELL
    columns, rows = (last - first + 1).tolist()
    levels = np.zeros((_LEVELS, rows, columns), np.uint8)
    _spread_out(points, corner, _CELL, _BLUR, levels[0])
    _heighten(levels)
    return LikelihoodField(levels, corner, _CELL)


@entry
def _spread_out(
    points: Floats, corner: Floats, cell: float, blur: float, grid: Likelihoods
) -> None:
    """Fill a grid, uint8 [rows, columns], with how likely a surface is in each cell.

    If neighbours among ``points`` [n, 4] lie on one plane surface, the line between them does, too.
    """
    for index in range(points.shape[0]):
        x, y = points[index, 0], points[index, 1]
        _mark(x, y, corner, cell, blur, grid)
        if index == 0 or not _is_one_surface(points[index - 1], points[index], blur):
            continue
        off_x, off_y = x - points[index - 1, 0], y - points[index - 1, 1]
        parts = math.ceil(math.hypot(off_x, off_y) / cell)
        for part_of in range(1, parts):
            share = part_of / parts
            _mark(x - share * off_x, y - share * off_y, corner, cell, blur, grid)


@inner_part
def _is_one_surface(one: Floats, other: Floats, deviation: float) -> bool:
    """Whether two points, [4] with normals, lie on one plane surface without a gap."""
    off_x, off_y = other[0] - one[0], other[1] - one[1]
    return (
        one[2] * other[2] + one[3] * other[3] > _PARALLEL
        and abs(off_x * one[2] + off_y * one[3]) < deviation
        and abs(off_x * other[2] + off_y * other[3]) < deviation
        and math.hypot(off_x, off_y) < _WIDEST_GAP
    )


@inner_part
def _mark(x: float, y: float, corner: Floats, cell: float, blur: float, grid: Likelihoods) -> None:
    """Note in the cells around a point, m, how likely its surface is there."""
    rows, columns = grid.shape
    reach = math.ceil(2.5 * blur / cell)
    u, v = (x - corner[0]) / cell, (y - corner[1]) / cell
    middle_column, middle_row = math.floor(u), math.floor(v)
    for row in range(max(middle_row - reach, 0), min(middle_row + reach + 1, rows)):
        for column in range(max(middle_column - reach, 0), min(middle_column + reach + 1, columns)):
            off_u, off_v = (column + 0.5 - u) * cell, (row + 0.5 - v) * cell
            square = (off_u * off_u + off_v * off_v) / (blur * blur)
            likelihood = np.uint8(FULL * math.exp(-0.5 * square))
            grid[row, column] = max(grid[row, column], likelihood)


@entry
def _heighten(levels: Likelihoods) -> None:
    """Fill each coarser grid with maxima over blocks of 2^level cells a side, from each cell on."""
    rows, columns = levels.shape[1], levels.shape[2]
    for level in range(1, levels.shape[0]):
        half = 1 << (level - 1)
        below, here = levels[level - 1], levels[level]
        for row in range(rows):
            next_row = min(row + half, rows - 1)
            for column in range(columns):
                next_column = min(column + half, columns - 1)
                here[row, column] = max(
                    max(below[row, column], below[row, next_column]),
                    max(below[next_row, column], below[next_row, next_column]),
                )
