"""Change detection: what stands on a known map's floor now, and what no longer does.

While the robot works and knows its place, its scans are counted on the cells of the map. A *look*
is what the robot saw from several places in some time. Several looks decide, so that people who
walk or stand about are no change. Things too small to be furniture are no change either.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.configuration.mapping import MapChangesConfig
from roomba.geometry import Pose, wrap_angle
from roomba.grid import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from roomba.perception.floors.map_changes_kernels import NO_BOUNDS, count_scan, score_look
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.slam.drawing.drawing_kernels import CountArrays
from roomba.perception.slam.scan_matching.surface_kernels import POINT
from roomba.raster.distance import distance_to_nearest
from roomba.raster.regions import dilated, numbered_regions

_NEAR: Final = np.ones((5, 5), np.bool_)
"""Cells; changed cells as near to each other are one change."""


class ChangeKind(Enum):
    """What happened."""

    APPEARED = "appeared"
    """Something stands on floor that the map shows free."""
    VANISHED = "vanished"
    """Something that the map shows is no longer there."""


@dataclass(frozen=True, slots=True)
class Change:
    """One change: the middle of the cells that changed, how far they reach along the map's axes, m,
    and their area, m2.

    ``cells`` is int64 [n, 2], row and column. Of a thing that appeared these are only the sides
    that were seen.
    """

    kind: ChangeKind
    x: float
    y: float
    width: float
    height: float
    area: float
    cells: NDArray[np.int64] = field(repr=False, compare=False)

    @property
    def size(self) -> float:
        """How far the change reaches along one of the map's axes at most, m."""
        return max(self.width, self.height)


