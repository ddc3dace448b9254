"""A map made by odometry alone, to show what the mapper's corrections are worth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.sensors import GyroConfig
from roomba.geometry import Pose, wrap_angle
from roomba.grid import OccupancyMap
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.drawing.occupancy_counts import OccupancyCounts
from roomba.perception.slam.scan_matching.surface_kernels import (
    POINT,
    room_for_sums,
    surface_points,
)


class BlindMap:
    """Draws scans where dead reckoning says that they were taken, as often as the mapper would.

    Tell it the same as the mapper, in the order of time; without the gyro it goes by wheels alone.
    """

    def __init__(
        self,
        config: MappingConfig,
        localization: LocalizationConfig,
        gyro: GyroConfig,
        start: Pose,
    ) -> None:
        """Begin at ``start``, map frame."""
        self._config, self._start = config, start
        self._reckoning = DeadReckoning(localization, gyro)
        self._counts = OccupancyCounts(config.resolution)
        self._drawn: Pose | None = None
        self._lidar: LidarModel | None = None

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, if there is one."""
        self._reckoning.move(stamp, odometry, turning)

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Take a scan, float32 [beams], m, and draw it if the robot moved on since the last one.

        ``stamp`` is when its first beam was measured, s.
        """
        reckoned = self._reckoning.at(stamp)
        if reckoned is None:
            return
        here = self._start.compose(reckoned)
        if not self._is_another(here):
            return
        self._drawn = here
        if lidar is not self._lidar:
            self._lidar, self._beams = lidar, lidar.arrays()
            self._sums = room_for_sums(lidar.beams)
        beams, points = self._beams, np.empty((lidar.beams, POINT))
        still = lidar.at_once(stamp, ranges, self._reckoning.path)
        count = surface_points(still, beams, 0.0, points, self._sums)
        pose = here.as_array()
        self._counts.draw(points[:count].astype(np.float32), beams.mount[:2], pose)

    @property
    def pose(self) -> Pose:
        """Where it takes the robot to be, map frame."""
        return self._start.compose(self._reckoning.pose)

    def at(self, stamp: float) -> Pose:
        """Return where it takes the robot to have been at a time, s, map frame."""
        reckoned = self._reckoning.at(stamp)
        return self.pose if reckoned is None else self._start.compose(reckoned)

    def occupancy(self) -> OccupancyMap:
        """Return the map as it is now; raises ValueError before the first scan."""
        return self._counts.occupancy(
            self._config.occupied_share, self._config.occupied_beams, self._config.least_floor
        )

    def _is_another(self, here: Pose) -> bool:
        if self._drawn is None:
            return True
        way = self._drawn.distance_to(here.x, here.y)
        turned = abs(wrap_angle(here.theta - self._drawn.theta))
        return way >= self._config.keyframe_way or turned >= self._config.keyframe_turn
