"""Where the round body fits: exact clearance of points, of straight ways, and of a whole map.

Metres in the map frame; everything that is not known to be free, and all outside the map, is solid.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import entry, part
from roomba.geometry import Point, RoundObstacle
from roomba.grid import GridFrame, OccupancyMap
from roomba.planning.path.straight_walls import has_shares, solid_parts
from roomba.raster.regions import dilated, numbered_regions

_PARTS = 5
"""Parts along each side of a cell that is solid in part; odd, so that one is in the middle."""
_TOUCH = 1e-9
"""m; tolerance, so that a body at exactly the wanted distance fits despite rounding."""


@dataclass(frozen=True, eq=False)
class FitMap:
    """Where a disc of radius ``reach``, m, fits on ``map`` among round ``obstacles``.

    ``fits``, bool [rows, columns], is exact for the disc's middle on each cell's centre: there the
    disc touches no square of a cell that is not free, no obstacle, and nothing outside the map.
    Between neighbouring centres that fit, a wall's corner can be nearer than ``reach`` by the
    sagitta, ``resolution**2 / (8 * reach)``, at most: 1.7 mm for 5 cm cells and 0.18 m. ``solid``,
    bool, has squares of ``cell``, m: the map's cells, or parts of them, so that oblique straight
    walls are where they really lie within their cells.
    """

    map: OccupancyMap
    reach: float
    obstacles: tuple[RoundObstacle, ...]
    fits: Mask
    _fits_walls: Mask
    solid: Mask
    cell: float

    @classmethod
    def build(
        cls,
        map: OccupancyMap,
        body_radius: float,
        clearance: float,
        obstacles: Iterable[RoundObstacle] = (),
    ) -> FitMap:
        """Return where a disc of ``body_radius`` + ``clearance``, m, fits.

        Raises ValueError for a radius, a clearance or an obstacle that is not finite or negative.
        """
        reach = body_radius + clearance
        if not (math.isfinite(reach) and body_radius > 0.0 and clearance >= 0.0):
            raise ValueError(
                "expected a finite body_radius above 0 m and a clearance of 0 m or more, "
                f"got {body_radius} and {clearance}"
            )
        # Dilating by the cells that a centred disc touches is exact; a distance transform measures
        # from the cells' centres, not from their squares.
        parts = _PARTS if has_shares(map) else 1
        solid, cell = solid_parts(map, parts), map.frame.resolution / parts
        span = math.ceil(reach / cell)
        outward = np.maximum(np.abs(np.arange(-span, span + 1)) - 0.5, 0.0)
        nearest = np.hypot(outward[:, None], outward) * cell
        fenced = np.pad(solid, 1, constant_values=True)
        middle = parts // 2
        fits = ~dilated(fenced, nearest < reach - _TOUCH)[1:-1, 1:-1][middle::parts, middle::parts]
        fits.flags.writeable = False
        return cls(map, reach, (), fits, fits, solid, cell).with_obstacles(obstacles)

    def with_obstacles(self, obstacles: Iterable[RoundObstacle]) -> FitMap:
        """Return the fit map of the same walls with these obstacles in place of the present ones.

        Raises ValueError for an obstacle that is not three finite numbers with a radius >= 0.
        """
        checked = checked_obstacles(obstacles)
        if checked == self.obstacles:
            return self
        fits = clear_of(self._fits_walls, self.map.frame, checked, self.reach - _TOUCH)
        return replace(self, obstacles=checked, fits=fits)

    @cached_property
    def regions(self) -> NDArray[np.int32]:
        """Numbers of the connected regions in which the body fits, int32 [rows, columns]; 0: none.

        Cells are connected over sides: between two that touch only at a corner the body does not
        fit.
        """
        labels = numbered_regions(self.fits)
        labels.flags.writeable = False
        return labels

    @cached_property
    def _circles(self) -> NDArray[np.float64]:
        """The obstacles as rows, float64 [n, 3], m."""
        return np.array(self.obstacles, np.float64).reshape(-1, 3)

    def room_along(self, start: Point, end: Point) -> float:
        """Return how near anything solid is to the straight way between two points, m.

        The distance is exact; 0 in solid things, below 0 inside a round obstacle. It is never more
        than ``reach`` plus one cell: beyond that nothing matters.
        """
        frame, cell = self.map.frame, self.cell
        limit = self.reach + frame.resolution
        (x, y), (to_x, to_y) = start, end
        room = cell * _room_among_cells(
            self.solid,
            (x - frame.origin_x) / cell,
            (y - frame.origin_y) / cell,
            (to_x - frame.origin_x) / cell,
            (to_y - frame.origin_y) / cell,
            limit / cell,
        )
        return float(min(room, room_beside(self._circles, x, y, to_x, to_y)))

    def fits_along(self, start: Point, end: Point) -> bool:
        """Whether the body fits everywhere on the straight way between two points; exact."""
        return self.room_along(start, end) >= self.reach - _TOUCH

    def fits_at(self, x: float, y: float) -> bool:
        """Whether the body fits at a point, which need not be a cell's centre; exact."""
        return self.fits_along((x, y), (x, y))


