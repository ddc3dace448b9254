"""Dirty floor, which is swept once more: in passing, or in a round of its own at the end."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from roomba.arrays import Floats, Mask
from roomba.clock import is_recent
from roomba.configuration.mission import CleaningConfig
from roomba.geometry import Point
from roomba.mission.cleaning.dirty.watch_kernels import WATCH, may_be_dirty
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.perception.swept.dirt_map import CELL, DirtMap
from roomba.raster.regions import Labels, dilated, large_regions, numbered_regions

_AROUND: Final = np.ones((3, 3), np.bool_)
_HAIR: Final = 1e-4
"""m of tolerance: on grids many distances are equal, and the last bits must not decide."""
_MISSED: Final = 0.02
"""Share that may be missed of a patch that counts as swept as a whole: specks stay at walls."""


@dataclass(frozen=True, slots=True, eq=False)
class DirtyPatch:
    """Connected dirty floor: ``cells``, bool over the dirt map; ``floor`` over the fine grid."""

    cells: Mask
    floor: Mask


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
        self.watch["looked_at"] = self.watch["measured_at"] = -math.inf

    def left(self, coverage: CoverageMap, floor: Mask) -> list[DirtyPatch]:
        """Return the dirty patches of a swept floor that were not swept again, each once."""
        cells = large_regions(self._dirty() & ~self._again, CELL, self._config.least_dirty)
        self._again |= cells
        self.done |= cells
        return self._each(cells, numbered_regions(cells), coverage, floor)

    def may_be_at_hand(self, here: Point, now: float) -> bool:
        """Whether it is time, s, to look for dirty floor close by: see :func:`may_be_dirty`."""
        dirt = self.dirt
        return bool(
            may_be_dirty(self.watch, dirt.grains, dirt.way, self.done, dirt.place, *here, now)
        )

    def at_hand(
        self, coverage: CoverageMap, floor: Mask, here: Point, now: float
    ) -> list[DirtyPatch]:
        """Return the dirty patches of a floor close by that are swept as a whole.

        Each is told once; :meth:`note_again` tells that it is swept again. No patch while too
        little was swept to tell what is usual. ``now`` is the time, s.
        """
        self._measure(now)
        cells = self.dirt.cells_from(float(self.watch["dirty_from"][0])) & ~self.done
        cells = large_regions(cells, CELL, self._config.least_dirty)
        if not cells.any():
            return []
        patches = numbered_regions(dilated(cells, _AROUND))
        at_hand = self._are_near(patches, here)
        if not at_hand.any():
            return []
        at_hand &= self._are_whole(patches, at_hand, coverage, floor)
        cells &= at_hand[patches]
        self.done |= cells
        return self._each(cells, patches, coverage, floor)

    def note_again(self, patch: DirtyPatch) -> None:
        """Note that a patch that was told is swept again now, and so not at the end."""
        self._again |= patch.cells

    def places_of(self, patch: DirtyPatch) -> Floats:
        """Return the middles of a patch's cells, float64 [n >= 1, 2], m."""
        return np.column_stack(self.dirt.frame.centres(*np.nonzero(patch.cells)))

    def _measure(self, now: float) -> None:
        """Measure, when that is due, from how many grains on floor counts as dirty.

        While too little was swept to tell what is usual, no floor does.
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

    def _each(
        self, cells: Mask, labels: Labels, coverage: CoverageMap, floor: Mask
    ) -> list[DirtyPatch]:
        """Return the cells of each label as a patch, but only patches with swept floor."""
        patches = []
        for number in np.unique(labels[cells]):
            patch = cells & (labels == number)
            fine = self.dirt.over(patch, coverage.frame) & floor & coverage.swept
            if fine.any():
                patches.append(DirtyPatch(patch, fine))
        return patches

    def _are_near(self, patches: Labels, here: Point) -> Mask:
        """Return of each patch, by its number, whether it is close by; bool [patches + 1]."""
        rows, columns = np.nonzero(patches)
        x, y = self.dirt.frame.centres(rows, columns)
        are_near = np.zeros(int(patches.max()) + 1, np.bool_)
        away = np.hypot(x - here[0], y - here[1])
        are_near[patches[rows, columns][away < self._config.dirty_near + _HAIR]] = True
        return are_near

    def _are_whole(self, patches: Labels, asked: Mask, coverage: CoverageMap, floor: Mask) -> Mask:
        """Return of each patch, by its number, whether its wanted floor, also around it, is swept.

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
