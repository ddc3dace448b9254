"""Compiled ways of a bundle of beams to the nearest solid cells, by free squares.

Each beam has the result of :func:`.ray_kernels.ray_to_cells`, to the last bit. Nothing of a step
branches, so that the compiler works on eight beams together: beams go on in step, and one that has
arrived waits for the others. Counted in cells, from the lower left corner of the grid.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import inner_part
from roomba.world.engine.lidar.bundle_kernels import BUNDLE
from roomba.world.engine.lidar.free_squares import MARGIN, RIGHT, UP
from roomba.world.engine.lidar.ray_kernels import inverse_of
from roomba.world.engine.state.arrays import Row


@inner_part
def march(beams: Row, squares: NDArray[np.uint8], home: Row, reach: float) -> None:
    """Find the way of each beam, m, and the cosine of the angle to the normal of what it meets.

    The bundle must be aimed; the results are its ``way`` and ``facing``, (inf, 1) if nothing is
    within ``reach``, m. All outside of the grid is solid.
    """
    farthest = reach / home.resolution
    set_off(beams, home)
    while True:
        for number in range(BUNDLE):
            # Unsigned: numba then does not check whether an index counts from the end.
            quadrant, place = np.uint64(beams.quadrant[number]), np.uint64(beams.place[number])
            beams.side[number] = float(squares[quadrant, place])
        if not go_on(beams, home, farthest):
            break
    arrive(beams, home, farthest)


@inner_part
def set_off(beams: Row, home: Row) -> None:
    """Put each beam into the cell where it begins; from outside into the margin around the grid."""
    top, right = float(home.rows), float(home.columns)
    for number in range(BUNDLE):
        cosine, sine = beams.cosine[number], beams.sine[number]
        x = (beams.x[number] - home.left) / home.resolution
        y = (beams.y[number] - home.bottom) / home.resolution
        beams.cell_x[number], beams.cell_y[number] = x, y
        beams.per_column[number], beams.per_row[number] = inverse_of(cosine), inverse_of(sine)
        beams.column[number] = min(max(np.floor(x), -1.0), right)
        beams.row[number] = min(max(np.floor(y), -1.0), top)
        quadrant = (RIGHT if cosine >= 0.0 else 0) + (UP if sine >= 0.0 else 0)
        beams.quadrant[number] = quadrant
        beams.place[number] = place_of(home, beams.column[number], beams.row[number])
        beams.way[number], beams.facing[number] = 0.0, 1.0


@inner_part
def place_of(home: Row, column: float, row: float) -> np.int32:
    """Return where the free squares of a cell stand, in those of its quadrant."""
    width = home.columns + 2 * MARGIN
    first = home.squares_at + MARGIN * width + MARGIN
    return np.int32(float(first) + row * float(width) + column)


@inner_part
def go_on(beams: Row, home: Row, farthest: float) -> int:
    """Let each beam cross its free square; return how many did.

    A beam never goes back to an earlier column or row, as rounding at a corner might make it.
    """
    going = 0
    for number in range(BUNDLE):
        x, y, along = beams.cell_x[number], beams.cell_y[number], beams.way[number]
        column, row, side = beams.column[number], beams.row[number], beams.side[number]
        cosine, sine = beams.cosine[number], beams.sine[number]
        goes_right, goes_up = cosine >= 0.0, sine >= 0.0
        goes = (side > 0.0) & (along <= farthest)
        line_x = column + side if goes_right else column + 1.0 - side
        line_y = row + side if goes_up else row + 1.0 - side
        across_x = (line_x - x) * beams.per_column[number]
        across_y = (line_y - y) * beams.per_row[number]
        is_column = across_x < across_y
        along = max(along, min(across_x, across_y))
        # Into the next column, which is beyond a line, or into the next row.
        beside_x, beside_y = np.floor(x + along * cosine), np.floor(y + along * sine)
        beside_x = max(column, beside_x) if goes_right else min(column, beside_x)
        beside_y = max(row, beside_y) if goes_up else min(row, beside_y)
        beyond_x = line_x if goes_right else line_x - 1.0
        beyond_y = line_y if goes_up else line_y - 1.0
        next_column = beyond_x if is_column else beside_x
        next_row = beside_y if is_column else beyond_y
        column, row = next_column if goes else column, next_row if goes else row
        facing = abs(cosine) if is_column else abs(sine)
        beams.column[number], beams.row[number] = column, row
        beams.place[number] = place_of(home, column, row)
        beams.way[number] = along if goes else beams.way[number]
        beams.facing[number] = facing if goes else beams.facing[number]
        going += 1 if goes else 0
    return going


@inner_part
def arrive(beams: Row, home: Row, farthest: float) -> None:
    """Turn ways of cells into metres."""
    for number in range(BUNDLE):
        is_near = beams.way[number] <= farthest
        beams.facing[number] = beams.facing[number] if is_near else 1.0
        beams.way[number] = beams.way[number] * home.resolution if is_near else math.inf
