"""Points of a lidar that turns clockwise, gathered into scans: a turn each."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.configuration.sensors import LidarConfig
from roomba.geometry import TWO_PI, Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.readings import ScanReading

_FULL_TURN: Final = 360.0
"""degrees"""
_WIDEST_GAP: Final = 30.0
"""degrees; a turn with a wider gap gives no scan."""
_LONGEST_TURN: Final = 1.0
"""s; lidars take 0.08 to 0.5 s."""
_MOST_JITTER: Final = 0.05
"""s; by so much a point may seem to be older than the one before it."""
_SAME_TURN: Final = 0.01
"""Share by which the time of a turn may differ for the same model of the lidar."""


class TurnCollector:
    """Takes points one by one; a scan ends each time that the lidar looks ahead again.

    Angles are those of the lidar: degrees, 0 where it looks ahead, clockwise as seen from above.
    """

    def __init__(self, config: LidarConfig, facing: float = 0.0) -> None:
        """Gather what the lidar of ``config`` sees, turned by ``facing``, rad, in the robot."""
        self._config = config
        self._mount = Pose(config.mount_ahead, 0.0, facing)
        self._angles = -np.arange(config.beams) * (TWO_PI / config.beams)
        self._ranges = np.full(config.beams, np.inf, np.float32)
        self._last: tuple[float, float] | None = None
        self._began: float | None = None
        self._model: LidarModel | None = None
        self._sweep = 0.0

    def add(self, angle: float, distance: float, when: float) -> ScanReading | None:
        """Take a point, ``distance`` m, inf without an echo, measured at ``when``, s.

        Return the scan that it ends, if there is one.
        """
        scan = None
        if self._last is not None:
            before, at = self._last
            step = (angle - before) % _FULL_TURN
            if step > _WIDEST_GAP or not at - _MOST_JITTER <= when <= at + _LONGEST_TURN:
                self._began = None
            elif angle < before:
                # The lidar looked ahead between the two points.
                when = max(when, at)
                crossed = at + (when - at) * ((_FULL_TURN - before) / step if step > 0.0 else 0.0)
                scan = self._ended(crossed)
                self._began = crossed
                self._ranges = np.full(self._config.beams, np.inf, np.float32)
        self._last = angle, when
        beam = round(angle / _FULL_TURN * self._config.beams) % self._config.beams
        if self._config.min_range <= distance < self._config.max_range:
            self._ranges[beam] = min(self._ranges[beam], distance)
        return scan

    def _ended(self, now: float) -> ScanReading | None:
        if self._began is None or not 0.0 < now - self._began <= _LONGEST_TURN:
            return None
        return ScanReading(self._began, self._ranges, self._lidar(now - self._began))

    def _lidar(self, sweep: float) -> LidarModel:
        if self._model is None or not math.isclose(sweep, self._sweep, rel_tol=_SAME_TURN):
            self._sweep = sweep
            self._model = LidarModel(
                self._angles,
                self._config.min_range,
                self._config.max_range,
                self._mount,
                sweep / self._config.beams,
            )
        return self._model
