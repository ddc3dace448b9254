"""Frontiers, where known floor borders on the unknown, and the viewpoints to look beyond.

Going to the nearest one each time explores a floor with little more driving than the best order
(Yamauchi, "A frontier-based approach for autonomous exploration", 1997).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Point, Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.planning.frontiers.kernels import clusters, frontier_cells, seen_from, ways_from


@dataclass(frozen=True, slots=True, kw_only=True)
class FrontierChoice:
    """Which frontiers count, from where they are looked at, and which come first.

    Unknown patches of less than ``least_unknown`` m2 have no frontier. Frontiers of fewer than
    ``least_cells`` cells do not count, nor do cells nearer than ``away`` m to a point that is left
    out. Places of a frontier about ``stride`` m apart are tried. A viewpoint is at most
    ``look_from`` m off its frontier; one metre nearer is worth ``nearer_worth`` m of way. A
    viewpoint where the body has little room costs ``tight_cost`` m of way more. Frontiers shorter
    than ``small`` m cost ``small_cost`` m of way more, so that large ones come first.
    """

    least_unknown: float
    away: float
    look_from: float
    nearer_worth: float
    small: float
    small_cost: float
    least_cells: int
    stride: float
    tight_cost: float


@dataclass(frozen=True, slots=True)
class Frontier:
    """A frontier; ``middle`` is the middle of one of its cells, m.

    ``viewpoint`` is where to look from, m; ``way`` how far the robot has to drive there, m;
    ``length`` about how long the frontier is, m.
    """

    middle: Point
    viewpoint: Point
    way: float
    length: float

    def moved(self, moved: Pose) -> Frontier:
        """Return the frontier in another frame, in which this one's frame lies at ``moved``."""
        middle, viewpoint = moved.place_of(*self.middle), moved.place_of(*self.viewpoint)
        return replace(self, middle=middle, viewpoint=viewpoint)


def frontiers(
    occupancy: OccupancyMap,
    fits: NDArray[np.bool_],
    roomy: NDArray[np.bool_],
    here: Point,
    left_out: Sequence[Point],
    choice: FrontierChoice,
) -> list[Frontier]:
    """Return the frontiers that can be looked at, the best to go to first.

    ``fits``, bool over the map's grid, tells where the robot's middle may be, ``roomy`` where it
    has much room; ``here`` is where the robot is, m. Frontiers near one of the points ``left_out``,
    m, are left out. If the robot fits nowhere, the list is empty.
    """
    frame = occupancy.frame
    nearest = _nearest_that_fits(fits, frame, here)
    if nearest is None:
        return []
    ways = np.empty(frame.shape)
    ways_from(fits, *nearest, ways)
    costs = ways + np.where(roomy, 0.0, choice.tight_cost / frame.resolution)
    labels = np.empty(frame.shape, np.int32)
    count = _numbered_frontiers(occupancy, choice.least_unknown, labels)
    cells, ends = _by_number(labels, count)
    middles = _middles_of(cells, frame)
    apart = _from_middle(cells, ends)
    leave = np.array(left_out, np.float64).reshape(-1, 2)
    radius = int(choice.look_from / frame.resolution)
    every, worth = max(1, round(choice.stride / frame.resolution)), choice.nearer_worth
    found = []
    for first, last in pairwise(ends.tolist()):
        if last - first < choice.least_cells:
            continue
        tried = first + _spaced(apart[first:last], every)
        index, row, column = seen_from(
            cells[tried], middles[tried], leave, choice.away, occupancy.values, costs, radius, worth
        )
        if index < 0:
            continue
        x, y = middles[tried[index]].tolist()
        length, way = (last - first) * frame.resolution, float(ways[row, column]) * frame.resolution
        found.append(Frontier((x, y), frame.centre_of(row, column), way, length))
    return sorted(found, key=lambda frontier: _cost(frontier, choice))


def _nearest_that_fits(
    fits: NDArray[np.bool_], frame: GridFrame, here: Point
) -> tuple[int, int] | None:
    """Return the cell from which ways begin: the robot's own, or the nearest one that fits.

    They differ if the robot touches something, or is off the map. None if it fits nowhere.
    """
    row, column = frame.cell_of(*here)
    if frame.contains(*here) and fits[row, column]:
        return row, column
    cells = np.argwhere(fits)
    if not len(cells):
        return None
    nearest = cells[np.argmin(np.hypot(cells[:, 0] - row, cells[:, 1] - column))]
    return int(nearest[0]), int(nearest[1])


