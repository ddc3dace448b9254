"""The dirt map: what the dirt sensor counted, place by place, learned over many runs."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats32, Mask
from roomba.compilation import entry
from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.raster.carried import carried

Window = tuple[slice, slice]
"""Rows and columns of a part of a grid."""

CELL: Final = 0.20
"""m; about the width of the tool, which limits the sensor's resolution."""
LEAST_WAY: Final = 0.5 * CELL
"""m; after a shorter way in a cell it is not known how dirty the cell is."""
_ALL_OF_IT: Final = (slice(None), slice(None))
_LEARNING: Final = 0.4
"""Share of the newest run in the learned density of a cell."""
_OFF_SIDES: Final = 1.3e-5
"""m by which the sides of cells lie off the frame's. Ways lead along the frame's sides, and
rounding must not decide in which cell a grain is counted."""
_JUST_SO: Final = 1.0 - 1e-4
"""Factor on the density from which on floor is dirty, so that floor that just reaches it is."""


class DirtMap:
    """Density of dirt, grains per m2 of floor, by cells of ``frame``.

    ``learned`` float32 [rows, columns] is the density by all earlier runs, NaN where the robot
    never was. ``grains`` and ``way`` are of the present run: what was counted in a cell, and the
    way driven there, m.
    """

    def __init__(self, occupancy: OccupancyMap) -> None:
        """Begin with nothing known, on a grid over a map."""
        self.frame = frame = occupancy.frame.with_cells(CELL)
        self.learned: Floats32 = np.full(self.frame.shape, np.nan, np.float32)
        self.grains: Floats32 = np.zeros(self.frame.shape, np.float32)
        self.way: Floats32 = np.zeros(self.frame.shape, np.float32)
        self.place = np.array([frame.origin_x, frame.origin_y, CELL])

    def note(self, x: float, y: float, grains: float, way: float) -> None:
        """Note what was counted at a place over a way, m."""
        note_dirt(self.grains, self.way, self.place, x, y, grains, way)

    def carry_on(self, before: DirtMap, moved: Pose) -> None:
        """Take over the dirt map of an older map of this home.

        ``moved`` is where the older map's frame lies in this one.
        """
        frames = (before.frame, self.frame, moved)
        self.learned = carried(before.learned, *frames, nothing=math.nan)
        self.grains, self.way = carried(before.grains, *frames), carried(before.way, *frames)

    def end_run(self) -> None:
        """Learn from the present run, and begin another."""
        seen = self.way > LEAST_WAY
        now = self._density_now()
        known = ~np.isnan(self.learned)
        both, first = seen & known, seen & ~known
        self.learned[both] += _LEARNING * (now[both] - self.learned[both])
        self.learned[first] = now[first]
        self.grains[:] = 0.0
        self.way[:] = 0.0

    def usual(self) -> float:
        """Return the median density of the present run, grains/m2; 0 while there is none."""
        seen = self.way > LEAST_WAY
        return float(np.median(self._density_now()[seen])) if seen.any() else 0.0

    def density(self, mask: Mask, frame: GridFrame) -> float:
        """Return the mean learned density over a mask on another grid, grains/m2; 0 if none."""
        values = self.over(np.nan_to_num(self.learned), frame)[mask]
        return float(values.mean()) if values.size else 0.0

    def found(self, mask: Mask, frame: GridFrame) -> float:
        """Return the present run's grains/m2 over a mask on another grid; 0 if nothing is known.

        If floor was swept twice, the grains of both passes are added up.
        """
        rows, columns = np.nonzero(self.way > LEAST_WAY)
        row, column = frame.cells_of(*self.frame.centres(rows, columns))
        inside = frame.holds(row, column)
        rows, columns = rows[inside], columns[inside]
        here = mask[row[inside], column[inside]]
        area = np.count_nonzero(here) * CELL**2
        return float(self.grains[rows, columns][here].sum() / area) if area else 0.0

    def dirty_cells(self, times: float, least: float) -> Mask:
        """Return where the present run counted ``times`` its usual density or more, over ``frame``.

        Floor with fewer than ``least`` grains/m2 is never dirty.
        """
        return self.cells_from(self.dirty_from(times, least))

    def cells_from(self, density: float) -> Mask:
        """Return where the present run counted ``density`` grains/m2 or more, over ``frame``."""
        dirty: Mask = self._density_now() >= density
        return dirty

    def dirty_from(self, times: float, least: float) -> float:
        """Return the density, grains/m2, from which on floor of the present run is dirty."""
        return _JUST_SO * dirty_from(self._density_now()[self.way > LEAST_WAY], times, least)

    @property
    def seen_area(self) -> float:
        """Area of the floor whose density the present run knows, m2."""
        return float(np.count_nonzero(self.way > LEAST_WAY)) * CELL**2

    def known(self) -> Floats32:
        """Return grains/m2 by cells: by this run where it was, else as learned; NaN if unknown."""
        known: Floats32 = np.where(self.way > LEAST_WAY, self._density_now(), self.learned)
        return known

    def over(
        self, values: NDArray[Any], frame: GridFrame, window: Window = _ALL_OF_IT
    ) -> NDArray[Any]:
        """Return values of the map's own cells at the middles of another grid's cells.

        Only the part of that grid in ``window`` is returned.
        """
        rows = ((np.arange(frame.rows)[window[0]] + 0.5) * frame.resolution / CELL).astype(np.int64)
        columns = ((np.arange(frame.columns)[window[1]] + 0.5) * frame.resolution / CELL).astype(
            np.int64
        )
        over: NDArray[Any] = values[
            np.ix_(np.minimum(rows, values.shape[0] - 1), np.minimum(columns, values.shape[1] - 1))
        ]
        return over

    def window_of(self, cells: Mask, frame: GridFrame) -> Window:
        """Return the part of another grid that ``cells`` of this map lie on; one must be true."""
        first, last = np.argwhere(cells).min(axis=0), np.argwhere(cells).max(axis=0) + 1
        parts = CELL / frame.resolution
        starts = np.floor(first * parts).astype(np.int64)
        ends = np.ceil(last * parts).astype(np.int64)
        return slice(int(starts[0]), int(ends[0])), slice(int(starts[1]), int(ends[1]))

    def _density_now(self) -> Floats32:
        area = np.maximum(self.way, 0.05) * CELL
        density: Floats32 = self.grains / area
        return density


def dirty_from(density: Floats32, times: float, least: float) -> float:
    """Return the density, grains/m2, from which on floor is dirty: ``times`` the median of all.

    It is never less than ``least``. ``density`` is of any shape; NaN where nothing is known.
    """
    known = density[~np.isnan(density)]
    usual = float(np.median(known)) if known.size else 0.0
    return max(times * usual, least)


@entry
def note_dirt(
    grains_of: Floats32,
    way_of: Floats32,
    place: NDArray[np.float64],
    x: float,
    y: float,
    grains: float,
    way: float,
) -> None:
    """Add what was counted at a point, m, to its cell; ``place`` is the grid's corner and cell."""
    row = math.floor((y - place[1] + _OFF_SIDES) / place[2])
    column = math.floor((x - place[0] + _OFF_SIDES) / place[2])
    if 0 <= row < grains_of.shape[0] and 0 <= column < grains_of.shape[1]:
        grains_of[row, column] += np.float32(grains)
        way_of[row, column] += np.float32(way)
