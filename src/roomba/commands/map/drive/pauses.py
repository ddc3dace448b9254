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
        self._silence = self._since = 0.0
        self._steps: list[float] = []

    def see(self, stamp: float) -> None:
        """Take the time of a scan, s."""
        self._note_silence(stamp)

    def hear(self, stamp: float) -> float | None:
        """Take the time of a message of odometry, s.

        Returns when a pause began that ended since the message of odometry before, or None.
        """
        self._note_silence(stamp)
        silence, self._silence = self._silence, 0.0
        step, self._told = stamp - self._told, stamp
        if not math.isfinite(step):
            return None
        self._steps.append(step)
        # The median takes a while to compute, and is seldom needed.
        if silence < _LEAST or silence < _LONGER * float(np.median(self._steps)):
            return None
        return self._since

    def _note_silence(self, stamp: float) -> None:
        """Remember the longest silence since the newest message of odometry, and its begin."""
        silence = stamp - self._newest
        if self._silence < silence < math.inf:
            self._silence, self._since = silence, self._newest
        self._newest = max(self._newest, stamp)
