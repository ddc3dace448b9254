"""Compiled sweeping: which cells of floor the tool passed over, and how often; and their counts."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_entry, entry, inner_part, part
from roomba.perception.swept.coverage_bits import SWEPT, WANTED

Cells = NDArray[np.uint8]

LONGEST_STEP: Final = 0.3
"""m; a larger step between two ticks means that the robot was carried."""


@entry
def swept_from(last_x: float, last_y: float, x: float, y: float) -> tuple[float, float]:
    """Return where the tool's way to a place began, m: at the last place, if it drove from there.

    If the last place is too far away, or not finite, the way begins at the place itself.
    """
    if math.hypot(x - last_x, y - last_y) <= LONGEST_STEP:
        return last_x, last_y
    return x, y


@entry
def sweep(
    cells: Cells,
    place: NDArray[np.float64],
    from_x: float,
    from_y: float,
    to_x: float,
    to_y: float,
    radius: float,
) -> int:
    """Mark as SWEPT the cells whose middle a moving disc passes over; return the new WANTED ones.

    The disc of ``radius`` m goes straight from one point to another, m. ``place`` is x and y of the
    middle of the first cell, and the resolution, m.
    """
    window = _window(cells.shape, place, (from_x, from_y, to_x, to_y), radius)
    first_row, end_row, first_column, end_column = window
    way_x, way_y = to_x - from_x, to_y - from_y
    inverse = _inverse_square(way_x, way_y)
    most = radius * radius
    found = 0
    for row in range(first_row, end_row):
        dy = place[1] + row * place[2] - from_y
        for column in range(first_column, end_column):
            value = cells[row, column]
            if value & SWEPT:
                continue
            dx = place[0] + column * place[2] - from_x
            if _squared_distance(dx, dy, way_x, way_y, inverse) <= most:
                cells[row, column] = value | SWEPT
                if value & WANTED:
                    found += 1
    return found


@entry
def visit(
    counts: Cells,
    swept_at: NDArray[np.float64],
    place: NDArray[np.float64],
    rule: tuple[float, float, int],
    poses: NDArray[np.float64],
) -> None:
    """Count a visit to each cell whose middle a disc passes over on its way along ``poses``.

    ``poses`` is float64 [n, 3]: s, m, m. Between poses farther apart than LONGEST_STEP the robot
    was carried. ``place`` is as in :func:`sweep`; ``swept_at``, s, tells when a cell was last
    passed. ``rule`` is the radius of the disc, m, after how many s without a pass a cell counts
    anew, and the highest count.
    """
    radius, apart, highest = rule
    most = radius * radius
    for number in range(1, len(poses)):
        now, to_x, to_y = poses[number]
        from_x, from_y = swept_from(poses[number - 1, 1], poses[number - 1, 2], to_x, to_y)
        window = _window(counts.shape, place, (from_x, from_y, to_x, to_y), radius)
        first_row, end_row, first_column, end_column = window
        way_x, way_y = to_x - from_x, to_y - from_y
        inverse = _inverse_square(way_x, way_y)
        for row in range(first_row, end_row):
            dy = place[1] + row * place[2] - from_y
            for column in range(first_column, end_column):
                dx = place[0] + column * place[2] - from_x
                if _squared_distance(dx, dy, way_x, way_y, inverse) > most:
                    continue
                if now - swept_at[row, column] > apart:
                    counts[row, column] = min(counts[row, column] + 1, highest)
                swept_at[row, column] = now


@allocating_entry
def swept_or(cells: Cells, ever: NDArray[np.bool_]) -> int:
    """Return how many WANTED cells are SWEPT, or true in ``ever``, bool of the same shape."""
    values, once = cells.ravel(), ever.ravel()
    found = 0
    for index in range(values.size):  # Without branches: eight and more cells at once.
        value = values[index]
        found += ((value & WANTED) != 0) & (((value & SWEPT) != 0) | once[index])
    return found


@allocating_entry
def missed_of(cells: Cells, floor: NDArray[np.bool_]) -> int:
    """Return how many WANTED cells of ``floor``, bool of the same shape, are not SWEPT."""
    values, is_of_it = cells.ravel(), floor.ravel()
    found = 0
    for index in range(values.size):  # Without branches, as above.
        found += ((values[index] & (WANTED | SWEPT)) == WANTED) & is_of_it[index]
    return found


@inner_part
def _window(
    shape: tuple[int, ...],
    place: NDArray[np.float64],
    ends: tuple[float, float, float, float],
    radius: float,
) -> tuple[int, int, int, int]:
    """Return the first row, the end of the rows, the first column and the end of the columns that
    a disc of ``radius`` m can reach on its way between ``ends``, x, y, x, y, m."""
    from_x, from_y, to_x, to_y = ends
    inverse = 1.0 / place[2]
    low_x, high_x = min(from_x, to_x) - radius, max(from_x, to_x) + radius
    low_y, high_y = min(from_y, to_y) - radius, max(from_y, to_y) + radius
    return (
        max(math.ceil((low_y - place[1]) * inverse), 0),
        min(math.floor((high_y - place[1]) * inverse), shape[0] - 1) + 1,
        max(math.ceil((low_x - place[0]) * inverse), 0),
        min(math.floor((high_x - place[0]) * inverse), shape[1] - 1) + 1,
    )


@part
def _inverse_square(way_x: float, way_y: float) -> float:
    """Return one over the squared length of a way, or 0 of one without length."""
    square = way_x * way_x + way_y * way_y
    return 1.0 / square if square > 0.0 else 0.0


@part
def _squared_distance(
    dx: float, dy: float, way_x: float, way_y: float, inverse_square: float
) -> float:
    """Return the squared distance of a point from a straight way; both begin at the origin."""
    share = min(max((dx * way_x + dy * way_y) * inverse_square, 0.0), 1.0)
    off_x, off_y = dx - share * way_x, dy - share * way_y
    return float(off_x * off_x + off_y * off_y)
