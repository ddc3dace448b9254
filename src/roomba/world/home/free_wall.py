"""Walls that stand free of the grid: slanted ones, round ones, panes of glass, mirrors.

They are exact for bodies and sensors: the outline is what is met. Round ones are chains of straight
pieces, off the circle by no more than :data:`ROUND_ERROR`. Metres, map frame.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.geometry import Point
from roomba.grid import GridFrame
from roomba.world.home.surface import Surface

ROUND_ERROR: Final = 5e-4
"""m; how far the pieces of a round wall are off the circle, at most."""
LONGEST_PIECE: Final = 0.06
"""m; of a round wall: between longer pieces the camera would draw an edge."""


@dataclass(frozen=True, slots=True)
class FreeWall:
    """One such wall.

    ``outline`` are its corners, counter-clockwise. The camera draws blocks along ``line``, each
    ``thickness`` m wide, in the look of ``material``; a piece of furniture, which is drawn by
    itself, has no line. ``surface`` is what it does to light, None as other walls do.
    It stands on the robot's map if it is ``on_map``.
    """

    outline: tuple[Point, ...]
    line: tuple[Point, ...] = ()
    thickness: float = 0.0
    material: str = "wall"
    surface: Surface | None = None
    on_map: bool = True

    @property
    def polygon(self) -> shapely.Polygon:
        """Its outline as a polygon."""
        return shapely.Polygon(self.outline)


@dataclass(frozen=True, slots=True, eq=False)
class FreeWalls:
    """All walls of a home, and the cells that they touch: bool [rows, columns] over its grid."""

    walls: tuple[FreeWall, ...]
    touched: Mask

    @staticmethod
    def on(frame: GridFrame, walls: Sequence[FreeWall]) -> FreeWalls:
        """Return walls over a grid."""
        return FreeWalls(tuple(walls), touched_cells(frame, walls))


def arc_points(
    centre: tuple[float, float], radius: float, first: float, last: float
) -> list[tuple[float, float]]:
    """Return points on a circle from one direction, rad, to another, no farther apart than allowed.

    A chord of an angle a is off the circle by radius (1 - cos(a / 2)).
    """
    by_error = 2.0 * math.acos(max(-1.0, 1.0 - ROUND_ERROR / radius))
    step = min(by_error, LONGEST_PIECE / radius)
    count = max(1, math.ceil(abs(last - first) / step - 1e-9))
    angles = np.linspace(first, last, count + 1).tolist()
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def line_outline(points: Sequence[tuple[float, float]], thickness: float) -> shapely.Polygon:
    """Return the outline of a wall along a line: mitred at corners, square at its ends."""
    whole = shapely.LineString(points).buffer(
        0.5 * thickness, cap_style="flat", join_style="mitre", mitre_limit=10.0
    )
    return shapely.Polygon() if not isinstance(whole, shapely.Polygon) else whole


def arc_outline(
    centre: tuple[float, float], radius: float, first: float, last: float, thickness: float
) -> shapely.Polygon:
    """Return the outline of a round wall whose middle has this radius: a part of a ring."""
    outer = arc_points(centre, radius + 0.5 * thickness, first, last)
    inner = arc_points(centre, radius - 0.5 * thickness, last, first)
    return shapely.Polygon([*outer, *inner])


def counter_clockwise(polygon: shapely.Polygon) -> tuple[Point, ...]:
    """Return the corners of a polygon without holes, counter-clockwise, each once."""
    ring = shapely.geometry.polygon.orient(polygon).exterior
    return tuple((float(x), float(y)) for x, y in list(ring.coords)[:-1])


def touched_cells(frame: GridFrame, walls: Iterable[FreeWall]) -> Mask:
    """Return the cells whose squares any of the walls overlaps, bool [rows, columns]."""
    mask = np.zeros(frame.shape, np.bool_)
    for wall in walls:
        rows, columns, squares = _squares_around(frame, wall)
        mask[rows, columns] |= shapely.intersects(wall.polygon, squares)
    return mask


def filled_cells(frame: GridFrame, walls: Iterable[FreeWall]) -> Mask:
    """Return the cells whose squares lie within one of the walls, bool [rows, columns]."""
    mask = np.zeros(frame.shape, np.bool_)
    for wall in walls:
        rows, columns, squares = _squares_around(frame, wall)
        mask[rows, columns] |= shapely.contains(wall.polygon, squares)
    return mask


def inside(walls: Iterable[FreeWall], x: NDArray[np.float64], y: NDArray[np.float64]) -> Mask:
    """Tell which points lie in any of the walls; of the shape of ``x`` and ``y``."""
    found = np.zeros(x.shape, np.bool_)
    for wall in walls:
        polygon = wall.polygon
        x_min, y_min, x_max, y_max = polygon.bounds
        near = (x >= x_min) & (x <= x_max) & (y >= y_min) & (y <= y_max) & ~found
        found[near] = shapely.contains_xy(polygon, x[near], y[near])
    return found


def _squares_around(frame: GridFrame, wall: FreeWall) -> tuple[slice, slice, NDArray[np.object_]]:
    x_min, y_min, x_max, y_max = wall.polygon.bounds
    low, high = frame.cell_of(x_min, y_min), frame.cell_of(x_max, y_max)
    rows = slice(max(low[0], 0), max(0, min(high[0] + 1, frame.rows)))
    columns = slice(max(low[1], 0), max(0, min(high[1] + 1, frame.columns)))
    left = frame.origin_x + np.arange(columns.start, columns.stop) * frame.resolution
    bottom = frame.origin_y + np.arange(rows.start, rows.stop) * frame.resolution
    lefts, bottoms = np.meshgrid(left, bottom)
    # A hair less, so that a wall along a line between cells does not touch those beyond it.
    hair = 1e-9
    squares = shapely.box(
        lefts + hair,
        bottoms + hair,
        lefts + frame.resolution - hair,
        bottoms + frame.resolution - hair,
    )
    return rows, columns, np.asarray(squares)
