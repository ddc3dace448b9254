"""Compiled kernels: compare the sides of solid cells of two maps, and find the visible floor."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask
from roomba.compilation import entry, part

ROW_STEPS: Final = (0, 1, 0, -1)
COLUMN_STEPS: Final = (1, 0, -1, 0)
"""Steps to the neighbours of a cell: along x, along y, and back; a side's facing is such an
index."""


class TrueSurfaces(NamedTuple):
    """A true map as kernels know it: ``solid``, and what of the rest is ``seen``, bool
    [rows, columns]; ``place`` is the lower left corner x, y and the cell size, m.
    """

    solid: Mask
    seen: Mask
    place: Floats


@entry
def nearest_sides(ground: TrueSurfaces, points: Floats, reach: float, away: Floats) -> None:
    """Fill ``away`` [n], m, with how far ``points`` [n, 2] are from the nearest true side.

    Infinite where there is none within ``reach``. A side lies between a solid and a seen cell.
    """
    size = ground.place[2]
    cells = math.ceil(reach / size) + 1
    rows, columns = ground.solid.shape
    for index in range(points.shape[0]):
        u = (points[index, 0] - ground.place[0]) / size
        v = (points[index, 1] - ground.place[1]) / size
        row, column = math.floor(v), math.floor(u)
        best = math.inf
        for at_row in range(max(row - cells, 0), min(row + cells + 1, rows)):
            for at_column in range(max(column - cells, 0), min(column + cells + 1, columns)):
                if not ground.solid[at_row, at_column]:
                    continue
                for facing in range(4):
                    if is_side(ground, at_row, at_column, facing):
                        square = _square_to_side(u, v, at_row, at_column, facing)
                        best = min(best, square)
        far = math.sqrt(best) * size
        away[index] = far if far <= reach else math.inf


@entry
def offsets(
    ground: TrueSurfaces, points: Floats, facings: NDArray[np.int64], reach: float, off: Floats
) -> None:
    """Fill ``off`` [n], m, with how far ``points`` lie before the true side that faces alike.

    NaN where none lies within ``reach`` straight before or behind.
    """
    size = ground.place[2]
    rows, columns = ground.solid.shape
    cells = math.ceil(reach / size) + 1
    for index in range(points.shape[0]):
        facing = facings[index]
        step_row, step_column = ROW_STEPS[facing], COLUMN_STEPS[facing]
        u = (points[index, 0] - ground.place[0]) / size
        v = (points[index, 1] - ground.place[1]) / size
        row, column = math.floor(v), math.floor(u)
        off[index] = math.nan
        best = reach
        for step in range(-cells, cells + 1):
            at_row, at_column = row + step * step_row, column + step * step_column
            if not (0 <= at_row < rows and 0 <= at_column < columns):
                continue
            if not is_side(ground, at_row, at_column, facing):
                continue
            before = _before_side(u, v, at_row, at_column, step_row, step_column) * size
            if abs(before) <= best:
                best = abs(before)
                off[index] = before


@entry
def count_surfaces(
    ground: TrueSurfaces, points: Floats, facings: NDArray[np.int64], behind: float, beside: float,
    counts: NDArray[np.int64],
) -> None:  # fmt: skip
    """Fill ``counts`` [n] with how many sides of the same facing lie straight behind ``points``.

    Counted from ``beside`` before to ``behind`` behind a point, m, on three lines that are
    ``beside`` apart; the most on a line counts.
    """
    size = ground.place[2]
    rows, columns = ground.solid.shape
    for index in range(points.shape[0]):
        facing = facings[index]
        step_row, step_column = ROW_STEPS[facing], COLUMN_STEPS[facing]
        most = 0
        for line in range(-1, 2):
            x = points[index, 0] + line * beside * step_row
            y = points[index, 1] + line * beside * step_column
            u, v = (x - ground.place[0]) / size, (y - ground.place[1]) / size
            row, column = math.floor(v), math.floor(u)
            found = 0
            cells = math.ceil((behind + beside) / size) + 1
            for step in range(-cells, cells + 1):
                at_row, at_column = row + step * step_row, column + step * step_column
                if not (0 <= at_row < rows and 0 <= at_column < columns):
                    continue
                if not is_side(ground, at_row, at_column, facing):
                    continue
                before = _before_side(u, v, at_row, at_column, step_row, step_column) * size
                if -beside - 1e-9 <= before <= behind + beside + 1e-9:
                    found += 1
            most = max(most, found)
        counts[index] = most


@part
def is_side(ground: TrueSurfaces, row: int, column: int, facing: int) -> bool:
    """Whether a cell is solid, and the one beside it on that side seen."""
    rows, columns = ground.solid.shape
    beside_row, beside_column = row + ROW_STEPS[facing], column + COLUMN_STEPS[facing]
    if not (0 <= beside_row < rows and 0 <= beside_column < columns):
        return False
    return bool(ground.solid[row, column] and ground.seen[beside_row, beside_column])


@part
def _before_side(
    u: float, v: float, row: int, column: int, step_row: int, step_column: int
) -> float:
    """Return how far a point lies before a cell's side that faces along a step, in cells."""
    plane = (column + 0.5 + 0.5 * step_column) * abs(step_column)
    plane += (row + 0.5 + 0.5 * step_row) * abs(step_row)
    along = u * abs(step_column) + v * abs(step_row)
    return (along - plane) * (step_column + step_row)


@part
def _square_to_side(u: float, v: float, row: int, column: int, facing: int) -> float:
    """Return the squared distance, cells, from a point to one side of a cell."""
    if facing % 2 == 0:
        along = column + (1.0 if facing == 0 else 0.0) - u
        across = max(row - v, v - row - 1.0, 0.0)
    else:
        along = row + (1.0 if facing == 1 else 0.0) - v
        across = max(column - u, u - column - 1.0, 0.0)
    return along * along + across * across


@entry
def see_around(
    solid: Mask, rows: NDArray[np.int64], columns: NDArray[np.int64], beams: int, reach: float,
    seen: Mask,
) -> None:  # fmt: skip
    """Set the cells of ``seen`` through which beams go from the middles of cells.

    ``reach`` in cells; a beam ends before the first solid cell (Amanatides and Woo, 1987).
    """
    height, width = solid.shape
    for at in range(rows.size):
        for beam in range(beams):
            # Half a step off, so that no beam runs along the cells' corners.
            angle = 2.0 * math.pi * (beam + 0.5) / beams
            along_u, along_v = math.cos(angle), math.sin(angle)
            row, column = rows[at], columns[at]
            step_u, step_v = (1 if along_u > 0.0 else -1), (1 if along_v > 0.0 else -1)
            per_u, per_v = abs(1.0 / along_u), abs(1.0 / along_v)
            next_u, next_v = 0.5 * per_u, 0.5 * per_v
            while 0 <= row < height and 0 <= column < width and not solid[row, column]:
                seen[row, column] = True
                if min(next_u, next_v) > reach:
                    break
                if next_u < next_v:
                    column += step_u
                    next_u += per_u
                else:
                    row += step_v
                    next_v += per_v
