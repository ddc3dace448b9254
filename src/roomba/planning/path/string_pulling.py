"""String pulling: it makes ways over the cells that fit the shortest ones between the walls.

A way over cells bends at their centres, up to about a cell farther from corners than necessary.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import RoundObstacle
from roomba.planning.path.costmap import FitMap, room_beside
from roomba.planning.path.string_kernels import FULL, QUARTER, Pegs, String, mark_corners, pull

_ANGLES = np.arange(4 * QUARTER) * (math.pi / (2 * QUARTER))
_ARC = np.column_stack((np.cos(_ANGLES), np.sin(_ANGLES)))
_TOUCH = 1e-9
"""m; tolerance: a way that keeps exactly the room may be pulled."""
_BESIDE_THINGS = math.sqrt(0.5)
"""Cells, half a diagonal; additional distance from things. Only the seen side of a thing is known,
and a way over cells keeps this much more on average."""
_FIRST_CAPACITY = 256


class StringPulling:
    """Pulls ways among the walls of one map; not for two threads at once."""

    def __init__(self, walls: FitMap) -> None:
        """Take where the disc fits on the map, without round obstacles."""
        frame = walls.map.frame
        half = 0.5 * frame.resolution
        self._walls = walls
        self.room = math.sqrt(max(walls.reach**2 - half**2, 0.0))
        """m; the distance from walls that ways between centres that fit keep. Pulled ways keep it,
        too, but for 0.12 % of it, or of the circle around a thing. For a disc smaller than half a
        cell it is 0, and ways are not pulled."""
        self._make_room(_FIRST_CAPACITY)

    def _make_room(self, capacity: int) -> None:
        self._string = String(
            np.zeros((capacity, 2)),
            np.zeros(capacity, np.uint8),
            np.zeros((capacity, 2)),
            np.zeros((capacity, 2)),
        )

    @cached_property
    def _corners(self) -> NDArray[np.uint8]:
        rows, columns = self._walls.solid.shape
        corners = np.zeros((rows + 1, columns + 1), np.uint8)
        mark_corners(self._walls.solid, corners)
        return corners

    def pulled(
        self, points: NDArray[np.float64], things: Sequence[RoundObstacle] = ()
    ) -> NDArray[np.float64]:
        """Return the way along ``points``, float64 [n, 2], m, pulled to the shortest one.

        ``things`` are round, and not on the map: x, y and radius, m. The way keeps half a cell's
        diagonal more than :attr:`room` from them. Legs with less room stay as they are.
        """
        if self.room == 0.0 or len(points) < 3:
            return points
        frame, cell = self._walls.map.frame, self._walls.cell
        circles = np.array(things, np.float64).reshape(-1, 3)
        circles[:, 2] += self.room + _BESIDE_THINGS * frame.resolution
        pinned = self._pinned(points, circles)
        if pinned.all():
            return points
        origin = np.array((frame.origin_x, frame.origin_y))
        circles[:, :2] -= origin
        pegs = Pegs(self._corners, self.room / cell, circles / cell, _ARC)
        size = self._pull((points - origin) / cell, pinned, pegs)
        pulled: NDArray[np.float64] = self._string.points[:size] * cell + origin
        # Pinned points stay where they were, to the last bit.
        pulled[self._string.pinned[:size] > 0] = points[pinned]
        return pulled

    def _pinned(
        self, points: NDArray[np.float64], circles: NDArray[np.float64]
    ) -> NDArray[np.bool_]:
        """Tell which points stay, bool [n]: both ends, and those of legs with too little room.

        ``circles``, float64 [n, 3], m, around things are those that a way stays out of.
        """
        pinned = np.zeros(len(points), np.bool_)
        pinned[[0, -1]] = True
        for leg, (start, end) in enumerate(pairwise(points.tolist())):
            if (
                self._walls.room_along(start, end) < self.room - _TOUCH
                or room_beside(circles, *start, *end) < -_TOUCH
            ):
                pinned[leg : leg + 2] = True
        return pinned

    def _pull(self, points: NDArray[np.float64], pinned: NDArray[np.bool_], pegs: Pegs) -> int:
        """Pull a way in the work arrays, and return how many points it has then."""
        while True:
            size, capacity = len(points), len(self._string.points)
            if size <= capacity:
                self._string.points[:size] = points
                self._string.pinned[:size] = pinned
                size = pull(self._string, size, pegs)
                if size != FULL:
                    return size
            self._make_room(2 * capacity)
