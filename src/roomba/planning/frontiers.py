"""Frontiers: where what is known of a floor ends, and from where to look beyond.

Going to the nearest one each time explores a floor with little more driving than the best order
(Yamauchi, "A frontier-based approach for autonomous exploration", 1997).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.grid import OccupancyMap
from roomba.planning.costmap import Point
from roomba.planning.frontier_kernels import clusters, frontier_cells, viewpoint, ways_from

_LEAST_UNKNOWN: Final = 0.03
"""m2; smaller patches of the unknown are not worth a way."""
_LEAST_CELLS: Final = 3
_LOOK_FROM: Final = 1.2
"""m; so near to a frontier the robot goes to look beyond it, at most."""
_NEARER: Final = 2.0
"""m of way that one metre nearer to the frontier is worth."""
_STRIDE: Final = 0.3
"""m; about so far apart are the places of a frontier that are tried."""
_SMALL: Final = 0.4
_SMALL_COSTS: Final = 1.0
"""m; a frontier shorter than the one costs the other more: what is large comes first."""


@dataclass(frozen=True, slots=True)
class Frontier:
    """``middle`` is a cell of it, ``viewpoint`` where to look from, m; ``way`` how far that is, m;
    ``length`` is about how long it is, m.
    """

    middle: Point
    viewpoint: Point
    way: float
    length: float


def frontiers(
    occupancy: OccupancyMap,
    fits: NDArray[np.bool_],
    here: Point,
    left_out: Sequence[Point] = (),
    away: float = 0.3,
) -> list[Frontier]:
    """Return the frontiers that can be looked at, the best to go to first.

    ``fits``, bool over the map's grid, tells where the robot's middle may be; ``here`` is where it
    is, m. Those nearer than ``away``, m, to a point ``left_out`` are not told. Raises ValueError
    when it is not on the map.
    """
    frame = occupancy.frame
    if not frame.contains(*here):
        raise ValueError(f"expected a place on the map, got ({here[0]:.2f}, {here[1]:.2f})")
    ways = np.empty(frame.shape)
    ways_from(fits, *frame.cell_of(*here), ways)
    frontier = np.empty(frame.shape, np.bool_)
    least = max(1, round(_LEAST_UNKNOWN / frame.resolution**2))
    frontier_cells(occupancy.values, least, frontier)
    labels = np.empty(frame.shape, np.int32)
    count = clusters(frontier, labels)
    found = []
    for cells in _by_number(labels, count):
        if len(cells) < _LEAST_CELLS:
            continue
        seen = _seen_from(cells, occupancy, ways, left_out, away)
        if seen is None:
            continue
        middle, (to_row, to_column) = seen
        length = len(cells) * frame.resolution
        way = float(ways[to_row, to_column]) * frame.resolution
        found.append(Frontier(middle, frame.centre_of(to_row, to_column), way, length))
    return sorted(found, key=_cost)


def is_frontier(occupancy: OccupancyMap, point: Point, radius: float) -> bool:
    """Whether the known ends nearer than ``radius`` to a point, m."""
    frame = occupancy.frame
    row, column = frame.cell_of(*point)
    reach = int(radius / frame.resolution)
    rows = slice(max(row - reach - 1, 0), max(row + reach + 2, 0))
    columns = slice(max(column - reach - 1, 0), max(column + reach + 2, 0))
    values = np.ascontiguousarray(occupancy.values[rows, columns])
    frontier = np.zeros(values.shape, np.bool_)
    if values.size:
        frontier_cells(values, 1, frontier)
    return int(frontier.sum()) >= _LEAST_CELLS


def _seen_from(
    cells: NDArray[np.int64],
    occupancy: OccupancyMap,
    ways: NDArray[np.float64],
    left_out: Sequence[Point],
    away: float,
) -> tuple[Point, tuple[int, int]] | None:
    """Return a place of a frontier, m, near its middle if that can be, and the cell to look from.

    ``cells`` is int64 [n, 2]; None when no place of it can be looked at.
    """
    frame = occupancy.frame
    radius = int(_LOOK_FROM / frame.resolution)
    nearest_first = np.argsort(np.abs(cells - cells.mean(axis=0)).sum(axis=1))
    every = max(1, round(_STRIDE / frame.resolution))
    for row, column in cells[nearest_first[::every]].tolist():
        place = frame.centre_of(row, column)
        if any(math.dist(place, point) < away for point in left_out):
            continue
        to_row, to_column, cost = viewpoint(occupancy.values, ways, row, column, radius, _NEARER)
        if math.isfinite(cost):
            return place, (to_row, to_column)
    return None


def _cost(frontier: Frontier) -> float:
    return frontier.way + (_SMALL_COSTS if frontier.length < _SMALL else 0.0)


def _by_number(labels: NDArray[np.int32], count: int) -> list[NDArray[np.int64]]:
    """Return the cells of each number from 1 on, int64 [n, 2], row and column."""
    cells = np.argwhere(labels > 0)
    numbers = labels[cells[:, 0], cells[:, 1]]
    order = np.argsort(numbers, kind="stable")
    ends = np.searchsorted(numbers[order], np.arange(1, count + 2))
    return [cells[order[ends[n] : ends[n + 1]]] for n in range(count)]
