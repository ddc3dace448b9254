"""Jumps of a clock, set when a simulation begins anew or a bag is played again; ages and waits."""

from __future__ import annotations

import math
from typing import Final

LONGEST_TICK: Final = 2.0
"""s; if more passes between two ticks of the robot, its clock was set."""
ROUNDING: Final = 1e-6
"""s; rounding error of a difference between two times since 1970 in floating point."""


class ClockJumps:
    """Tells by how much a clock was set, by the times that it shows one after the other.

    A clock that goes back by more than ``tolerance`` s, or on by more than ``longest`` s between
    two looks, was set. Times are in s of that clock.
    """

    def __init__(
        self, *, last: float | None = None, longest: float = math.inf, tolerance: float = 0.0
    ) -> None:
        """``last`` is the time that it showed last; None: the first look tells no jump."""
        self.last = last
        """What the clock showed at the last look, s; None before the first."""
        self._longest, self._tolerance = longest, tolerance

    def at(self, now: float) -> float:
        """Return by how much the clock was set since the last look, s; 0 when it just went on."""
        last, self.last = self.last, now
        if last is None:
            return 0.0
        step = now - last
        return 0.0 if -self._tolerance <= step <= self._longest else step


class RobotTime:
    """Adds up the time between ticks; setting the clock adds one longest tick at most."""

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


def is_recent(now: float, heard: float, longest: float) -> bool:
    """Whether a message of time ``heard`` is less than ``longest`` s old; s of one clock.

    A message from the future, which a clock that was set back makes possible, is not recent.
    """
    return 0.0 <= now - heard < longest - ROUNDING
