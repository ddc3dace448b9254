"""Stage connection: joins the ordered pieces by shortest ways to one line.

Places in cells of the window: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask, Polyline
from roomba.compilation import allocating_entry
from roomba.planning.coverage.floor.masks import way_fits
from roomba.planning.coverage.tour.net import Net
from roomba.planning.coverage.tour.ways import taut, way_between
from roomba.planning.path.search.grid_path import shortest_grid_path

_SAME = 0.01
"""cells; points nearer to each other than this are one."""
_SHORT = 0.75
"""cells; shorter legs are dropped, for example those from a point to its cell's centre."""
_STRAIGHT = 0.02
"""cells; points as near as this to the straight way between their neighbours are left out."""


def connected(net: Net, pieces: list[Polyline], start: Floats, end: Floats | None) -> Polyline:
    """Return the line from ``start``, float64 [2], along the pieces, to ``end`` if there is one."""
    costs = np.full(net.links.size // 8, np.inf)
    parts = [start[None]]
    at = start
    stops = [*pieces] if end is None else [*pieces, end[None]]
    for piece in stops:
        parts.append(_way(net, costs, at, piece[0])[1:])
        parts.append(piece[1:])
        at = piece[-1]
    return _without_needless(np.concatenate(parts))


def _way(net: Net, costs: NDArray[np.float64], start: Floats, goal: Floats) -> Polyline:
    """Return the shortest way; it is searched over the cells if the net is too coarse for it."""
    way: Polyline = way_between(net, costs, start[0], start[1], goal[0], goal[1])
    if len(way):
        return way
    column, row = _cell(net, start)
    to_column, to_row = _cell(net, goal)
    found = shortest_grid_path(net.fits, (row, column), (to_row, to_column))
    if found is None:
        raise ValueError(f"no way between the cells {start} and {goal}, which are connected")
    cells = found.corners[:, ::-1].astype(np.float64)
    taut_way: Polyline = taut(net.fits, np.concatenate((start[None], cells, goal[None])))
    return taut_way


def _cell(net: Net, point: Floats) -> tuple[int, int]:
    """Return the (column, row) of the cell that fits nearest to a point on the floor."""
    around = [
        (int(np.floor(point[0])) + right, int(np.floor(point[1])) + up)
        for up in (0, 1)
        for right in (0, 1)
    ]
    rows, columns = net.fits.shape
    fitting = [(x, y) for x, y in around if 0 <= x < columns and 0 <= y < rows and net.fits[y, x]]
    return min(fitting, key=lambda cell: float(np.hypot(*(np.array(cell) - point))))


def tidy(fits: Mask, line: Polyline) -> Polyline:
    """Return the line without points that do not bend it, and without legs too short to drive."""
    tidied: Polyline = _without_needless(_without_short(fits, line))
    return tidied


@allocating_entry
def _without_short(fits: Mask, line: Polyline) -> Polyline:
    """Return the line without legs below ``_SHORT``, if the middle fits on the way without them."""
    points = line.copy()
    size = 1
    for at in range(1, len(line)):
        x, y = points[size - 1, 0], points[size - 1, 1]
        short = math.hypot(line[at, 0] - x, line[at, 1] - y) < _SHORT
        is_last = at == len(line) - 1
        if short and not is_last and way_fits(fits, x, y, line[at + 1, 0], line[at + 1, 1]):
            continue
        if short and size > 1:
            x, y = points[size - 2, 0], points[size - 2, 1]
            if way_fits(fits, x, y, line[at, 0], line[at, 1]):
                size -= 1
        points[size, 0], points[size, 1] = line[at, 0], line[at, 1]
        size += 1
    return points[:size].copy()


@allocating_entry
def _without_needless(line: Polyline) -> Polyline:
    """Return the line without points that do not bend it."""
    points = np.empty_like(line)
    points[0, 0], points[0, 1] = line[0, 0], line[0, 1]
    size = 1
    for at in range(1, len(line)):
        x, y = line[at, 0], line[at, 1]
        if math.hypot(x - points[size - 1, 0], y - points[size - 1, 1]) < _SAME:
            continue
        while size > 1:
            one_x = points[size - 1, 0] - points[size - 2, 0]
            one_y = points[size - 1, 1] - points[size - 2, 1]
            two_x, two_y = x - points[size - 2, 0], y - points[size - 2, 1]
            ahead = (x - points[size - 1, 0]) * one_x + (y - points[size - 1, 1]) * one_y > 0.0
            aside = abs(one_x * two_y - one_y * two_x)
            if not ahead or aside > _STRAIGHT * math.hypot(two_x, two_y):
                break
            size -= 1
        points[size, 0], points[size, 1] = x, y
        size += 1
    return points[:size].copy()