def is_frontier(occupancy: OccupancyMap, point: Point, radius: float, least: int) -> bool:
    """Whether ``least`` frontier cells or more lie within about ``radius``, m, of a point, m."""
    frame = occupancy.frame
    row, column = frame.cell_of(*point)
    reach = int(radius / frame.resolution)
    rows = slice(max(row - reach - 1, 0), max(row + reach + 2, 0))
    columns = slice(max(column - reach - 1, 0), max(column + reach + 2, 0))
    values = np.ascontiguousarray(occupancy.values[rows, columns])
    frontier = np.zeros(values.shape, np.bool_)
    if values.size:
        frontier_cells(values, 1, frontier)
    return int(frontier.sum()) >= least


def lengths_near(
    occupancy: OccupancyMap, points: Sequence[Point], radius: float, least_unknown: float
) -> NDArray[np.float64]:
    """Return about how long the frontiers nearest to points are, m, float64 [n].

    A length is 0 if no frontier is nearer than ``radius`` m, or if an earlier point has the same
    one. Unknown patches of less than ``least_unknown`` m2 have no frontier.
    """
    frame = occupancy.frame
    labels = np.empty(frame.shape, np.int32)
    count = _numbered_frontiers(occupancy, least_unknown, labels)
    cells, ends = _by_number(labels, count)
    lengths = np.diff(ends) * frame.resolution
    numbers, middles = labels[tuple(cells.T)], _middles_of(cells, frame)
    found, told = np.zeros(len(points)), set[int]()
    for index, point in enumerate(points):
        apart = np.hypot(*(middles - point).T)
        if not len(apart) or apart.min() >= radius:
            continue
        number = int(numbers[np.argmin(apart)])
        if number not in told:
            told.add(number)
            found[index] = lengths[number - 1]
    return found


def _numbered_frontiers(
    occupancy: OccupancyMap, least_unknown: float, labels: NDArray[np.int32]
) -> int:
    """Number the frontiers into ``labels``, from 1 on; return how many there are."""
    frontier = np.empty(labels.shape, np.bool_)
    least = max(1, round(least_unknown / occupancy.frame.resolution**2))
    frontier_cells(occupancy.values, least, frontier)
    return clusters(frontier, labels)


def _cost(frontier: Frontier, choice: FrontierChoice) -> float:
    return frontier.way + (choice.small_cost if frontier.length < choice.small else 0.0)


def _by_number(
    labels: NDArray[np.int32], count: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the cells with labels, int64 [n, 2], row and column, sorted by their labels.

    Also return where the cells of each label begin, int64 [count + 1]; the last is where all end.
    """
    found = np.flatnonzero(labels > 0)
    numbers = labels.ravel()[found]
    order = np.argsort(numbers, kind="stable")
    cells = np.column_stack(np.divmod(found[order], labels.shape[1]))
    return cells, np.searchsorted(numbers[order], np.arange(1, count + 2))


def _from_middle(cells: NDArray[np.int64], ends: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return each cell's distance from the mean of its label's cells: rows plus columns.

    ``cells`` and ``ends`` are as :func:`_by_number` returns them.
    """
    counts = np.diff(ends)
    means = np.add.reduceat(cells, ends[:-1]) / counts[:, None] if len(counts) else cells
    apart: NDArray[np.float64] = np.abs(cells - np.repeat(means, counts, axis=0)).sum(axis=1)
    return apart


def _spaced(apart: NDArray[np.float64], every: int) -> NDArray[np.intp]:
    """Return each ``every``-th place, nearest to the middle first; the nearest is among them.

    The order of equally distant places is the same on all processors.
    """
    spaced = np.arange(int(np.argmin(apart)) % every, len(apart), every)
    return spaced[np.argsort(apart[spaced], kind="stable")]


def _middles_of(cells: NDArray[np.int64], frame: GridFrame) -> NDArray[np.float64]:
    """Return the x and y of the cells' middles, m, float64 [n, 2]."""
    return np.column_stack(frame.centres(cells[:, 0], cells[:, 1]))
