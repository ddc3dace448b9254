"""The robot's time, also when its clock is set."""

from __future__ import annotations

from roomba.clock import LONGEST_TICK


class RobotTime:
    """Adds up the time between ticks; a clock that is set back or forward changes little."""

    def __init__(self, now: float) -> None:
        """Begin at ``now``, s of the robot's clock."""
        self._last = now
        self.elapsed = 0.0
        """s since the beginning."""

    def tick(self, now: float) -> float:
        """Return the time since the last tick, s, from 0 to the longest that a tick may take."""
        step = min(max(now - self._last, 0.0), LONGEST_TICK)
        self._last = now
        self.elapsed += step
        return step
