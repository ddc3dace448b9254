"""Compiled coarse net of cells where the middle fits, one for each block of fine cells.

Places in cells of the window: (x, y) is (column, row).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import entry, part
from roomba.planning.coverage.floor.masks import way_fits

_BLOCK = 8
STEP_X = (1, 1, 0, -1, -1, -1, 0, 1)
STEP_Y = (0, 1, 1, 1, 0, -1, -1, -1)
UNIT = 2.0
"""Steps of a link for a cell of way."""


class Net(NamedTuple):
    """Knots, one for each block of fine cells, and which of their eight neighbours each links to.

    ``knots`` int32 [rows, columns, 2] (x, y), x = -1 where nothing fits; ``links`` int16 [rows,
    columns, 8], the length of each in halves of a cell, 0 for none.
    """

    fits: Mask
    knots: NDArray[np.int32]
    links: NDArray[np.int16]


def net_over(fits: Mask) -> Net:
    """Return the net over the cells that fit, bool [rows, columns]."""
    shape = (-(-fits.shape[0] // _BLOCK), -(-fits.shape[1] // _BLOCK))
    net = Net(fits, np.full((*shape, 2), -1, np.int32), np.zeros((*shape, 8), np.int16))
    _place_knots(net)
    _link_neighbours(net)
    return net


@entry
def _place_knots(net: Net) -> None:
    """Give each block its knot: the cell nearest to the block's middle that fits."""
    rows, columns = net.links.shape[:2]
    for row in range(rows):
        for column in range(columns):
            x, y = _nearest_middle(net.fits, row * _BLOCK, column * _BLOCK)
            net.knots[row, column, 0], net.knots[row, column, 1] = x, y


@part
def _nearest_middle(fits: Mask, top: int, left: int) -> tuple[int, int]:
    """Return x and y of the cell that fits nearest the middle of a block; -1, -1 for none."""
    height, width = fits.shape
    middle_y, middle_x = top + _BLOCK // 2, left + _BLOCK // 2
    if middle_y < height and middle_x < width and fits[middle_y, middle_x]:
        return middle_x, middle_y
    nearest, found_x, found_y = 1 << 30, -1, -1
    for y in range(top, min(top + _BLOCK, height)):
        for x in range(left, min(left + _BLOCK, width)):
            away = (y - middle_y) ** 2 + (x - middle_x) ** 2
            if fits[y, x] and away < nearest:
                nearest, found_x, found_y = away, x, y
    return found_x, found_y


@entry
def _link_neighbours(net: Net) -> None:
    """Link the knots of blocks side by side or corner to corner, if the way between them fits."""
    rows, columns = net.links.shape[:2]
    for row in range(rows):
        for column in range(columns):
            x, y = net.knots[row, column]
            if x < 0:
                continue
            for step in range(4):
                to_row, to_column = row + STEP_Y[step], column + STEP_X[step]
                if not (0 <= to_row < rows and 0 <= to_column < columns):
                    continue
                to_x, to_y = net.knots[to_row, to_column]
                if to_x >= 0 and way_fits(net.fits, x, y, to_x, to_y):
                    steps = max(1, int(math.hypot(to_x - x, to_y - y) * UNIT + 0.5))
                    net.links[row, column, step] = steps
                    net.links[to_row, to_column, step + 4] = steps


@part
def blocks_near(net: Net, x: float, y: float, found: NDArray[np.int32]) -> int:
    """Write the blocks around a place, at most 9, whose knots are in sight; return how many."""
    rows, columns = net.links.shape[:2]
    row, column = int(y + 0.5) // _BLOCK, int(x + 0.5) // _BLOCK
    size = 0
    for at_row in range(max(row - 1, 0), min(row + 2, rows)):
        for at_column in range(max(column - 1, 0), min(column + 2, columns)):
            to_x, to_y = net.knots[at_row, at_column]
            if to_x >= 0 and way_fits(net.fits, x, y, to_x, to_y):
                found[size] = at_row * columns + at_column
                size += 1
    return size


@part
def leg_to(net: Net, block: int, x: float, y: float) -> float:
    """Return how far the knot of a block is from a place, cells."""
    columns = net.links.shape[1]
    knot = net.knots[block // columns, block % columns]
    return math.hypot(knot[0] - x, knot[1] - y)
