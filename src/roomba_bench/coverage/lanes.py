"""A simple boustrophedon: parallel lanes over the whole map, joined by shortest grid paths."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np

from roomba.arrays import Floats, Mask
from roomba.grid import GridFrame
from roomba.planning.path.search.grid_path import GridSearch
from roomba.raster.regions import numbered_regions
from roomba.world.home.raster import where_body_fits
from roomba_bench.coverage.floor import TOOL, length

Cell = tuple[int, int]
Lane = tuple[Cell, Cell]

_RADIUS: Final = 0.165
"""m; the distance that our robot keeps from squares of solid cells, too."""


class Order(Enum):
    """The order in which lanes are driven."""

    IN_ORDER = "in order"
    """Line by line over the whole map, to and fro, through walls too."""
    NEAREST = "nearest lane next"
    """Always the lane next whose nearer end is the nearest by the robot's way."""


@dataclass(frozen=True, eq=False)
class Lanes:
    """Where the body fits on cells of the map, bool, and the ``lines`` of lanes there, in order.

    A lane is a pair of end cells (row, column); those of a line run the same way.
    """

    fits: Mask
    lines: list[list[Lane]]


def boustrophedon(
    solid: Mask, frame: GridFrame, start: tuple[float, float], order: Order
) -> Floats:
    """Return the corners of a way over all the floor that hangs with ``start``, [n, 2], m.

    Its lanes run along x or along y: whichever makes the shorter way.
    """
    fits = where_body_fits(frame, solid, _RADIUS)
    regions = numbered_regions(fits)
    here = _nearest_cell(fits, frame.cell_of(*start))
    fits = regions == regions[here]
    along_x = way_over(lanes_on(fits, frame), here, order)
    along_y = way_over(lanes_on(np.ascontiguousarray(fits.T), frame), here[::-1], order)
    ways = [along_x, [cell[::-1] for cell in along_y]]
    metres = [np.array([frame.centre_of(*cell) for cell in way]) for way in ways]
    return min(metres, key=length)


def lanes_on(fits: Mask, frame: GridFrame) -> Lanes:
    """Return lanes along the rows, at most a tool's width apart, first and last row included.

    The cells of ``fits``, bool [rows, columns], are connected.
    """
    used = np.flatnonzero(fits.any(axis=1))
    apart = max(1, int(TOOL / frame.resolution + 1e-6))
    lines = []
    for row in np.unique(np.append(np.arange(used[0], used[-1], apart), used[-1])).tolist():
        edges = np.flatnonzero(np.diff(fits[row].astype(np.int8), prepend=0, append=0)).tolist()
        ends = zip(edges[::2], edges[1::2], strict=True)
        lines.append([((row, first), (row, behind - 1)) for first, behind in ends])
    return Lanes(fits, lines)


def way_over(lanes: Lanes, here: Cell, order: Order) -> list[Cell]:
    """Return the corner cells of a way from a cell over all lanes."""
    search = GridSearch()
    corners = [here]
    left = _to_and_fro(lanes)
    while left:
        lane = left[0]
        if order is Order.NEAREST:
            lane = _nearest_lane(search, lanes.fits, here, left)
        left.remove(lane if lane in left else lane[::-1])
        path = search.shortest_path(lanes.fits, here, lane[0])
        assert path is not None, "lanes hang together"
        corners += [(int(row), int(column)) for row, column in path.corners]
        here = lane[1]
        corners.append(here)
    return [
        cell for number, cell in enumerate(corners) if number == 0 or cell != corners[number - 1]
    ]


def _to_and_fro(lanes: Lanes) -> list[Lane]:
    """Return all lanes line by line; each line runs opposite to the line before."""
    ordered: list[Lane] = []
    for number, line in enumerate(lanes.lines):
        ordered += line if number % 2 == 0 else [lane[::-1] for lane in reversed(line)]
    return ordered


def _nearest_lane(search: GridSearch, fits: Mask, here: Cell, left: list[Lane]) -> Lane:
    """Return the nearest lane, from its nearer end; the search stops by straight distances."""
    best, least = left[0], np.inf
    both = [way for lane in left for way in (lane, lane[::-1])]
    for lane in sorted(both, key=lambda ends: _away(here, ends[0])):
        if _away(here, lane[0]) >= least:
            break
        path = search.shortest_path(fits, here, lane[0])
        if path is not None and path.length < least:
            best, least = lane, path.length
    return best


def _nearest_cell(fits: Mask, cell: Cell) -> Cell:
    rows, columns = np.nonzero(fits)
    nearest = int(np.argmin(np.hypot(rows - cell[0], columns - cell[1])))
    return int(rows[nearest]), int(columns[nearest])


def _away(one: Cell, other: Cell) -> float:
    return float(np.hypot(one[0] - other[0], one[1] - other[1]))