class MapChanges:
    """Collects the changes of one map, in constant memory.

    When a person accepts the :meth:`proposed` map, begin a new object for that map. Tell by
    :meth:`dismissed` which change a person refuses.
    """

    def __init__(self, occupancy: OccupancyMap, config: MapChangesConfig) -> None:
        """Begin with nothing seen of the map."""
        self._map, self._config = occupancy, config
        frame = occupancy.frame
        place = np.array([frame.origin_x, frame.origin_y, frame.resolution])
        hits, passes = np.zeros(frame.shape, np.uint16), np.zeros(frame.shape, np.uint16)
        self._counts = CountArrays(hits, passes, place, NO_BOUNDS.copy())
        self._scores = np.zeros(frame.shape, np.int8)
        self._refused = {kind: np.zeros(frame.shape, np.bool_) for kind in ChangeKind}
        self._is_mapped_near = self._is_blurred(occupancy.solid)
        self._points = np.empty((0, POINT), np.float32)
        self._last: Pose | None = None
        self._look_began = math.inf
        self._look_from = Pose()
        self._known: tuple[Change, ...] | None = ()
        self.looks = 0
        """Number of finished looks; the changes are updated at the end of each."""

    def see(self, now: float, ranges: NDArray[np.float32], lidar: LidarBeams, pose: Pose) -> None:
        """Count a scan, float32 [beams], m, taken at ``now``, s, from a known pose of the map.

        Some 2 to 5 scans a second are enough.
        """
        if not self._is_new(pose):
            return
        if now < self._look_began:
            self._look_began, self._look_from = now, pose
        if len(self._points) < len(ranges):
            self._points = np.empty((len(ranges), POINT), np.float32)
        at = pose.as_array()
        farthest = min(lidar.farthest, self._config.farthest)
        count_scan(
            self._counts,
            ranges,
            lidar.directions,
            lidar.mount,
            lidar.nearest,
            farthest,
            at,
            self._points,
        )
        self._last = pose
        way = pose.distance_to(self._look_from.x, self._look_from.y)
        time = now - self._look_began
        if way >= self._config.look_way and time >= self._config.look_time:
            self._finish_look(now, pose)

    def changes(self) -> tuple[Change, ...]:
        """Return what changed and was not dismissed, the largest first."""
        if self._known is None:
            appeared = list(self._found(ChangeKind.APPEARED))
            vanished = list(self._found(ChangeKind.VANISHED))
            found = [
                *_not_moved(appeared, vanished, self._config),
                *_not_moved(vanished, appeared, self._config),
            ]
            self._known = tuple(sorted(found, key=lambda change: (-change.area, change.x)))
        return self._known

    def dismissed(self, change: Change) -> None:
        """Do not offer this change again, unless what is added to it is a change by itself."""
        refused = self._refused[change.kind]
        cells = np.zeros(refused.shape, np.bool_)
        cells[change.cells[:, 0], change.cells[:, 1]] = True
        refused |= dilated(cells, _NEAR)
        self._known = None

    def proposed(self) -> OccupancyMap:
        """Return the map with the changes made, and nothing else."""
        values = self._map.values.copy()
        for change in self.changes():
            if change.kind is ChangeKind.APPEARED:
                self._put(values, change)
            else:
                self._take_away(values, change)
        return OccupancyMap(self._map.frame, values)

    def _is_new(self, pose: Pose) -> bool:
        last = self._last
        if last is None:
            return True
        turned = abs(wrap_angle(pose.theta - last.theta))
        return (
            pose.distance_to(last.x, last.y) >= self._config.new_way
            or turned >= self._config.new_turn
        )

    def _finish_look(self, now: float, pose: Pose) -> None:
        config = self._config
        score_look(
            self._counts,
            self._scores,
            config.least_beams,
            config.solid_share,
            config.open_share,
        )
        self._look_began, self._look_from = now, pose
        self._known = None
        self.looks += 1

    def _found(self, kind: ChangeKind) -> Iterator[Change]:
        """Yield the changes of a kind that are large enough and were not dismissed."""
        cells = self._appeared() if kind is ChangeKind.APPEARED else self._vanished()
        regions = numbered_regions(dilated(cells, _NEAR)) * cells
        for number in np.unique(regions[cells]).tolist():
            region = regions == number
            fresh = region & ~self._refused[kind]
            if self._is_furniture(region) and self._is_furniture(fresh):
                yield self._change(kind, region)

    def _appeared(self) -> Mask:
        """Return the cells of floor where something stands now."""
        candidates = (self._map.values == FREE) & (self._scores >= self._config.sure)
        near_core = dilated(candidates & ~self._is_mapped_near, _NEAR)
        return np.asarray(candidates & near_core)

    def _vanished(self) -> Mask:
        """Return the cells of things that were seen through."""
        occupied = self._map.values == OCCUPIED
        sure = self._config.sure
        candidates = occupied & (self._scores <= -sure)
        is_near = self._is_blurred((occupied & ~candidates) | (self._scores >= sure))
        return np.asarray(candidates & dilated(candidates & ~is_near, _NEAR))

    def _is_furniture(self, cells: Mask) -> bool:
        rows, columns = np.nonzero(cells)
        if not len(rows):
            return False
        size = self._map.frame.resolution
        length = math.hypot(np.ptp(rows), np.ptp(columns)) * size
        config = self._config
        return len(rows) * size**2 >= config.least_area or length >= config.least_length

    def _is_blurred(self, stands: Mask) -> Mask:
        """Return the cells too near to what stands to tell a change.

        There some beams end and some pass, by the noise of ranges and poses and the edges of cells.
        """
        cells = self._config.blur / self._map.frame.resolution
        return np.asarray(distance_to_nearest(stands) <= cells)

    def _change(self, kind: ChangeKind, region: Mask) -> Change:
        cells = np.argwhere(region)
        frame = self._map.frame
        (low_row, low_column), (high_row, high_column) = cells.min(axis=0), cells.max(axis=0)
        x_min, y_min = frame.centre_of(int(low_row), int(low_column))
        x_max, y_max = frame.centre_of(int(high_row), int(high_column))
        size = frame.resolution
        return Change(
            kind,
            0.5 * (x_min + x_max),
            0.5 * (y_min + y_max),
            x_max - x_min + size,
            y_max - y_min + size,
            len(cells) * size**2,
            cells,
        )

    def _put(self, values: NDArray[np.int8], change: Change) -> None:
        """Make the change's cells occupied, and floor that these enclose unknown."""
        values[change.cells[:, 0], change.cells[:, 1]] = OCCUPIED
        low, high = change.cells.min(axis=0) - 1, change.cells.max(axis=0) + 1
        regions = numbered_regions(values == FREE)
        outside = np.ones(values.shape, np.bool_)
        outside[max(low[0], 0) : high[0] + 1, max(low[1], 0) : high[1] + 1] = False
        reaches_out = np.zeros(int(regions.max(initial=0)) + 1, np.bool_)
        reaches_out[np.unique(regions[outside])] = True
        reaches_out[0] = True
        values[~reaches_out[regions]] = UNKNOWN

    def _take_away(self, values: NDArray[np.int8], change: Change) -> None:
        """Make the change's cells free, and enter what is seen now of the unknown behind them."""
        gone = np.zeros(values.shape, np.bool_)
        gone[change.cells[:, 0], change.cells[:, 1]] = True
        values[gone] = FREE
        config = self._config
        reach = config.behind / self._map.frame.resolution
        behind = (values == UNKNOWN) & (distance_to_nearest(gone) <= reach)
        values[behind & (self._scores <= -config.sure)] = FREE
        values[behind & (self._scores >= config.sure)] = OCCUPIED


def _not_moved(
    changes: list[Change], others: list[Change], config: MapChangesConfig
) -> list[Change]:
    """Return changes without small things, as chairs, that moved: ``others`` show them near by."""
    return [
        change
        for change in changes
        if change.size > config.movable
        or not any(
            other.size <= config.movable
            and math.hypot(other.x - change.x, other.y - change.y) <= config.moved
            for other in others
        )
    ]
