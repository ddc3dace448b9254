"""Compiled: occupancy counts of a grid, how many beams passed each cell and how many ended in it.

A beam is a straight line from the lidar to the point that it met, map frame. It passes the cells on
that line, and ends in the cell just behind the surface. A cell is occupied or free by the share of
the two counts.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, entry, inlined_entry, inner_part, part
from roomba.grid import FREE, OCCUPIED, UNKNOWN
from roomba.perception.slam.scan_matching.surface_kernels import NORMAL_X, NORMAL_Y, X, Y

Counts = NDArray[np.uint16]

_INTO: Final = 0.4
"""cells; a beam is counted so far behind the surface that it met, to be inside the wall's cell."""
INTO_EDGE: Final = 0.25
"""cells; the same at edges and thin things, whose surface normal is not known. It is smaller, as
farther along the beam, past a corner, the next cell begins."""
_BEFORE: Final = 0.5
"""cells; from so far before the surface on a beam no longer counts as passing through."""
_EDGE: Final = 0.15
"""cells; if beams met a cell, in the mean, this near to its border or beyond, the cell may be only
the edge of a thing in the next cell. Drawn in two cells, the leg of a chair closes the way past."""
_SURER: Final = 1.5
"""Factor on the share of beams that ended in the cell; that in the next cell must be as large."""
_ROW_STEPS, _COLUMN_STEPS = (0, 1, 0, -1), (1, 0, -1, 0)
_NOWHERE: Final = np.zeros((0, 0, 2), np.float32)
_NO_COUNTS: Final = np.zeros((0, 0), np.uint16)
MARGIN: Final = 1
"""Unknown cells around the known ones."""
_MOST: Final = 60000
"""The largest count; it is halved there, so that it never overflows."""


class CountArrays(NamedTuple):
    """The grid as kernels know it: ``hits`` and ``passes``, uint16 [rows, columns], are the counts.

    ``place`` is the lower left corner x, y and the cell size, m; ``bounds`` int64 [4] the first and
    last row and column with counts. ``offsets``, float32 [rows, columns, 2], sums up where the
    cell's beams met a surface, x and y from the cell's middle, in cells; ``opens``, uint16 [rows,
    columns], counts beams without an echo on open ways. Both are empty if :func:`occupancy` is
    not used.
    """

    hits: Counts
    passes: Counts
    place: Floats
    bounds: NDArray[np.int64]
    offsets: NDArray[np.float32] = _NOWHERE
    opens: Counts = _NO_COUNTS


@allocating_entry
def draw(
    cells: CountArrays,
    points: NDArray[np.float32],
    lidar: Floats,
    pose: Floats,
    into_edge: float = _INTO,
    times: int = 1,
) -> None:
    """Count the beams of a scan taken at ``pose`` [3], x, y, m, theta, rad, map frame.

    ``points`` is float32 [n, POINT], robot's frame; ``lidar`` the lidar's x, y, m, in that frame.
    ``into_edge``, cells, is how far behind a point its beam ends where the normal is not known. A
    scan counts ``times`` times; -1 takes it away again, but the bounds stay.
    """
    per_metre = 1.0 / cells.place[2]
    rows, columns = cells.hits.shape
    shape = rows, columns
    hits, passes = cells.hits.ravel(), cells.passes.ravel()
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    from_x = pose[0] + cosine * lidar[0] - sine * lidar[1]
    from_y = pose[1] + sine * lidar[0] + cosine * lidar[1]
    from_u, from_v = (from_x - cells.place[0]) * per_metre, (from_y - cells.place[1]) * per_metre
    for index in range(points.shape[0]):
        x = pose[0] + cosine * points[index, X] - sine * points[index, Y]
        y = pose[1] + sine * points[index, X] + cosine * points[index, Y]
        u, v = (x - cells.place[0]) * per_metre, (y - cells.place[1]) * per_metre
        length = math.hypot(u - from_u, v - from_v)
        if length == 0.0:
            continue
        along_u, along_v = (u - from_u) / length, (v - from_v) / length
        normal_x, normal_y = points[index, NORMAL_X], points[index, NORMAL_Y]
        into_u, into_v = along_u, along_v
        into, before = into_edge, _BEFORE
        if normal_x != 0.0 or normal_y != 0.0:
            into_u = -(cosine * normal_x - sine * normal_y)
            into_v = -(sine * normal_x + cosine * normal_y)
            into, before = _INTO, _BEFORE / max(into_u * along_u + into_v * along_v, 0.1)
        _pass(passes, shape, from_u, from_v, along_u, along_v, length - before, times)
        row, column = math.floor(v + into * into_v), math.floor(u + into * into_u)
        _hit(cells.offsets, hits, shape, row, column, u, v, times)
        _bound(cells, row, column)
    _bound(cells, math.floor(from_v), math.floor(from_u))


