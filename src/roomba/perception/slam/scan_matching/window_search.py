"""Compiled: the best pose of a window in a likelihood field, by branch and bound.

A coarser grid bounds the score of all shifts within a block. The search goes from coarse to fine
and prunes blocks whose bound does not exceed the best score, so that it finds the best pose of the
window (Hess et al., "Real-time loop closure in 2D LIDAR SLAM", ICRA 2016).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, allocating_part, inner_part, part
from roomba.perception.slam.scan_matching.likelihood_field import FULL, LikelihoodField, Likelihoods

Cells = NDArray[np.int32]


@allocating_entry
def search(
    field: LikelihoodField,
    points: Floats,
    around: Floats,
    window: float,
    turn: float,
    turn_step: float,
    least: float,
    beside: Floats,
    found: Floats,
) -> bool:
    """Fill ``found`` [4] with the best pose, x, y, m, theta, rad, and its score, 0..1.

    ``points`` [n, 2], m, are placed at ``around`` [3] and up to ``window``, m, and ``turn``, rad,
    beside it, in steps of a cell and ``turn_step``, rad. Shifts that are less than ``beside[2]``,
    m, off ``beside[:2]`` do not count. Returns whether a score exceeds ``least``.
    """
    top = field.levels.shape[0] - 1
    turns, reach = math.ceil(turn / turn_step), math.ceil(window / field.cell)
    columns, rows = _cells_of(points, around, field, turns, turn_step)
    scores, blocks = _largest_blocks(field.levels[top], columns, rows, 1 << top, reach)
    best = np.array([least, -1.0, 0.0, 0.0])
    bounds, pending = np.empty(4 * (top + 1)), np.empty((4 * (top + 1), 4), np.int32)
    beside_cells = beside / field.cell
    for candidate in np.argsort(-scores):
        if scores[candidate] <= best[0]:
            break
        bounds[0], pending[0, 0] = scores[candidate], top
        for axis in range(3):
            pending[0, axis + 1] = blocks[candidate, axis]
        _refine(field.levels, columns, rows, reach, beside_cells, bounds, pending, best)
    if best[1] < 0.0:
        return False
    found[0], found[1] = around[0] + best[2] * field.cell, around[1] + best[3] * field.cell
    found[2], found[3] = around[2] + (best[1] - turns) * turn_step, best[0]
    return True


@allocating_part
def _cells_of(
    points: Floats, around: Floats, field: LikelihoodField, turns: int, turn_step: float
) -> tuple[Cells, Cells]:
    """Return columns and rows of points that are placed at ``around``, int32 [2 * turns + 1, n].

    Each line is of a heading that is ``turn_step``, rad, further than that of the line before it;
    the middle one is of the heading of ``around``.
    """
    count, angles = points.shape[0], 2 * turns + 1
    columns = np.empty((angles, count), np.int32)
    rows = np.empty((angles, count), np.int32)
    for angle in range(angles):
        theta = around[2] + (angle - turns) * turn_step
        cosine, sine = math.cos(theta), math.sin(theta)
        for index in range(count):
            x = around[0] + cosine * points[index, 0] - sine * points[index, 1]
            y = around[1] + sine * points[index, 0] + cosine * points[index, 1]
            columns[angle, index] = math.floor((x - field.corner[0]) / field.cell)
            rows[angle, index] = math.floor((y - field.corner[1]) / field.cell)
    return columns, rows


@allocating_part
def _largest_blocks(
    grid: Likelihoods, columns: Cells, rows: Cells, block: int, reach: int
) -> tuple[Floats, Cells]:
    """Return the bounds [n] of all blocks of the coarsest grid, and angle, right and up [n, 3].

    They cover shifts of up to ``reach`` cells; each has ``block`` cells a side.
    """
    angles, per_side = columns.shape[0], 2 * reach // block + 1
    scores = np.empty(angles * per_side * per_side)
    places = np.empty((angles * per_side * per_side, 3), np.int32)
    many = 0
    for angle in range(angles):
        for across in range(per_side):
            for along in range(per_side):
                right, up = along * block - reach, across * block - reach
                scores[many] = _score(grid, columns[angle], rows[angle], right, up)
                places[many, 0], places[many, 1], places[many, 2] = angle, right, up
                many += 1
    return scores, places


@part
def _refine(
    levels: Likelihoods,
    columns: Cells,
    rows: Cells,
    reach: int,
    beside: Floats,
    bounds: Floats,
    pending: Cells,
    best: Floats,
) -> None:
    """Look through a block for a better shift than the ``best``: score, angle, right and up.

    The block, (level, angle, right, up), and its bound are the first rows of ``pending`` [n, 4] and
    ``bounds`` [n], the stack of waiting blocks. ``beside`` is as in :func:`search`, in cells.
    """
    waiting = 1
    while waiting > 0:
        waiting -= 1
        bound = bounds[waiting]
        if bound <= best[0]:
            continue
        level, angle = pending[waiting, 0], pending[waiting, 1]
        right, up = pending[waiting, 2], pending[waiting, 3]
        if _is_near(right, up, 1 << level, beside):
            continue
        if level == 0:
            best[0], best[1], best[2], best[3] = bound, angle, right, up
            continue
        half, first = 1 << (level - 1), waiting
        for quarter in range(4):
            next_right, next_up = right + half * (quarter % 2), up + half * (quarter // 2)
            if next_right > reach or next_up > reach:
                continue
            bound = _score(levels[level - 1], columns[angle], rows[angle], next_right, next_up)
            if bound <= best[0]:
                continue
            block = level - 1, angle, next_right, next_up
            _insert(bounds, pending, first, waiting, bound, block)
            waiting += 1


@part
def _is_near(right: int, up: int, size: int, beside: Floats) -> bool:
    """Whether all shifts of a block, ``size`` cells a side, are near ``beside[:2]``: none counts.

    A shift counts if it is ``beside[2]``, cells, or more away. So the farthest corner of the block
    decides.
    """
    far_x = max(abs(right - beside[0]), abs(right + size - 1 - beside[0]))
    far_y = max(abs(up - beside[1]), abs(up + size - 1 - beside[1]))
    is_near: bool = far_x * far_x + far_y * far_y < beside[2] * beside[2]
    return is_near


@inner_part
def _insert(
    bounds: Floats,
    pending: Cells,
    first: int,
    waiting: int,
    bound: float,
    block: tuple[int, int, int, int],
) -> None:
    """Put a block, (level, angle, right, up), on the stack of ``waiting`` ones.

    From ``first`` on the stack is kept in the order of bounds, so that the best is taken next.
    """
    place = waiting
    while place > first and bounds[place - 1] > bound:
        bounds[place] = bounds[place - 1]
        for column in range(4):
            pending[place, column] = pending[place - 1, column]
        place -= 1
    bounds[place] = bound
    pending[place, 0], pending[place, 1] = block[0], block[1]
    pending[place, 2], pending[place, 3] = block[2], block[3]


@inner_part
def _score(grid: Likelihoods, columns: Cells, rows: Cells, right: int, up: int) -> float:
    """Return the mean likelihood of points in cells that are shifted right and up, 0..1."""
    total = 0
    for index in range(columns.size):
        row, column = rows[index] + up, columns[index] + right
        if 0 <= row < grid.shape[0] and 0 <= column < grid.shape[1]:
            total += grid[row, column]
    return total / (columns.size * float(FULL))
