"""Dirty floor, which is swept once more: in passing, or in a round of its own at the end."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.clock import is_recent
from roomba.configuration.mission import CleaningConfig
from roomba.mission.cleaning.dirty_kernels import WATCH, may_be_dirty
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.perception.swept.dirt_map import CELL, DirtMap
from roomba.planning.path.costmap import Point
from roomba.raster.regions import Labels, dilated, numbered_regions

Mask = NDArray[np.bool_]

_AROUND: Final = np.ones((3, 3), np.bool_)
_HAIR: Final = 1e-4
"""m; cells and ways lie on grids, so the last bits would decide between distances that are even."""
_MISSED: Final = 0.02
"""Share of a patch that may be missed still when it is swept as a whole: specks stay at walls."""


class DirtyFloor:
    """What was so dirty that it gets another pass; each place once in a pass over the floor."""

    def __init__(self, dirt: DirtMap, config: CleaningConfig) -> None:
        """Begin with none of it swept again."""
        self._config = config
        self.watch = np.zeros(1, WATCH)
        row = self.watch[0]
        row["look_period"], row["measure_period"] = config.dirty_period, config.usual_period
        row["reach"] = config.dirty_near + 2.0 * CELL
        self.begin(dirt)

    def begin(self, dirt: DirtMap) -> None:
        """Go on by another map's dirt, with none of it swept again."""
        self.dirt = dirt
        self.begin_pass()

    def begin_pass(self) -> None:
        """Begin another pass over floor."""
        self._again: Mask = np.zeros(self.dirt.frame.shape, np.bool_)
        self.done: Mask = self._again.copy()
        """What was told, or is swept again: it is not looked for any more."""
        self._last = self._again
        self.watch["looked_at"] = self.watch["measured_at"] = -math.inf

    def left(self, coverage: CoverageMap, floor: Mask) -> Mask:
        """Return what is dirty of a swept floor and was not swept again: it is to be, now.

        Only patches worth a way of their own are told.
        """
        cells = _large(self._dirty() & ~self._again, self._config.least_dirty_round)
        self._again |= cells
        self.done |= cells
        return self._fine(cells, coverage, floor)

    def may_be_at_hand(self, here: Point, now: float) -> bool:
        """Whether it is time, s, to look for dirty floor close by: see :func:`may_be_dirty`."""
        dirt = self.dirt
        return bool(
            may_be_dirty(self.watch, dirt.grains, dirt.way, self.done, dirt.place, *here, now)
        )

    def at_hand(self, coverage: CoverageMap, floor: Mask, here: Point, now: float) -> Mask | None:
        """Return dirty patches of a floor close by that are swept as a whole, or None.

        Each is told once; :meth:`note_again` tells that they are swept again. None as well while
        too little was swept to tell what is usual. ``now`` is the time, s.
        """
        self._measure(now)
        cells = self.dirt.cells_from(float(self.watch["dirty_from"][0])) & ~self.done
        cells = _large(cells, self._config.least_dirty)
        if not cells.any():
            return None
        patches = numbered_regions(dilated(cells, _AROUND))
        at_hand = self._are_near(patches, here)
        if not at_hand.any():
            return None
        at_hand &= self._are_whole(patches, at_hand, coverage, floor)
        if not at_hand.any():
            return None
        cells &= at_hand[patches]
        self.done |= cells
        self._last = cells
        again = self._fine(cells, coverage, floor)
        return again if again.any() else None

    def note_again(self) -> None:
        """What was told last is swept again now; it is not at the end."""
        self._again |= self._last

    def _measure(self, now: float) -> None:
        """Find out from how many grains on floor is dirty, when that is due.

        While too little was swept to tell what is usual none is.
        """
        row, config = self.watch[0], self._config
        row["looked_at"] = now
        if is_recent(now, row["measured_at"], row["measure_period"]):
            return
        row["dirty_from"] = math.inf
        if self.dirt.seen_area >= config.usual_floor:
            row["measured_at"] = now
            row["dirty_from"] = self.dirt.dirty_from(config.dirty_times, config.least_dirt)

    def _dirty(self) -> Mask:
        return self.dirt.dirty_cells(self._config.dirty_times, self._config.least_dirt)

    def _fine(self, cells: Mask, coverage: CoverageMap, floor: Mask) -> Mask:
        fine: Mask = self.dirt.over(cells, coverage.frame) & floor & coverage.swept
        return fine

    def _are_near(self, patches: Labels, here: Point) -> Mask:
        """Return of each patch, by its number, whether it is close by; bool [patches + 1]."""
        rows, columns = np.nonzero(patches)
        x, y = self.dirt.frame.centres(rows, columns)
        are_near = np.zeros(int(patches.max()) + 1, np.bool_)
        away = np.hypot(x - here[0], y - here[1])
        are_near[patches[rows, columns][away < self._config.dirty_near + _HAIR]] = True
        return are_near

    def _are_whole(self, patches: Labels, asked: Mask, coverage: CoverageMap, floor: Mask) -> Mask:
        """Return the same of whether all that is wanted of it, and around it, is swept.

        Only those ``asked`` for, bool [patches + 1], are looked at in full.
        """
        window = self.dirt.window_of(asked[patches], coverage.frame)
        fine = self.dirt.over(patches, coverage.frame, window)
        fine[~floor[window]] = 0
        wanted = np.bincount(fine.ravel(), minlength=asked.size)
        missed = np.bincount(fine[coverage.missed[window]], minlength=asked.size)
        are_whole: Mask = missed <= _MISSED * wanted
        are_whole[0] = False
        return are_whole


def _large(cells: Mask, least: float) -> Mask:
    """Return what of some cells of a dirt map is in patches of ``least`` m2 or more."""
    labels = numbered_regions(cells)
    is_large = np.bincount(labels.ravel()) * CELL**2 >= least
    is_large[0] = False
    return np.asarray(is_large[labels])
