"""The outcome of planning coverage: one way over the floor."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from roomba.planning.path.polyline import Path


@dataclass(frozen=True, eq=False)
class CoveragePlan:
    """A way that sweeps the floor: ``points``, float64 [n >= 1, 2], m, in the map frame.

    ``swaths`` and ``edges`` are the lines, float64 [k, 2], m, that it was put together from.
    """

    points: NDArray[np.float64]
    swaths: tuple[NDArray[np.float64], ...] = ()
    edges: tuple[NDArray[np.float64], ...] = ()

    @cached_property
    def path(self) -> Path:
        """The way as a path that can be followed."""
        return Path(self.points)

    @property
    def length(self) -> float:
        """Length of the whole way, m."""
        return self.path.length

    @property
    def turning(self) -> float:
        """Sum of how much the heading changes along the way, rad."""
        return float(np.abs(self.path.corner_angles).sum())
