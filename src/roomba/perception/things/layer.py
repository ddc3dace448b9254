"""The layer of things: what the lidar sees and the map does not show, as chairs and people."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.things import ThingConfig
from roomba.geometry import Pose, RoundObstacle
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.field_kernels import look
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.kernels import first_blocked, note
from roomba.perception.things.range_kernels import unknown_noises
from roomba.perception.things.state import LAYER, Things

Ranges = NDArray[np.float32]

_MOST_CELLS: Final = 4096
"""Cells that may have evidence: 10 m2 of a usual map, more than stands about in a home."""


class ThingLayer:
    """A grid, over the map's frame, of what the lidar sees and the map does not show.

    While the robot knows its place, give each scan to :meth:`see`. ``arrays`` is what kernels work
    on; ``field`` is the map's.
    """

    def __init__(self, field: SurfaceField, config: ThingConfig | None = None) -> None:
        """Begin with nothing; ``field`` is that of the map."""
        self.config = config or ThingConfig()
        self.field = field
        self._field, self._place = field.values, field.place
        rows, columns = field.values.shape
        self._columns = columns
        self.arrays = Things(
            np.zeros(1, LAYER),
            np.zeros(rows * columns, np.int16),
            np.zeros(rows * columns, np.int64),
            np.zeros((rows * columns, 2), np.int16),
            np.zeros(_MOST_CELLS, np.int64),
            np.zeros((rows * columns, 2), np.float32),
            np.zeros((rows * columns, 2), np.float32),
            unknown_noises(self.config.farthest),
        )
        for name, value in self.config.model_dump().items():
            self.arrays.layer[name] = value

    @property
    def version(self) -> int:
        """A number that changes when a thing comes or goes."""
        return int(self.arrays.layer["version"][0])

    def see(
        self,
        ranges: Ranges,
        lidar: LidarBeams,
        pose: Pose,
        scans: int = 1,
        measured: Ranges | None = None,
        unsure: float = 0.01,
    ) -> None:
        """Take a scan, float32 [beams], m, taken at a known pose of the map.

        The scan stands for ``scans`` scans of the lidar, itself included. ``measured`` are the
        original ranges, if ``ranges`` were corrected for the robot's motion. ``unsure`` is the
        standard deviation of the position, m.
        """
        measured = ranges if measured is None else measured
        at = pose.as_array()
        note(self.arrays, self._field, self._place, lidar, ranges, measured, at, unsure, scans)

    def cells(self, least: int | None = None) -> NDArray[np.int64]:
        """Return the cells of things, with evidence of ``least``: int64 [n, 2], row and column."""
        least = self.config.enough if least is None else least
        listed = self.arrays.listed[: int(self.arrays.layer["count"][0])]
        standing = np.sort(listed[self.arrays.evidence[listed] >= least])
        return np.column_stack(np.divmod(standing, max(self._columns, 1)))

    def obstacles(self, least: int | None = None) -> list[RoundObstacle]:
        """Return round things, one for each of these cells: x, y and radius, m, map frame."""
        cells = self.cells(least)
        spots = self.arrays.spots[cells[:, 0] * self._columns + cells[:, 1]]
        return [(x, y, self.config.spot_radius) for x, y in spots.tolist()]

    def first_blocked(
        self,
        points: NDArray[np.float64],
        stations: NDArray[np.float64],
        first: float,
        last: float,
        radius: float,
    ) -> float | None:
        """Return where along a path, [n, 2], a thing is nearer than ``radius``, m; None: nowhere.

        Only the part from ``first`` to ``last``, m along the path, is looked at; ``stations`` [n]
        tells where along the path each point is.
        """
        at = first_blocked(self.arrays, points, stations, first, last, radius)
        return None if math.isnan(at) else float(at)

    def is_mapped(self, x: float, y: float) -> bool:
        """Whether the map shows a surface at a point, m, or next to it."""
        off, _, _ = look(self._field, self._place, x, y)
        return bool(off < self.config.next_to)

    def forget(self) -> None:
        """Begin anew with nothing."""
        had_things = bool(len(self.cells()))
        self.arrays.evidence[:] = 0
        self.arrays.layer["count"] = 0
        self.arrays.layer["version"] += had_things
