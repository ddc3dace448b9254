"""Correlative scan matching in a wide window, by branch and bound.

The points of a place, and the lines between neighbours on one plane surface, make a likelihood
field: a grid of how likely a surface is in each cell. So few or far beams show it as well as many.
Coarser grids above it hold the maximum over blocks of 2, 4, 8 ... cells, which bounds the score of
all shifts within a block. The search goes from coarse to fine and prunes blocks whose bound does
not exceed the best score, so that it finds the best pose of the window (Hess et al., "Real-time
loop closure in 2D LIDAR SLAM", ICRA 2016; Olson, "Real-time correlative scan matching", ICRA 2009).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, allocating_part, entry, inner_part, part

Floats = NDArray[np.float64]
Likelihoods = NDArray[np.uint8]
Cells = NDArray[np.int32]

_CELL: Final = 0.05
"""m; of the finest grid."""
_LEVELS: Final = 6
_BLUR: Final = 0.06
"""m; standard deviation of where a surface may be."""
_TURN_STEP: Final = 0.012
"""rad; a cell and a bit at the usual range of 5 m."""
_MOST_POINTS: Final = 250
"""More make the search no surer."""
_FULL: Final = 255
_PARALLEL: Final = 0.9
"""Cosine between the normals of two points of one plane surface, at least."""
_WIDEST_GAP: Final = 0.6
"""m; between neighbouring beams that meet one surface, at most."""
_ANOTHER: Final = 0.8
"""m; a pose that is farther from a match is of another place."""
_NEARLY: Final = 0.8
"""Share of a match's score with which another place is not to be told from it."""


def is_in_reach(points: Floats, reach: float) -> bool:
    """Whether some of the points of a place, [n, 2 or more], are within ``reach``, m, of it."""
    return len(_within(points, reach)) > 0


@dataclass(frozen=True, slots=True, eq=False)
class CorrelativeMatch:
    """The best pose of a window, float64 [3], and the mean likelihood of the points there, 0..1."""

    pose: Floats
    score: float


