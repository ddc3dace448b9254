"""The robot's time, also when its clock is set."""

from __future__ import annotations

from typing import Final

_LONGEST_TICK: Final = 2.0
"""s; more between two ticks than this is a clock that was set."""


class RobotTime:
    """Adds up the time between ticks; a clock that is set back or forward changes little."""

    def __init__(self, now: float) -> None:
        """Begin at ``now``, s of the robot's clock."""
        self._last = now
        self.elapsed = 0.0
        """s since the beginning."""

    def tick(self, now: float) -> float:
        """Return the time since the last tick, s, from 0 to the longest that a tick may take."""
        step = min(max(now - self._last, 0.0), _LONGEST_TICK)
        self._last = now
        self.elapsed += step
        return step
