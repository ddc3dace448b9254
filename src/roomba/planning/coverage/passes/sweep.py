"""Compiled counting of the cells that a tool sweeps, and that a change of its way would leave.

Lengths and places in cells: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, entry, inner_part, part

Counts = NDArray[np.int16]
"""How many legs of a path sweep each cell, int16 [rows, columns]."""

_TOUCH = 1e-7
_MOST_LEGS = 64


class Legs(NamedTuple):
    """Some legs of a way: ``ends`` float64 [n, 4] (x, y, x, y).

    ``sides`` float64 [n, 2], as :func:`side_of` returns them, and ``spans`` int64 [n, 2], the
    first and last column of a row that each leg sweeps, are work arrays.
    """

    ends: NDArray[np.float64]
    sides: NDArray[np.float64]
    spans: NDArray[np.int64]


@allocating_entry
def room_for_legs() -> Legs:
    """Return work arrays for 64 legs."""
    return Legs(
        np.empty((_MOST_LEGS, 4)), np.empty((_MOST_LEGS, 2)), np.empty((_MOST_LEGS, 2), np.int64)
    )


@part
def set_leg(legs: Legs, at: int, x: float, y: float, to_x: float, to_y: float) -> None:
    """Write one of the legs."""
    legs.ends[at, 0], legs.ends[at, 1] = x, y
    legs.ends[at, 2], legs.ends[at, 3] = to_x, to_y


@part
def side_of(x: float, y: float, to_x: float, to_y: float, radius: float) -> tuple[float, float]:
    """Return the step from a way to the side of the strip that is swept along it."""
    length = math.hypot(to_x - x, to_y - y)
    if length == 0.0:
        return 0.0, 0.0
    return -(to_y - y) / length * radius, (to_x - x) / length * radius


@part
def swept_columns(
    x: float,
    y: float,
    to_x: float,
    to_y: float,
    side: tuple[float, float],
    radius: float,
    row: int,
) -> tuple[int, int]:
    """Return the first and last column of a row whose centres are within ``radius`` of a way.

    ``side`` is what :func:`side_of` returns for it.
    """
    low, high = np.inf, -np.inf
    square = radius * radius - (row - y) * (row - y)
    if square >= 0.0:
        half = math.sqrt(square)
        low, high = x - half, x + half
    square = radius * radius - (row - to_y) * (row - to_y)
    if square >= 0.0:
        half = math.sqrt(square)
        low, high = min(low, to_x - half), max(high, to_x + half)
    if to_y != y:
        # The sides of the strip, between its ends, lie beside the way.
        slope = (to_x - x) / (to_y - y)
        for sign in (-1.0, 1.0):
            begin = y + sign * side[1]
            end = to_y + sign * side[1]
            if min(begin, end) <= row <= max(begin, end):
                at = x + sign * side[0] + (row - begin) * slope
                low, high = min(low, at), max(high, at)
    if low > high:
        return 1, 0
    return math.ceil(low - 1e-6), math.floor(high + 1e-6)


@part
def sweep_leg(
    counts: Counts, x: float, y: float, to_x: float, to_y: float, radius: float, change: int
) -> None:
    """Add ``change`` to the counts of all cells within ``radius`` of a leg."""
    rows, columns = counts.shape
    reach = radius + _TOUCH
    side = side_of(x, y, to_x, to_y, reach)
    first_row = max(math.ceil(min(y, to_y) - reach), 0)
    last_row = min(math.floor(max(y, to_y) + reach), rows - 1)
    for row in range(first_row, last_row + 1):
        first, last = swept_columns(x, y, to_x, to_y, side, reach, row)
        for column in range(max(first, 0), min(last, columns - 1) + 1):
            counts[row, column] += change


@entry
def sweep(counts: Counts, points: NDArray[np.float64], radius: float) -> None:
    """Count the cells within ``radius`` of each leg of a path, float64 [n, 2] (x, y)."""
    for leg in range(len(points) - 1):
        x, y = points[leg]
        to_x, to_y = points[leg + 1]
        sweep_leg(counts, x, y, to_x, to_y, radius, 1)


def unswept(need: Mask, lines: list[NDArray[np.float64]], radius: float) -> Mask:
    """Return the needed cells that no line, float64 [n, 2], sweeps; bool [rows, columns]."""
    counts = np.zeros(need.shape, np.int16)
    for line in lines:
        sweep(counts, line, radius)
    left: Mask = need & (counts == 0)
    return left


@inner_part
def left_without(
    need: Mask, counts: Counts, legs: Legs, old: int, count: int, radius: float, most: float
) -> int:
    """Return how many more needed cells would be left unswept if legs were replaced.

    The first ``old`` of ``legs`` are counted in ``counts`` and would be removed; the others, up to
    ``count``, would replace them. Only cells that are not swept by both are looked at, row by row,
    and no further row once more than ``most`` were found.
    """
    rows, columns = counts.shape
    reach = radius + _TOUCH
    low, high = np.inf, -np.inf
    for leg in range(count):
        x, y, to_x, to_y = legs.ends[leg]
        low, high = min(low, y, to_y), max(high, y, to_y)
        legs.sides[leg, 0], legs.sides[leg, 1] = side_of(x, y, to_x, to_y, reach)
    left = 0
    for row in range(max(math.ceil(low - reach), 0), min(math.floor(high + reach), rows - 1) + 1):
        for leg in range(count):
            x, y, to_x, to_y = legs.ends[leg]
            first, last = 1, 0
            if min(y, to_y) - reach <= row <= max(y, to_y) + reach:
                side = legs.sides[leg, 0], legs.sides[leg, 1]
                first, last = swept_columns(x, y, to_x, to_y, side, reach, row)
            legs.spans[leg, 0], legs.spans[leg, 1] = max(first, 0), min(last, columns - 1)
        left += _left_in_row(need[row], counts[row], legs.spans, old, count)
        if left > most:
            break
    return left


@inner_part
def replace_legs(counts: Counts, legs: Legs, old: int, count: int, radius: float) -> None:
    """Count the cells of the first ``old`` legs once less, and those of the others, up to
    ``count``, once more."""
    for leg in range(count):
        x, y, to_x, to_y = legs.ends[leg]
        sweep_leg(counts, x, y, to_x, to_y, radius, -1 if leg < old else 1)


@inner_part
def _left_in_row(
    need: NDArray[np.bool_],
    counts: NDArray[np.int16],
    spans: NDArray[np.int64],
    old: int,
    count: int,
) -> int:
    """Return the same as :func:`left_without` for one row; each cell counts at its first leg."""
    left = 0
    for leg in range(count):
        is_old = leg < old
        column, last = spans[leg, 0], spans[leg, 1]
        while column <= last:
            known_to = -1
            for other in range(count):
                if (other < leg or (is_old and other >= old)) and (
                    spans[other, 0] <= column <= spans[other, 1]
                ):
                    known_to = max(known_to, spans[other, 1])
            if known_to >= 0:
                column = known_to + 1
                continue
            if need[column]:
                of_old = 0
                for other in range(leg, old):
                    if spans[other, 0] <= column <= spans[other, 1]:
                        of_old += 1
                if counts[column] == of_old:
                    left += 1 if is_old else -1
            column += 1
    return left
