"""What floor the tool can reach: masks over a fine grid of about one centimetre.

Metres in the map frame; everything that is not known to be free, and all outside the map, is solid.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.configuration.coverage import CoverageConfig
from roomba.geometry import Point, RoundObstacle
from roomba.grid import GridFrame, OccupancyMap
from roomba.planning.coverage.floor.masks import filled_from, grown, half_widths
from roomba.planning.path.costmap import checked_obstacles, clear_of
from roomba.planning.path.straight_walls import solid_parts

_TOUCH = 1e-7


def fine_frame(coarse: GridFrame, cell: float) -> GridFrame:
    """Return a grid with cells of about ``cell`` m over the extent of a map's grid."""
    parts = max(1, round(coarse.resolution / cell))
    return GridFrame(
        coarse.resolution / parts,
        coarse.origin_x,
        coarse.origin_y,
        coarse.rows * parts,
        coarse.columns * parts,
    )


@dataclass(frozen=True, eq=False)
class CoverageFloor:
    """Where the middle of a robot may be, and what its tool sweeps from there.

    ``frame`` is the fine grid, over the extent of the map. ``fits``, bool [rows, columns] on it,
    tells of each fine cell whether the robot's middle on the cell's centre keeps ``reach``, m, from
    the squares of all solid cells, from the ``obstacles`` and from the outside of the map; exact. A
    robot in its station is at most ``out_of_station``, m, from where it fits. ``is_aslant``: the
    map has oblique walls of which it tells where they are within their cells.
    """

    frame: GridFrame
    reach: float
    tool_width: float
    out_of_station: float
    is_aslant: bool
    obstacles: tuple[RoundObstacle, ...]
    fits: Mask
    _fits_walls: Mask
    _solid: Mask

    @classmethod
    def build(
        cls, map: OccupancyMap, reach: float, tool_width: float, config: CoverageConfig
    ) -> CoverageFloor:
        """Return the floor of a map for a middle that keeps ``reach`` and a tool, both m.

        Raises ValueError for lengths that are not finite or not above 0.
        """
        for name, length in (("reach", reach), ("tool_width", tool_width)):
            if not (math.isfinite(length) and length > 0.0):
                raise ValueError(f"expected a finite {name} above 0 m, got {length}")
        frame = fine_frame(map.frame, config.cell)
        parts = frame.rows // map.frame.rows
        solid = solid_parts(map, parts)
        fenced = np.pad(solid, 1, constant_values=True)
        near = half_widths((reach - _TOUCH) / frame.resolution, to_squares=True)
        fits = np.ascontiguousarray(~grown(fenced, near)[1:-1, 1:-1])
        fits.flags.writeable = False
        away = config.out_of_station
        is_aslant = bool(solid.sum() < parts**2 * map.solid.sum())
        return cls(frame, reach, tool_width, away, is_aslant, (), fits, fits, solid)

    def with_obstacles(self, obstacles: Iterable[RoundObstacle]) -> CoverageFloor:
        """Return the same floor with these round things, (x, y, radius) in m, in place of others.

        Raises ValueError for an obstacle that is not three finite numbers with a radius >= 0.
        """
        checked = checked_obstacles(obstacles)
        if checked == self.obstacles:
            return self
        fits = clear_of(self._fits_walls, self.frame, checked, self.reach - _TOUCH)
        return replace(self, obstacles=checked, fits=fits)

    @property
    def solid(self) -> Mask:
        """The cells that the map does not show as free, bool [rows, columns] on ``frame``.

        Cells of an oblique straight wall are solid behind the wall's line, and just before it.
        """
        return self._solid

    def middles(self, start: Point) -> Mask:
        """Return the fine cells where the middle may be and can get to from ``start``.

        Bool [rows, columns] on ``frame``, connected over sides; all false when the robot cannot
        move from there. A robot that stands where it does not fit, in its station, is taken to be
        at the nearest place within ``out_of_station`` where it fits, with no wall between.
        """
        seed = self.cell_near(start)
        if seed is None:
            return np.zeros(self.frame.shape, np.bool_)
        return filled_from(self.fits, *seed)

    def coverable(self, start: Point) -> Mask:
        """Return the fine cells that the tool sweeps when the middle goes wherever it can.

        Bool [rows, columns] on ``frame``.
        """
        return self.swept_from(self.middles(start))

    def swept_from(self, middles: Mask) -> Mask:
        """Return the free fine cells within half the tool's width of any of ``middles``.

        Bool [rows, columns] on ``frame``.
        """
        within = half_widths(self.tool_width / 2 / self.frame.resolution + _TOUCH)
        return grown(middles, within) & ~self._solid

    def cell_near(self, point: Point) -> tuple[int, int] | None:
        """Return the (row, column) nearest to a point where the middle may be.

        No wall may bar the way there; None if there is no such cell within ``out_of_station``.
        """
        frame = self.frame
        if not (math.isfinite(point[0]) and math.isfinite(point[1])):
            raise ValueError(f"expected a point of two finite numbers, m, got {point}")
        row, column = frame.cell_of(*point)
        if frame.contains(*point) and self.fits[row, column]:
            return row, column
        span = math.ceil(self.out_of_station / frame.resolution)
        first_row, first_column = max(row - span, 0), max(column - span, 0)
        window = self.fits[
            first_row : max(row + span + 1, 0), first_column : max(column + span + 1, 0)
        ]
        cells = np.argwhere(window) + np.array((first_row, first_column))
        x, y = frame.centres(cells[:, 0], cells[:, 1])
        away = np.hypot(x - point[0], y - point[1])
        for index in np.argsort(away, kind="stable"):
            if away[index] > self.out_of_station:
                break
            if not self._is_walled_off(point, cells[index]):
                return int(cells[index, 0]), int(cells[index, 1])
        return None

    def _is_walled_off(self, point: Point, cell: NDArray[np.int64]) -> bool:
        """Whether the straight way from a point to a cell enters a wall; leaving one is allowed."""
        frame = self.frame
        to_x, to_y = frame.centre_of(int(cell[0]), int(cell[1]))
        steps = max(2, math.ceil(2 * math.dist(point, (to_x, to_y)) / frame.resolution))
        shares = np.linspace(0.0, 1.0, steps)
        columns = (point[0] + shares * (to_x - point[0]) - frame.origin_x) // frame.resolution
        rows = (point[1] + shares * (to_y - point[1]) - frame.origin_y) // frame.resolution
        on_map = (rows >= 0) & (rows < frame.rows) & (columns >= 0) & (columns < frame.columns)
        solid = ~on_map
        solid[on_map] = self._solid[rows[on_map].astype(int), columns[on_map].astype(int)]
        return bool((solid[1:] & ~solid[:-1]).any())
