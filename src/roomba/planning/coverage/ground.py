"""The part of the floor that a robot can reach, with what every plan over it needs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from roomba.arrays import Floats, Mask, Polyline
from roomba.planning.coverage.floor.floor import CoverageFloor
from roomba.planning.coverage.passes.edges import rings
from roomba.planning.coverage.passes.solid_cells import SolidCells
from roomba.planning.coverage.passes.sweep import unswept
from roomba.planning.coverage.tour.net import Net, net_over

_MARGIN = 2
"""cells; margin of the window around the floor that can be swept."""


@dataclass(frozen=True, eq=False)
class Ground:
    """A window of the floor: ``middles``, where the middle can get to, and ``coverable``, the floor
    that is swept from there, bool [rows, columns] both.

    Places on the window are in cells: (x, y) is (column, row), whole numbers are the cells'
    centres.
    """

    floor: CoverageFloor
    window: tuple[slice, slice]
    middles: Mask
    coverable: Mask

    @classmethod
    def around(cls, floor: CoverageFloor, seed: tuple[int, int]) -> Ground:
        """Return the ground that can be reached from a (row, column) of the floor's frame."""
        middles = floor.middles(floor.frame.centre_of(*seed))
        coverable = floor.swept_from(middles)
        rows, columns = (np.flatnonzero(coverable.any(axis=axis)) for axis in (1, 0))
        window = (
            slice(max(int(rows[0]) - _MARGIN, 0), int(rows[-1]) + _MARGIN + 1),
            slice(max(int(columns[0]) - _MARGIN, 0), int(columns[-1]) + _MARGIN + 1),
        )
        return cls(
            floor,
            window,
            np.ascontiguousarray(middles[window]),
            np.ascontiguousarray(coverable[window]),
        )

    def holds(self, cell: tuple[int, int]) -> bool:
        """Whether the middle can get to a (row, column) of the floor's frame."""
        row, column = cell[0] - self.window[0].start, cell[1] - self.window[1].start
        rows, columns = self.middles.shape
        return bool(0 <= row < rows and 0 <= column < columns and self.middles[row, column])

    def place_of(self, cell: tuple[int, int]) -> Floats:
        """Return the place, float64 [2], of a (row, column) of the floor's frame."""
        return np.array(
            (cell[1] - self.window[1].start, cell[0] - self.window[0].start), np.float64
        )

    def metres(self, places: Floats) -> Floats:
        """Return places, float64 [n, 2], in m in the map frame."""
        rows = places[:, 1] + self.window[0].start
        columns = places[:, 0] + self.window[1].start
        return np.column_stack(self.floor.frame.centres(rows, columns))

    def places(self, points: Floats) -> Floats:
        """Return points, float64 [n, 2], m in the map frame, as places."""
        frame = self.floor.frame
        first = np.array((self.window[1].start, self.window[0].start), np.float64)
        corner = np.array((frame.origin_x, frame.origin_y))
        places: Floats = (points - corner) / frame.resolution - 0.5 - first
        return places

    @property
    def radius(self) -> float:
        """Half the tool's width, cells."""
        return self.floor.tool_width / 2 / self.floor.frame.resolution

    @cached_property
    def net(self) -> Net:
        """The net on which ways are searched."""
        return net_over(self.middles)

    @cached_property
    def rings(self) -> list[Polyline]:
        """The outlines of ``middles``, straightened."""
        floor, size = self.floor, self.floor.frame.resolution
        things = np.array(floor.obstacles, np.float64).reshape(-1, 3)
        things = np.column_stack((self.places(things[:, :2]), things[:, 2] / size))
        column, row = self.window[1].start, self.window[0].start
        walls = SolidCells(floor.solid, column, row, floor.reach / size, things)
        return rings(self.middles, walls, is_aslant=floor.is_aslant)

    @cached_property
    def rounded_off(self) -> Mask:
        """Floor that could be swept, but that smooth ways along slanted walls leave; a mask."""
        plain = rings(self.middles)
        if all(np.array_equal(one, other) for one, other in zip(plain, self.rings, strict=True)):
            return np.zeros_like(self.middles)
        return unswept(self.coverable & ~self.middles, self.rings, self.radius)
