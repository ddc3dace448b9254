"""What is seen on a path before the robot: how far the path is clear."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.mission.driving.obstacles import Obstacles, Way
from roomba.mission.driving.way_ahead_kernels import AHEAD, is_blocked

LEAVING: Final = 0.25
"""m; on so much of a new path the robot may still be near to what the path goes around."""
_NEVER: Final = -1


class WayAhead:
    """Looks along a path, and again when other things stand there or the robot has come farther.

    What it knows is in ``rows``, AHEAD [1], with which compiled kernels go on.
    """

    def __init__(
        self, way: Way, obstacles: Obstacles, look_ahead: float, leaves_until: float = 0.0
    ) -> None:
        """Begin before the first look.

        The path is clear until ``look_ahead`` m before the first thing; before ``leaves_until``, m
        along the path, no thing counts.
        """
        self._way, self._obstacles = way, obstacles
        self.rows = np.zeros(1, AHEAD)
        row = self.rows[0]
        row["checked"], row["clear_to"], row["blocked_at"] = _NEVER, 0.0, math.nan
        row["look_ahead"], row["leaves_until"] = look_ahead, leaves_until
        row["keep"] = obstacles.keep

    @property
    def clear_to(self) -> float:
        """Up to where on the path, m, nothing that is known is in the way."""
        return float(self.rows[0]["clear_to"])

    @property
    def blocked_at(self) -> float | None:
        """Where the first thing stands in the way, m along the path, as of the last look."""
        at = float(self.rows[0]["blocked_at"])
        return None if math.isnan(at) else at

    def is_blocked(self, along: float) -> bool:
        """Whether the path is not clear any more for a robot that is ``along``, m."""
        way, obstacles = self._way, self._obstacles
        things, version = obstacles.seen.arrays, obstacles.version
        return bool(is_blocked(self.rows, things, way.points, way.stations, version, along))
