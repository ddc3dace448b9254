"""The wheels of a Neato: each command drives both a distance, and they stand at the end of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

from roomba.geometry import STANDSTILL, Twist

FARTHEST = 10_000
"""mm, of a command."""
FASTEST = 300
"""mm/s, of a wheel."""
_BRAKING: Final = 1.0
"""m/s2, towards the end of a distance (assumed)."""
_ARRIVED: Final = 5e-4
"""m; half of a millimetre, the unit of the robot's distances."""


@dataclass(slots=True)
class WheelDrive:
    """Distances that are left, m, and the speed that they are driven at.

    ``track`` is how far the wheels are apart, m.
    """

    track: float
    is_enabled: bool = True
    left: float = 0.0
    right: float = 0.0
    speed: float = 0.0
    acceleration: float = 0.3
    _now: float = field(default=0.0, init=False)

    @property
    def is_idle(self) -> bool:
        """Whether no way is left."""
        return self.left == self.right == 0.0

    def go(self, left: int, right: int, speed: int, acceleration: int | None) -> None:
        """Drive distances, mm, at ``speed``, mm/s, in place of what was under way.

        Distances of 0 at a speed of 0 are passed over, as by some firmware: it rolls on.
        """
        if (left, right, speed) == (0, 0, 0):
            return
        left, right = (max(-FARTHEST, min(FARTHEST, way)) for way in (left, right))
        self.left, self.right = 1e-3 * left, 1e-3 * right
        self.speed = 1e-3 * max(0, min(FASTEST, speed))
        self.acceleration = 1e-3 * max(1, min(FASTEST, acceleration or speed))

    def halt(self) -> None:
        """Stand at once: the wheels have no power."""
        self.left = self.right = self._now = 0.0

    def next(self, seconds: float) -> Twist:
        """Return how the robot moves for ``seconds``, m/s and rad/s; what is left grows less."""
        farthest = max(abs(self.left), abs(self.right))
        if not self.is_enabled or farthest == 0.0 or self.speed == 0.0:
            self._now = 0.0
            return STANDSTILL
        slowing = math.sqrt(2.0 * _BRAKING * farthest)
        self._now = min(self.speed, self._now + self.acceleration * seconds, slowing)
        share = 1.0 if farthest <= _ARRIVED else min(1.0, self._now * seconds / farthest)
        left, right = share * self.left, share * self.right
        self.left, self.right = self.left - left, self.right - right
        if share == 1.0:
            self.left = self.right = 0.0
        return Twist(0.5 * (left + right) / seconds, (right - left) / self.track / seconds)