class CorrelativeMatcher:
    """Finds points on those of one place, float64 [n, 4], x, y, m, and normal, in its frame."""

    def __init__(self, points: Floats, reach: float) -> None:
        """Make the grids; raises ValueError without a point within ``reach``, m, of the origin.

        Farther points are left out, of the place and of what is found on it: their bearing is less
        sure.
        """
        self._reach = reach
        near = np.ascontiguousarray(_within(points, reach))
        if not len(near):
            raise ValueError("expected points in reach, got none")
        room = 1 << (_LEVELS - 1)
        first = np.floor(near[:, :2].min(axis=0) / _CELL).astype(np.int64) - 4 - room
        last = np.floor(near[:, :2].max(axis=0) / _CELL).astype(np.int64) + 4
        self._corner = first * _CELL
        columns, rows = (last - first + 1).tolist()
        self._levels = np.zeros((_LEVELS, rows, columns), np.uint8)
        _spread_out(near, self._corner, _CELL, _BLUR, self._levels[0])
        _heighten(self._levels)

    def best(
        self, points: Floats, around: Floats, window: float, turn: float, least: float
    ) -> CorrelativeMatch | None:
        """Return the best pose within ``window``, m, and ``turn``, rad, of a pose [3].

        ``points`` are float64 [n, 2 or more], x, y, m, about where they were seen from. None if no
        pose has a mean likelihood of more than ``least``, 0..1.
        """
        return self._best(points, around, window, turn, least, np.zeros(3))

    def is_unique(
        self,
        points: Floats,
        match: CorrelativeMatch,
        around: Floats,
        window: float,
        turn: float,
    ) -> bool:
        """Whether no other place in a window, as in :meth:`best`, fits nearly as well as a match.

        In a corridor that looks alike all along one does.
        """
        beside = np.array([*(match.pose[:2] - around[:2]), _ANOTHER])
        return self._best(points, around, window, turn, _NEARLY * match.score, beside) is None

    def _best(
        self,
        points: Floats,
        around: Floats,
        window: float,
        turn: float,
        least: float,
        beside: Floats,
    ) -> CorrelativeMatch | None:
        """Return the best pose in a window, as :meth:`best`; ``beside`` is as in ``_search``."""
        near = _within(points, self._reach)
        stride = max(1, -(-len(near) // _MOST_POINTS))
        few = np.ascontiguousarray(near[::stride, :2])
        found = np.empty(4)
        if not len(few) or not _search(
            self._levels, self._corner, _CELL, few, around, window, turn, _TURN_STEP, least, beside,
            found,
        ):  # fmt: skip
            return None
        return CorrelativeMatch(found[:3].copy(), float(found[3]))


def _within(points: Floats, reach: float) -> Floats:
    """Return the points, [n, 2 or more], that are within ``reach``, m, of their origin."""
    near: Floats = points[np.hypot(points[:, 0], points[:, 1]) < reach]
    return near


@entry
def _spread_out(
    points: Floats, corner: Floats, cell: float, blur: float, grid: Likelihoods
) -> None:
    """Fill a grid, uint8 [rows, columns], with how likely a surface is in each cell.

    Where neighbours among ``points`` [n, 4] lie on one plane surface, so does what is between them.
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
            likelihood = np.uint8(_FULL * math.exp(-0.5 * square))
            grid[row, column] = max(grid[row, column], likelihood)


@entry
def _heighten(levels: Likelihoods) -> None:
    """Fill each grid with the greatest of blocks of 2^level cells that begin at the cell."""
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


@inner_part
def _score(grid: Likelihoods, columns: Cells, rows: Cells, right: int, up: int) -> float:
    """Return the mean likelihood of points in cells that are shifted right and up, 0..1."""
    total = 0
    for index in range(columns.size):
        row, column = rows[index] + up, columns[index] + right
        if 0 <= row < grid.shape[0] and 0 <= column < grid.shape[1]:
            total += grid[row, column]
    return total / (columns.size * float(_FULL))


@allocating_part
def _cells_of(
    points: Floats,
    around: Floats,
    corner: Floats,
    cell: float,
    turns: int,
    turn_step: float,
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
            columns[angle, index] = math.floor((x - corner[0]) / cell)
            rows[angle, index] = math.floor((y - corner[1]) / cell)
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
def _is_near(right: int, up: int, size: int, x: float, y: float, square: float) -> bool:
    """Whether no shift of a block, ``size`` cells a side, counts: all are near the shift x, y.

    ``square`` is that of the distance, cells, from which on a shift counts. The corner of the block
    that is farthest off decides.
    """
    far_x = max(abs(right - x), abs(right + size - 1 - x))
    far_y = max(abs(up - y), abs(up + size - 1 - y))
    return far_x * far_x + far_y * far_y < square


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

    From ``first`` on the stack stays in the order of bounds: the best is taken next.
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


@allocating_entry
def _search(
    levels: Likelihoods,
    corner: Floats,
    cell: float,
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

    ``levels`` is uint8 [levels, rows, columns], the finest grid first, whose lower left corner is
    ``corner`` [2], m, and whose cells are ``cell``, m. ``points`` [n, 2], m, are placed at
    ``around`` [3] and up to ``window``, m, and ``turn``, rad, beside it, in steps of a cell and
    ``turn_step``, rad. Shifts that are less than ``beside[2]``, m, off ``beside[:2]`` do not count.
    Returns whether a score exceeds ``least``.
    """
    top = levels.shape[0] - 1
    beside_x, beside_y, beside_square = beside[0] / cell, beside[1] / cell, (beside[2] / cell) ** 2
    turns, reach = math.ceil(turn / turn_step), math.ceil(window / cell)
    columns, rows = _cells_of(points, around, corner, cell, turns, turn_step)
    scores, places = _largest_blocks(levels[top], columns, rows, 1 << top, reach)
    best, best_angle, best_right, best_up = least, -1, 0, 0
    pending = np.empty((4 * (top + 1), 4), np.int32)
    bounds = np.empty(4 * (top + 1))
    for candidate in np.argsort(-scores):
        if scores[candidate] <= best:
            break
        pending[0, 0], pending[0, 1] = top, places[candidate, 0]
        pending[0, 2], pending[0, 3] = places[candidate, 1], places[candidate, 2]
        bounds[0] = scores[candidate]
        waiting = 1
        while waiting > 0:
            waiting -= 1
            if bounds[waiting] <= best:
                continue
            level, angle = pending[waiting, 0], pending[waiting, 1]
            right, up = pending[waiting, 2], pending[waiting, 3]
            if _is_near(right, up, 1 << level, beside_x, beside_y, beside_square):
                continue
            if level == 0:
                best, best_angle, best_right, best_up = bounds[waiting], angle, right, up
                continue
            half = 1 << (level - 1)
            first = waiting
            for quarter in range(4):
                next_right, next_up = right + half * (quarter % 2), up + half * (quarter // 2)
                if next_right > reach or next_up > reach:
                    continue
                bound = _score(levels[level - 1], columns[angle], rows[angle], next_right, next_up)
                if bound <= best:
                    continue
                block = level - 1, angle, next_right, next_up
                _insert(bounds, pending, first, waiting, bound, block)
                waiting += 1
    if best_angle < 0:
        return False
    found[0], found[1] = around[0] + best_right * cell, around[1] + best_up * cell
    found[2], found[3] = around[2] + (best_angle - turns) * turn_step, best
    return True