@entry
def draw_open(
    cells: CountArrays, ends: NDArray[np.float32], lidar: Floats, pose: Floats, times: int
) -> None:
    """Count the ways from the lidar to ``ends``, float32 [n, 2], robot's frame, as open.

    The other arguments are those of :func:`draw`. This makes no cell a wall, nor any wall free.
    """
    per_metre = 1.0 / cells.place[2]
    rows, columns = cells.hits.shape
    shape, opens = (rows, columns), cells.opens.ravel()
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    from_u, from_v = _cell_of(cells.place, pose, cosine, sine, lidar[0], lidar[1], per_metre)
    for index in range(ends.shape[0]):
        u, v = _cell_of(cells.place, pose, cosine, sine, ends[index, X], ends[index, Y], per_metre)
        length = math.hypot(u - from_u, v - from_v)
        if length > 0.0:
            along_u, along_v = (u - from_u) / length, (v - from_v) / length
            _pass(opens, shape, from_u, from_v, along_u, along_v, length, times)
            _bound(cells, math.floor(v), math.floor(u))


@inner_part
def _cell_of(
    place: Floats, pose: Floats, cosine: float, sine: float, x: float, y: float, per_metre: float
) -> tuple[float, float]:
    """Return the column and row, with fractions, of a point of the robot's frame."""
    map_x = pose[0] + cosine * x - sine * y
    map_y = pose[1] + sine * x + cosine * y
    return (map_x - place[0]) * per_metre, (map_y - place[1]) * per_metre


@inner_part
def _pass(
    counts: Counts,
    shape: tuple[int, int],
    u: float,
    v: float,
    along_u: float,
    along_v: float,
    length: float,
    times: int,
) -> None:
    """Count the cells on a straight way, once each (Amanatides and Woo, 1987)."""
    if length <= 0.0:
        return
    column, row = math.floor(u), math.floor(v)
    columns = shape[1]
    step_u, step_v = (1 if along_u > 0.0 else -1), (1 if along_v > 0.0 else -1)
    per_u = math.inf if along_u == 0.0 else abs(1.0 / along_u)
    per_v = math.inf if along_v == 0.0 else abs(1.0 / along_v)
    next_u = math.inf if along_u == 0.0 else per_u * (column + 1 - u if step_u > 0 else u - column)
    next_v = math.inf if along_v == 0.0 else per_v * (row + 1 - v if step_v > 0 else v - row)
    end_row, end_column = math.floor(v + length * along_v), math.floor(u + length * along_u)
    # All cells of a straight way lie between its ends, or next to these.
    if _is_in(shape, row, column, 1) and _is_in(shape, end_row, end_column, 1):
        at, side = row * columns + column, step_v * columns
        _walk(counts, at, step_u, side, per_u, per_v, next_u, next_v, length, times)
        return
    while True:
        if _is_in(shape, row, column, 0):
            _count(counts, row * columns + column, times)
        if min(next_u, next_v) > length:
            return
        if next_u < next_v:
            column += step_u
            next_u += per_u
        else:
            row += step_v
            next_v += per_v


@inner_part
def _walk(
    counts: Counts,
    at: int,
    step_u: int,
    step_v: int,
    per_u: float,
    per_v: float,
    next_u: float,
    next_v: float,
    length: float,
    times: int,
) -> None:
    """Count the cells of a way that is all on the grid: ``at``, and the cell after each step.

    The direction of a step is unpredictable, so nothing branches on it: that halves the time.
    """
    while True:
        _count(counts, at, times)
        is_aside = next_u < next_v
        if (next_u if is_aside else next_v) > length:
            return
        at += step_u if is_aside else step_v
        next_u += per_u if is_aside else 0.0
        next_v += 0.0 if is_aside else per_v


