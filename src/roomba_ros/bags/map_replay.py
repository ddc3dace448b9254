"""Replay of a recorded drive through the mapper."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import LaserScan

from roomba.commands.map.blind_map import BlindMap
from roomba.commands.map.drive_log import DriveLog
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.perception.slam.mapper import Mapper
from roomba_ros.bags.localize_recording import Heard, MessageKind
from roomba_ros.bags.localize_report import Thinned
from roomba_ros.bags.recorded_drive import LATEST, RecordedDrive
from roomba_ros.convert.common import pose_of_odometry
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.mounts import Mounts


class MapReplay(RecordedDrive):
    """Feeds a mapper, and a map by odometry alone; ``notes`` says what was left out, and why.

    ``rows`` are t (s), the mapper's pose, and that by odometry alone, x, y (m), theta (rad) each.
    """

    def __init__(
        self, config: RobotConfig, mapping: MappingConfig, mounts: Mounts, base: str, start: Pose
    ) -> None:
        """Begin at ``start``, map frame; ``base`` is the body's frame, to which mounts lead."""
        super().__init__(mounts, base)
        self.mapper = Mapper(mapping, config.localization, config.gyro, start)
        self.blind = BlindMap(mapping, config.localization, config.gyro, start)
        self.rows = Thinned()
        self.log = DriveLog()
        self.way = self.elapsed = 0.0
        self._stamp = -math.inf
        self._at: Pose | None = None

    @property
    def poses(self) -> NDArray[np.float64]:
        """The rows, float64 [n, 7]."""
        return np.array(self.rows.rows).reshape(-1, 7)

    def hear(self, heard: Heard) -> None:
        """Take in a message."""
        if heard.kind is MessageKind.ODOMETRY:
            self._hear_odometry(heard.stamp, heard.message)
        elif heard.kind is MessageKind.GYRO:
            self._hear_gyro(heard.stamp, heard.message)
        elif heard.kind is MessageKind.SCAN:
            self._hear_scan(heard.stamp, heard.message)

    def end(self) -> None:
        """Take in what waits for more odometry: there is none."""
        self._see()

    def _hear_odometry(self, stamp: float, message: Any) -> None:
        try:
            pose = pose_of_odometry(message)
        except MessageError:
            self._leave_out("messages of odometry with numbers that are not finite")
            return
        if math.isfinite(self._stamp):
            self.elapsed += max(0.0, stamp - self._stamp)
        self._stamp = stamp
        turning = self._turning_at(stamp)
        self.mapper.move(stamp, pose, turning)
        self.blind.move(stamp, pose, turning)
        here = self.blind.pose
        if self._at is not None:
            self.way += here.distance_to(self._at.x, self._at.y)
        self._at = here
        if self._scan is not None and self._scan[0] <= stamp:
            self._see()

    def _hear_scan(self, stamp: float, message: LaserScan) -> None:
        """Keep a scan until odometry has reached its time, or the next scan comes."""
        if not math.isfinite(self._stamp):
            return
        self._see()
        scan = self._scan_of(message)
        if scan is not None:
            self._scan = (stamp, scan)
        if stamp <= self._stamp:
            self._see()

    def _see(self) -> None:
        if self._scan is None:
            return
        (stamp, scan), self._scan = self._scan, None
        if stamp > self._stamp + LATEST:
            self._leave_out("scans of times without odometry")
            return
        self.mapper.see(stamp, scan.ranges, scan.lidar)
        self.blind.see(stamp, scan.ranges, scan.lidar)
        self.log.add(stamp, self.mapper)
        self.scans += 1
        mapped, reckoned = self.mapper.pose, self.blind.pose
        self.rows.append(
            (stamp, mapped.x, mapped.y, mapped.theta, reckoned.x, reckoned.y, reckoned.theta)
        )
