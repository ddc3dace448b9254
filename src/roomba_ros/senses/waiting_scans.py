"""Scans that wait until odometry covers the times of all their beams."""

from __future__ import annotations

import threading
from typing import Final

from roomba.clock import ClockJumps
from roomba.robot.readings import ScanReading

_KEPT: Final = 5
"""Scans; on a busy machine odometry comes later than several of them."""


class WaitingScans:
    """Passes the newest scans from the thread that puts them in to the one that takes them out."""

    def __init__(self) -> None:
        """Begin with none."""
        self._lock = threading.Lock()
        self._jumps = ClockJumps()
        self._scans: list[ScanReading] = []

    def put(self, scan: ScanReading) -> None:
        """Let a scan wait."""
        with self._lock:
            if self._jumps.at(scan.stamp):
                self._scans.clear()
            self._scans = [*self._scans[1 - _KEPT :], scan]

    def take(self, stamp: float) -> ScanReading | None:
        """Return the newest scan whose beams were all measured by ``stamp``, s; None without one.

        Older scans are dropped.
        """
        with self._lock:
            ready = sum(scan.stamp + scan.lidar.sweep <= stamp for scan in self._scans)
            scan = self._scans[ready - 1] if ready else None
            del self._scans[:ready]
        return scan

    @property
    def oldest(self) -> float | None:
        """When the oldest that waits was taken, s."""
        with self._lock:
            return self._scans[0].stamp if self._scans else None