@inner_part
def _hit(
    offsets: NDArray[np.float32],
    counts: Counts,
    shape: tuple[int, int],
    row: int,
    column: int,
    u: float,
    v: float,
    times: int,
) -> None:
    """Count a beam that ended in a cell, and met the surface at ``u``, ``v``, cells."""
    if not _is_in(shape, row, column, 0):
        return
    at = row * shape[1] + column
    if offsets.shape[0] > 0:
        if counts[at] + times > _MOST:
            offsets[row, column, 0] *= 0.5
            offsets[row, column, 1] *= 0.5
        offsets[row, column, 0] += times * (u - column - 0.5)
        offsets[row, column, 1] += times * (v - row - 0.5)
    _count(counts, at, times)


@part
def _is_in(shape: tuple[int, int], row: int, column: int, margin: int) -> bool:
    rows, columns = shape
    return margin <= row < rows - margin and margin <= column < columns - margin


@part
def _count(counts: Counts, at: int, times: int) -> None:
    before = int(counts[at])
    after = before + times
    if not 0 <= after <= _MOST:
        after = 0 if after < 0 else before // 2 + times
    counts[at] = after


@inner_part
def _bound(cells: CountArrays, row: int, column: int) -> None:
    rows, columns = cells.hits.shape
    cells.bounds[0] = max(min(cells.bounds[0], row), 0)
    cells.bounds[1] = min(max(cells.bounds[1], row), rows - 1)
    cells.bounds[2] = max(min(cells.bounds[2], column), 0)
    cells.bounds[3] = min(max(cells.bounds[3], column), columns - 1)


@allocating_entry
def occupancy(cells: CountArrays, share: float, least: int, values: NDArray[np.int8]) -> None:
    """Fill ``values`` from the counts, with a margin of unknown cells around all in the bounds.

    A cell is occupied if beams ended in it and none went through. It is also occupied if ``least``
    beams or more ended in it, and at least ``share`` of all, unless it is only the edge of a thing
    in the cell beside it. Other cells are free if beams went through or a way is open, else
    unknown.
    """
    rows, columns = values.shape[0] - 2 * MARGIN, values.shape[1] - 2 * MARGIN
    first_row, first_column = cells.bounds[0], cells.bounds[2]
    values[:] = UNKNOWN
    for row in range(rows):
        line = values[MARGIN + row, MARGIN : MARGIN + columns]
        hits = cells.hits[first_row + row, first_column : first_column + columns]
        passes = cells.passes[first_row + row, first_column : first_column + columns]
        # Most cells are decided here; without a branch several are done at once.
        for column in range(columns):
            line[column] = FREE if passes[column] > 0 else UNKNOWN
        if cells.opens.shape[0] > 0:
            opens = cells.opens[first_row + row, first_column : first_column + columns]
            for column in range(columns):
                line[column] = FREE if opens[column] > 0 else line[column]
        for column in range(columns):
            ended = int(hits[column])
            if ended == 0:
                continue
            through = int(passes[column])
            is_met = _is_met(ended, through, share, least)
            if through == 0 or (
                is_met and not _is_edge(cells, first_row + row, first_column + column, least)
            ):
                line[column] = OCCUPIED


@inlined_entry
def _is_met(ended: int, through: int, share: float, least: int) -> bool:
    return ended >= least and ended >= share * (ended + through)


@inner_part
def _is_edge(cells: CountArrays, row: int, column: int, least: int) -> bool:
    """Whether beams met a cell only at its border to a cell that is more surely occupied."""
    rows, columns = cells.offsets.shape[:2]
    hits = int(cells.hits[row, column])
    surer = _SURER * hits / (hits + int(cells.passes[row, column]))
    for step in range(4):
        step_row, step_column = _ROW_STEPS[step], _COLUMN_STEPS[step]
        beside_row, beside_column = row + step_row, column + step_column
        if not (0 <= beside_row < rows and 0 <= beside_column < columns):
            continue
        offset_x, offset_y = cells.offsets[row, column]
        if step_column * offset_x + step_row * offset_y < (0.5 - _EDGE) * hits:
            continue
        ended = int(cells.hits[beside_row, beside_column])
        through = int(cells.passes[beside_row, beside_column])
        if _is_met(ended, through, surer, least):
            return True
    return False
