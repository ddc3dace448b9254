"""Pauses of a recording: neither scans nor odometry came for long."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

_LEAST: Final = 10.0
_LONGER: Final = 10.0
"""s, and times the usual time between two messages of odometry: what lasts longer is a pause, after
which odometry alone hardly tells where the robot went."""


class PauseSeeker:
    """Finds pauses, as messages come in the order of time."""

    def __init__(self) -> None:
        """Begin before the first message."""
        self._newest = self._told = -math.inf
        self._steps: list[float] = []

    def see(self, stamp: float) -> None:
        """Take the time of a scan, s."""
        self._newest = max(self._newest, stamp)

    def hear(self, stamp: float) -> float | None:
        """Take the time of a message of odometry, s; return when the pause began that it ends."""
        step, since = stamp - self._told, max(self._newest, self._told)
        self._told = stamp
        if not math.isfinite(step):
            return None
        self._steps.append(step)
        # What is usual takes a while to reckon, and is seldom asked for.
        if stamp - since < _LEAST or stamp - since < _LONGER * float(np.median(self._steps)):
            return None
        return since
