"""A path: straight legs from point to point, measured along its length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles


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

    @property
    def length(self) -> float:
        """Length of the whole path, m."""
        return float(self.stations[-1])

    @cached_property
    def corner_angles(self) -> NDArray[np.float64]:
        """Turn of the path at each point, rad in (-pi, pi], left positive, 0 at both ends; [n]."""
        headings = np.arctan2(self._legs[:, 1], self._legs[:, 0])
        angles = np.zeros(len(self.points))
        angles[1:-1] = wrap_angles(np.diff(headings))
        return angles

    def point_at(self, s: float) -> tuple[float, float]:
        """Return the (x, y), m, at arc length ``s``; before the start and past the end: the end."""
        x = np.interp(s, self.stations, self.points[:, 0])
        y = np.interp(s, self.stations, self.points[:, 1])
        return float(x), float(y)

    def remaining(self, s: float) -> float:
        """Return the length from arc length ``s`` to the end, m."""
        return self.length - min(max(s, 0.0), self.length)

    def project(self, x: float, y: float, from_s: float = 0.0, window: float = 1.0) -> float:
        """Return the arc length, m, of the path's point that is nearest to (x, y).

        Only ``from_s`` to ``from_s + window`` is looked at, so that a robot goes on where the path
        comes by again. Of points equally near the first counts.
        """
        if len(self.points) == 1:
            return 0.0
        first = min(max(from_s, 0.0), self.length)
        starts, ends = self.stations[:-1], self.stations[1:]
        looked_at = (ends >= first) & (starts <= first + window)
        starts, lengths = starts[looked_at], (ends - starts)[looked_at]
        directions = self._legs[looked_at] / lengths[:, None]
        offsets = np.array([x, y]) - self.points[:-1][looked_at]
        along = np.clip(
            np.sum(offsets * directions, axis=1),
            np.clip(first - starts, 0.0, lengths),
            np.clip(first + window - starts, 0.0, lengths),
        )
        away = offsets - along[:, None] * directions
        nearest = int(np.argmin(np.hypot(away[:, 0], away[:, 1])))
        return float(starts[nearest] + along[nearest])
