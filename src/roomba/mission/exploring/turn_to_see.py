"""Turning once on the spot, to see more of a map in the making that shows no way yet."""

from __future__ import annotations

import math
from typing import Final

from roomba.angles import wrapped
from roomba.configuration.mission import ExploringConfig
from roomba.geometry import Pose, Twist
from roomba.mission.inputs.senses import Senses

_ROUND: Final = math.tau
"""rad of a turn; a lidar that sits off the middle may look past what hides things from it now."""


class TurnToSee:
    """One turn for each place; ``is_under_way`` while it turns."""

    def __init__(self, config: ExploringConfig) -> None:
        """Begin with nowhere turned."""
        self._config = config
        self._places: list[Pose] = []
        self._turned, self._heading, self._began = 0.0, 0.0, 0.0
        self.is_under_way = False

    def begin(self, senses: Senses) -> bool:
        """Begin to turn, unless that was done here before; return whether a turn began."""
        here = senses.pose
        near = self._config.same_frontier
        if any(here.distance_to(place.x, place.y) < near for place in self._places):
            return False
        self._places.append(here)
        self._turned, self._heading, self._began = 0.0, here.theta, senses.now
        self.is_under_way = True
        return True

    def tick(self, senses: Senses) -> Twist:
        """Return what is wanted now; it ends with a whole turn, or when it took too long."""
        speed, heading = self._config.seeing_speed, senses.pose.theta
        self._turned += abs(float(wrapped(heading - self._heading)))
        self._heading = heading
        longest = 3.0 * _ROUND / speed
        if self._turned >= _ROUND or not 0.0 <= senses.now - self._began < longest:
            self.is_under_way = False
            return Twist()
        return Twist(0.0, speed)
