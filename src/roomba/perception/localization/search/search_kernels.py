"""Compiled search of a whole map for the places where a scan could have been taken."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import any_order_entry, entry
from roomba.perception.matching.field_kernels import Field, Place

_EARLY = 12
"""Beams after which a place that fits nowhere is given up."""
_EARLY_SHARE = 0.3


@any_order_entry
def score_heading(
    field: Field,
    place: Place,
    ends: Floats,
    chosen: NDArray[np.int64],
    spots: Floats,
    theta: float,
    width: float,
    scores: NDArray[np.float32],
    headings: NDArray[np.float32],
) -> None:
    """Score all ``spots`` [n, 2], m, for one heading; keep the score where it is the best so far.

    ``chosen`` are rows of ``ends`` (see ``beam_ends``). Each beam counts 1 on a surface and less,
    evenly, down to 0 at ``width`` m from it.
    """
    cosine, sine = math.cos(theta), math.sin(theta)
    inverse = 1.0 / place[2]
    rows, columns = field.shape
    beams = chosen.size
    across = np.empty(beams, np.float64)
    along = np.empty(beams, np.float64)
    for index in range(beams):
        end_x, end_y = ends[chosen[index], 0], ends[chosen[index], 1]
        along[index] = (cosine * end_x - sine * end_y - place[0]) * inverse + 0.5
        across[index] = (sine * end_x + cosine * end_y - place[1]) * inverse + 0.5
    per_metre = 1.0 / width
    for spot in range(spots.shape[0]):
        u, v = spots[spot, 0] * inverse, spots[spot, 1] * inverse
        total = 0.0
        for index in range(beams):
            column, row = math.floor(u + along[index]), math.floor(v + across[index])
            if 0 <= column < columns and 0 <= row < rows:
                total += max(0.0, 1.0 - abs(field[int(row), int(column)]) * per_metre)
            if index == _EARLY - 1 and total < _EARLY_SHARE * _EARLY:
                break
        if total > scores[spot]:
            scores[spot] = total
            headings[spot] = theta


@entry
def cells_with_room(field: Field, room: float, stride: int, cells: NDArray[np.int64]) -> int:
    """Fill ``cells`` [n, 2], row and column, with a cell of each block; return how many there are.

    A block is ``stride`` by ``stride`` cells. Chosen is the cell nearest to the block's middle of
    those with ``room`` m around, so that narrow places are not left out.
    """
    rows, columns = field.shape
    count = 0
    for block_row in range(0, rows, stride):
        for block_column in range(0, columns, stride):
            nearest = 2 * stride
            for row in range(block_row, min(block_row + stride, rows)):
                for column in range(block_column, min(block_column + stride, columns)):
                    off = abs(row - block_row - stride // 2)
                    off += abs(column - block_column - stride // 2)
                    if off < nearest and field[row, column] >= room:
                        nearest = off
                        cells[count, 0] = row
                        cells[count, 1] = column
            if nearest < 2 * stride:
                count += 1
    return count
