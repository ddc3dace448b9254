"""Stage connection: joins the ordered pieces by shortest ways to one line.

Places in cells of the window: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.planning.grid_path import shortest_grid_path
from roomba.planning.coverage_ways import Net, taut, way_between

Line = NDArray[np.float64]

_SAME = 0.01
"""cells; points nearer to each other than this are one."""
_STRAIGHT = 0.02
"""cells; points as near as this to the straight way between their neighbours are left out."""


def connected(net: Net, pieces: list[Line], start: Line, end: Line | None) -> Line:
    """Return the line from ``start``, float64 [2], along the pieces, to ``end`` if there is one."""
    costs = np.full(net.links.size, np.inf)
    parts = [start[None]]
    at = start
    stops = [*pieces] if end is None else [*pieces, end[None]]
    for piece in stops:
        parts.append(_way(net, costs, at, piece[0])[1:])
        parts.append(piece[1:])
        at = piece[-1]
    return without_needless(np.concatenate(parts))


def _way(net: Net, costs: NDArray[np.float64], start: Line, goal: Line) -> Line:
    """Return the shortest way; over the cells themselves where the net is too coarse for it."""
    way: Line = way_between(net, costs, start[0], start[1], goal[0], goal[1])
    if len(way):
        return way
    column, row = _cell(net, start)
    to_column, to_row = _cell(net, goal)
    found = shortest_grid_path(net.fits, (row, column), (to_row, to_column))
    if found is None:
        raise ValueError(f"no way between the cells {start} and {goal}, which are connected")
    cells = found.corners[:, ::-1].astype(np.float64)
    taut_way: Line = taut(net.fits, np.concatenate((start[None], cells, goal[None])))
    return taut_way


def _cell(net: Net, point: Line) -> tuple[int, int]:
    """Return the (column, row) of the cell that fits nearest to a point on the floor."""
    around = [
        (int(np.floor(point[0])) + right, int(np.floor(point[1])) + up)
        for up in (0, 1)
        for right in (0, 1)
    ]
    rows, columns = net.fits.shape
    fitting = [(x, y) for x, y in around if 0 <= x < columns and 0 <= y < rows and net.fits[y, x]]
    return min(fitting, key=lambda cell: float(np.hypot(*(np.array(cell) - point))))


def without_needless(line: Line) -> Line:
    """Return the line without points that do not bend it."""
    points = [line[0]]
    for point in line[1:]:
        if np.hypot(*(point - points[-1])) < _SAME:
            continue
        while len(points) > 1:
            one, two = points[-1] - points[-2], point - points[-2]
            length = np.hypot(*two)
            ahead = (point - points[-1]) @ one > 0
            if not ahead or abs(one[0] * two[1] - one[1] * two[0]) > _STRAIGHT * length:
                break
            points.pop()
        points.append(point)
    return np.array(points)
