"""A path: straight legs from point to point, measured along its length."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles


class _Leg(NamedTuple):
    """A straight piece: where it begins, as arc length and as a point, m, and its direction."""

    start: float
    x: float
    y: float
    length: float
    ahead_x: float
    ahead_y: float


@dataclass(frozen=True, eq=False)
class Path:
    """A way over the floor: ``points``, float64 [n, 2], m in the map frame, n >= 1, no two the same
    in a row. A place on it is told by its arc length from the start, m."""

    points: NDArray[np.float64]

    def __post_init__(self) -> None:
        """Check the points, and lock them."""
        if self.points.ndim != 2 or self.points.shape[1] != 2 or len(self.points) == 0:
            raise ValueError(f"expected points of shape [n >= 1, 2], got {self.points.shape}")
        self.points.flags.writeable = False

    @cached_property
    def _legs(self) -> NDArray[np.float64]:
        return np.diff(self.points, axis=0)

    @cached_property
    def stations(self) -> NDArray[np.float64]:
        """Arc length at each point, m, float64 [n], from 0 to ``length``."""
        lengths = np.hypot(self._legs[:, 0], self._legs[:, 1])
        return np.concatenate(([0.0], np.cumsum(lengths)))

    @cached_property
    def _straights(self) -> list[_Leg]:
        """The legs as plain numbers: a robot looks at few of them, for which arrays are slower."""
        lengths = np.diff(self.stations)
        directions = self._legs / lengths[:, None]
        rows = np.column_stack((self.stations[:-1], self.points[:-1], lengths, directions))
        return [_Leg(*row) for row in rows.tolist()]

    @cached_property
    def _begins(self) -> list[float]:
        """Where the legs begin, and where the path ends, m along it."""
        return [float(station) for station in self.stations]

    @property
    def length(self) -> float:
        """Length of the whole path, m."""
        return self._begins[-1]

    @cached_property
    def corner_angles(self) -> NDArray[np.float64]:
        """Turn of the path at each point, rad in (-pi, pi], left positive, 0 at both ends; [n]."""
        headings = np.arctan2(self._legs[:, 1], self._legs[:, 0])
        angles = np.zeros(len(self.points))
        angles[1:-1] = wrap_angles(np.diff(headings))
        return angles

    def point_at(self, s: float) -> tuple[float, float]:
        """Return the (x, y), m, at arc length ``s``; outside of the path that of the nearer end."""
        if not 0.0 < s < self.length:
            x, y = self.points[0 if s <= 0.0 else -1].tolist()
            return x, y
        leg = self._straights[bisect_right(self._begins, s) - 1]
        along = s - leg.start
        return leg.x + along * leg.ahead_x, leg.y + along * leg.ahead_y

    def project(self, x: float, y: float, from_s: float = 0.0, window: float = 1.0) -> float:
        """Return the arc length, m, of the path's point that is nearest to (x, y).

        Only the part from ``from_s`` to ``from_s + window`` is searched, so that a robot does not
        jump ahead where the path comes by again. Of equally near points the first one counts.
        """
        if len(self.points) == 1:
            return 0.0
        first = min(max(from_s, 0.0), self.length)
        last = first + window
        begins, ends_at = self._begins, len(self.points) - 1
        nearest, found = math.inf, first
        for leg in self._straights[
            bisect_left(begins, first, 1) - 1 : bisect_right(begins, last, 0, ends_at)
        ]:
            off_x, off_y = x - leg.x, y - leg.y
            along = off_x * leg.ahead_x + off_y * leg.ahead_y
            along = max(along, min(max(first - leg.start, 0.0), leg.length))
            along = min(along, min(max(last - leg.start, 0.0), leg.length))
            away = math.hypot(off_x - along * leg.ahead_x, off_y - along * leg.ahead_y)
            if away < nearest:
                nearest, found = away, leg.start + along
        return found
