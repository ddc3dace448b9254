"""A period of wall time, after which something may be repeated, however fast the ROS clock."""

from __future__ import annotations

import math
import time
from collections.abc import Callable


class WallPeriod:
    """Says whether so many s of wall time are over since it began; it is over at first."""

    def __init__(self, seconds: float, monotonic: Callable[[], float] | None = None) -> None:
        """``monotonic`` is the wall's clock, s; by default that of the machine."""
        self._seconds, self._monotonic = seconds, monotonic or time.monotonic
        self._began = -math.inf

    def is_over(self) -> bool:
        """Whether the period is over."""
        return self._monotonic() - self._began >= self._seconds

    def begin(self) -> None:
        """Begin the next one now."""
        self._began = self._monotonic()
