"""Rooms as polygons: the outline of labelled cells, and the cells inside of an outline."""

from __future__ import annotations

import math

import numpy as np
import shapely

from roomba.arrays import Mask
from roomba.grid import GridFrame


def outline_of(mask: Mask, frame: GridFrame) -> shapely.Polygon | shapely.MultiPolygon:
    """Return the borders of the true cells, m, as polygons along the axes, with holes.

    ``mask`` is bool [rows, columns] over ``frame``. Parts that touch only at corners are separate.
    """
    runs = np.diff(np.pad(mask, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    rows, begins = np.nonzero(runs == 1)
    ends = np.nonzero(runs == -1)[1]
    # The union is made in whole cells, where it is exact.
    outline = shapely.union_all(shapely.box(begins, rows, ends, rows + 1)).simplify(0.0)
    origin = np.array([frame.origin_x, frame.origin_y])
    return shapely.transform(
        outline.normalize(), lambda corners: corners * frame.resolution + origin
    )


def cells_inside(outline: shapely.Geometry, frame: GridFrame) -> Mask:
    """Return the cells whose middles lie inside of polygons, m, bool [rows, columns]."""
    mask = np.zeros(frame.shape, np.bool_)
    if outline.is_empty:
        return mask
    x_min, y_min, x_max, y_max = outline.bounds
    first_row, first_column = (max(0, cell) for cell in frame.cell_of(x_min, y_min))
    last_row, last_column = frame.cell_of(x_max, y_max)
    rows = np.arange(first_row, min(frame.rows, last_row + 1))
    columns = np.arange(first_column, min(frame.columns, last_column + 1))
    if rows.size == 0 or columns.size == 0:
        return mask
    x, y = frame.centres(rows, columns)
    mask[np.ix_(rows, columns)] = shapely.contains_xy(outline, x[None, :], y[:, None])
    return mask


def line_on(
    frame: GridFrame, start: tuple[float, float], end: tuple[float, float]
) -> tuple[int, int, int, int] | None:
    """Return row and column of both ends of a line's part on the grid; None if no part is on it."""
    if not all(math.isfinite(value) for value in (*start, *end)):
        return None
    x_min, x_max, y_min, y_max = frame.extent
    inside = shapely.LineString([start, end]).intersection(shapely.box(x_min, y_min, x_max, y_max))
    if inside.geom_type != "LineString" or inside.is_empty:
        return None
    (row, column), (to_row, to_column) = (frame.cell_of(x, y) for x, y in inside.coords)
    return row, column, to_row, to_column