def checked_obstacles(obstacles: Iterable[RoundObstacle]) -> tuple[RoundObstacle, ...]:
    """Return the obstacles as plain numbers.

    Raises ValueError for one that is not three finite numbers with a radius >= 0.
    """
    return tuple(_checked(obstacle) for obstacle in obstacles)


def _checked(obstacle: RoundObstacle) -> RoundObstacle:
    x, y, radius = (float(value) for value in obstacle)
    if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(radius) and radius >= 0.0):
        raise ValueError(
            f"expected an obstacle as finite (x, y, radius >= 0) in m, got ({x}, {y}, {radius})"
        )
    return x, y, radius


def clear_of(
    fits: Mask, frame: GridFrame, obstacles: Iterable[RoundObstacle], reach: float
) -> Mask:
    """Return the cells of ``fits`` whose centres are ``reach``, m, or more from all obstacles.

    Bool [rows, columns] of ``frame``; it cannot be written.
    """
    clear = fits.copy()
    for x, y, radius in obstacles:
        away = radius + reach
        row, column = frame.cell_of(x - away, y - away)
        last_row, last_column = frame.cell_of(x + away, y + away)
        rows = slice(max(row, 0), max(last_row + 1, 0))
        columns = slice(max(column, 0), max(last_column + 1, 0))
        across, up = frame.centres(np.arange(frame.rows)[rows], np.arange(frame.columns)[columns])
        clear[rows, columns] &= np.hypot(up[:, None] - y, across - x) >= away
    clear.flags.writeable = False
    return clear


@entry
def room_beside(
    circles: NDArray[np.float64], start_x: float, start_y: float, end_x: float, end_y: float
) -> float:
    """Return the distance between a segment and circles, float64 [n, 3], below 0 inside of one."""
    room = math.inf
    for n in range(len(circles)):
        x, y, radius = circles[n, 0], circles[n, 1], circles[n, 2]
        away = _point_to_segment(x, y, start_x, start_y, end_x, end_y)
        room = min(room, away - radius)
    return room


@entry
def _point_to_segment(
    x: float, y: float, start_x: float, start_y: float, end_x: float, end_y: float
) -> float:
    """Return the distance of a point from a segment that may have no length."""
    along_x, along_y = end_x - start_x, end_y - start_y
    square = along_x * along_x + along_y * along_y
    share = 0.0
    if square > 0.0:
        share = ((x - start_x) * along_x + (y - start_y) * along_y) / square
        share = min(max(share, 0.0), 1.0)
    return math.hypot(x - start_x - share * along_x, y - start_y - share * along_y)


@part
def _crosses_square(
    start_x: float, start_y: float, end_x: float, end_y: float, column: int, row: int
) -> bool:
    """Whether a segment meets the unit square of a cell (clipping it by the square's sides)."""
    first, last = 0.0, 1.0
    for start, along, low in (
        (start_x, end_x - start_x, column),
        (start_y, end_y - start_y, row),
    ):
        if along == 0.0:
            if start < low or start > low + 1:
                return False
        else:
            enter, leave = (low - start) / along, (low + 1 - start) / along
            first = max(first, min(enter, leave))
            last = min(last, max(enter, leave))
    return first <= last


@entry
def _room_among_cells(
    solid: Mask, start_x: float, start_y: float, end_x: float, end_y: float, limit: float
) -> float:
    """Return the distance between a segment and the solid squares, at most ``limit``; in cells."""
    rows, columns = solid.shape
    room = min(start_x, end_x, columns - start_x, columns - end_x, limit)
    room = max(min(room, start_y, end_y, rows - start_y, rows - end_y), 0.0)
    first_row = max(math.floor(min(start_y, end_y) - limit), 0)
    last_row = min(math.floor(max(start_y, end_y) + limit), rows - 1)
    first_column = max(math.floor(min(start_x, end_x) - limit), 0)
    last_column = min(math.floor(max(start_x, end_x) + limit), columns - 1)
    for row in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            if not solid[row, column]:
                continue
            if _crosses_square(start_x, start_y, end_x, end_y, column, row):
                return 0.0
            for x, y in ((start_x, start_y), (end_x, end_y)):
                outside_x = max(column - x, 0.0, x - column - 1)
                outside_y = max(row - y, 0.0, y - row - 1)
                room = min(room, math.hypot(outside_x, outside_y))
            for x, y in (
                (column, row),
                (column + 1, row),
                (column, row + 1),
                (column + 1, row + 1),
            ):
                room = min(room, _point_to_segment(x, y, start_x, start_y, end_x, end_y))
    return room
