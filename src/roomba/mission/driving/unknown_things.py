"""Things that the map does not show and bumper or cliff sensors found, remembered for a while."""

from __future__ import annotations

import math
from collections.abc import Callable

from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import WalkConfig
from roomba.geometry import Pose

Obstacle = tuple[float, float, float]
"""x, y and radius of a round thing, m, map frame."""


class UnknownThings:
    """Round obstacles felt by the bumper; each is forgotten after ``memory`` s, for things move."""

    def __init__(self, walk: WalkConfig, body: BodyConfig, memory: float) -> None:
        """Take the size given to a thing, and the body that feels it."""
        self._radius = walk.bump_radius
        self._reach = body.radius + walk.bump_radius
        self._left, self._both = body.bumper_side, body.bumper_middle
        self._right = tuple(-angle for angle in body.bumper_side)
        self._memory = memory
        self._felt: list[tuple[float, Obstacle]] = []

    def felt(self, now: float, pose: Pose, left: bool, right: bool) -> None:
        """Remember what is in the way of the front's halves while the body stands at ``pose``."""
        angles = self._both if left and right else self._left if left else self._right
        for angle in angles:
            direction = pose.theta + angle
            x = pose.x + self._reach * math.cos(direction)
            y = pose.y + self._reach * math.sin(direction)
            self._felt.append((now, (x, y, self._radius)))

    def at(self, now: float) -> list[Obstacle]:
        """Return what is still remembered; a clock set back forgets nothing."""
        self._felt = [entry for entry in self._felt if now - entry[0] < self._memory]
        return [obstacle for _, obstacle in self._felt]

    def forget_around(self, x: float, y: float) -> None:
        """Forget what was felt within the body's reach of a place where the robot stands."""
        self._felt = [
            entry
            for entry in self._felt
            if math.hypot(entry[1][0] - x, entry[1][1] - y) > self._reach
        ]

    def forget(self) -> None:
        """Forget everything."""
        self._felt = []

    def drop(self, is_known: Callable[[float, float], bool]) -> None:
        """Forget what was felt where the map itself shows something."""
        self._felt = [entry for entry in self._felt if not is_known(entry[1][0], entry[1][1])]
