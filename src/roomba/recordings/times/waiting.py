"""A scan that waits until it is known where the robot was at its last beam."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.perception.matching.scan_view import LidarModel


class StampedScan(NamedTuple):
    """A scan of ``lidar``: its first beam was at ``stamp``, s; ``ranges`` is float32 [beams], m."""

    stamp: float
    ranges: NDArray[np.float32]
    lidar: LidarModel


class WaitingScan:
    """Keeps the newest scan of a drive until odometry has reached its last beam."""

    def __init__(self) -> None:
        """Begin with none."""
        self._scan: StampedScan | None = None
        self._ready_at = math.inf

    def put(self, scan: StampedScan) -> StampedScan | None:
        """Let a scan wait; return the one that waited till now: it gets no more odometry."""
        before, self._scan = self._scan, scan
        self._ready_at = scan.stamp + scan.lidar.sweep
        return before

    def ready(self, stamp: float) -> StampedScan | None:
        """Return the scan, once, if odometry of ``stamp``, s, has reached its last beam."""
        return self.last() if self._ready_at <= stamp else None

    def last(self) -> StampedScan | None:
        """Return the scan that waits, if there is one, however much of it odometry has reached."""
        scan, self._scan, self._ready_at = self._scan, None, math.inf
        return scan
