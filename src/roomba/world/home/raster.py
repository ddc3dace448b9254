"""Rasterizing: the cells that things cover, and where a round body fits between them."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.grid import GridFrame
from roomba.raster.regions import dilated, numbered_regions
from roomba.world.home.home import Box, Rectangle

RELEVANT_SHARE = 0.10
"""0..1; a cell of which this share is covered counts as covered."""


def footprint(box: Box) -> shapely.Polygon:
    """Return the outline of a box on the floor, m."""
    cosine, sine = math.cos(box.theta), math.sin(box.theta)
    corners = []
    for along, across in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        x, y = along * box.length / 2.0, across * box.width / 2.0
        corners.append((box.x + cosine * x - sine * y, box.y + sine * x + cosine * y))
    return shapely.Polygon(corners)


def outline(area: Rectangle) -> shapely.Polygon:
    """Return a rectangle as a polygon, m."""
    return shapely.box(area.x_min, area.y_min, area.x_max, area.y_max)


def covered_cells(frame: GridFrame, polygons: Iterable[shapely.Polygon]) -> Mask:
    """Return the cells whose squares the polygons overlap by a relevant part, bool [rows, columns].

    A thing too small for that share of any cell covers the one cell that it covers most.
    """
    mask = np.zeros(frame.shape, np.bool_)
    for polygon in polygons:
        _cover(mask, frame, polygon)
    return mask


def _cover(mask: Mask, frame: GridFrame, polygon: shapely.Polygon) -> None:
    x_min, y_min, x_max, y_max = polygon.bounds
    low = frame.cell_of(x_min, y_min)
    high = frame.cell_of(x_max, y_max)
    rows = np.arange(max(low[0], 0), min(high[0] + 1, frame.rows))
    columns = np.arange(max(low[1], 0), min(high[1] + 1, frame.columns))
    if rows.size == 0 or columns.size == 0:
        return
    left = frame.origin_x + columns * frame.resolution
    bottom = frame.origin_y + rows * frame.resolution
    if math.isclose(polygon.area, (x_max - x_min) * (y_max - y_min), rel_tol=1e-9):
        # Along the axes the overlap is a product, and a large hall is quick.
        share = np.outer(
            _overlap(bottom, frame.resolution, y_min, y_max),
            _overlap(left, frame.resolution, x_min, x_max),
        )
    else:
        lefts, bottoms = np.meshgrid(left, bottom)
        squares = shapely.box(lefts, bottoms, lefts + frame.resolution, bottoms + frame.resolution)
        share = shapely.area(shapely.intersection(squares, polygon)) / frame.resolution**2
    # Rounding must not decide about a share that is exactly the limit.
    covered = share >= RELEVANT_SHARE - 1e-9
    if not covered.any():
        covered = (share == share.max()) & (share > 0.0)
    mask[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] |= covered


def _overlap(
    starts: NDArray[np.float64], size: float, low: float, high: float
) -> NDArray[np.float64]:
    """Return the share of each interval [start, start + size] that [low, high] covers, 0..1."""
    lengths = np.minimum(starts + size, high) - np.maximum(starts, low)
    return np.asarray(np.maximum(lengths, 0.0) / size)


def distance_to_cells(frame: GridFrame, mask: Mask, x: float, y: float) -> float:
    """Return the distance from a point to the mask's nearest square or the grid's border, m."""
    lowest_x, highest_x, lowest_y, highest_y = frame.extent
    border = min(x - lowest_x, highest_x - x, y - lowest_y, highest_y - y)
    rows, columns = np.nonzero(mask)
    if rows.size == 0:
        return border
    half = frame.resolution / 2.0
    centres_x, centres_y = frame.centres(rows, columns)
    across, up = np.abs(centres_x - x) - half, np.abs(centres_y - y) - half
    distances = np.hypot(np.maximum(across, 0.0), np.maximum(up, 0.0))
    return min(border, float(distances.min()))


def cells_within(frame: GridFrame, radius: float, x: float, y: float) -> Mask:
    """Return the cells whose squares come nearer than ``radius`` m to a point."""
    columns, rows = frame.centres()
    half = frame.resolution / 2.0
    up = np.maximum(np.abs(rows - y) - half, 0.0)[:, None]
    across = np.maximum(np.abs(columns - x) - half, 0.0)[None, :]
    return np.asarray(np.hypot(up, across) < radius)


def where_body_fits(frame: GridFrame, solid: Mask, radius: float) -> Mask:
    """Return the cells at whose centres a disc of ``radius`` m touches no solid square; exact.

    Beyond the grid all is solid.
    """
    reach = math.ceil(radius / frame.resolution + 0.5)
    offsets = np.maximum(np.abs(np.arange(-reach, reach + 1)) - 0.5, 0.0) * frame.resolution
    disc = np.hypot(offsets[:, None], offsets[None, :]) < radius
    padded = np.pad(solid, reach, constant_values=True)
    return np.asarray(~dilated(padded, disc)[reach:-reach, reach:-reach])


def with_neighbours(mask: Mask) -> Mask:
    """Return the cells of a mask and those around them, bool [rows, columns]."""
    return dilated(mask, np.ones((3, 3), np.bool_))


def largest_component(mask: Mask) -> Mask:
    """Return the largest part of a mask that hangs together (by edges); empty if the mask is."""
    regions = numbered_regions(mask)
    sizes = np.bincount(regions.ravel())
    sizes[0] = 0
    return np.asarray(mask & (regions == np.argmax(sizes)))
