"""Mapping of a recorded drive: the mapper hears what was recorded as if it were there."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import LaserScan

from roomba.config import RobotConfig
from roomba.geometry import Pose
from roomba.mapping_run.blind_map import BlindMap
from roomba.perception.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.mapping_config import MappingConfig
from roomba_ros.convert import pose_of_odometry
from roomba_ros.convert_localization import SAME_TIME, ranges_of
from roomba_ros.localize_mounts import Mount, Mounts
from roomba_ros.localize_recording import Heard, Kind
from roomba_ros.localize_report import Thinned

_LATEST: Final = 1.0
"""s; a scan that odometry is so far behind is of a time that it knows nothing of."""


class MapReplay:
    """Feeds a mapper, and a map by odometry alone; ``notes`` says what was left out, and why.

    ``rows`` are t (s), the mapper's pose, and that by odometry alone, x, y (m), theta (rad) each.
    """

    def __init__(
        self, config: RobotConfig, mapping: MappingConfig, mounts: Mounts, base: str, start: Pose
    ) -> None:
        """Begin at ``start``, map frame; ``base`` is the body's frame, to which mounts lead."""
        self.mapper = Mapper(mapping, config.localization, config.gyro, start)
        self.blind = BlindMap(mapping, config.localization, config.gyro, start)
        self.scans = 0
        """Scans that were taken in."""
        self.rows = Thinned()
        self.way = self.elapsed = 0.0
        self._mounts, self._base = mounts, base
        self._stamp = -math.inf
        self._gyro: tuple[float, float] | None = None
        self._scan: tuple[float, LaserScan] | None = None
        self._lidar: tuple[tuple[object, ...], LidarModel] | None = None
        self._frames: dict[str, Mount] = {}
        self._at: Pose | None = None
        self._left_out: dict[str, int] = {}
        self._remarks: list[str] = []

    @property
    def notes(self) -> list[str]:
        """What is worth knowing of what was heard."""
        left_out = [f"{count} {why}: left out" for why, count in self._left_out.items()]
        return [*self._remarks, *left_out]

    @property
    def poses(self) -> NDArray[np.float64]:
        """The rows, float64 [n, 7]."""
        return np.array(self.rows.rows).reshape(-1, 7)

    def hear(self, heard: Heard) -> None:
        """Take in a message."""
        if heard.kind is Kind.ODOMETRY:
            self._hear_odometry(heard.stamp, heard.message)
        elif heard.kind is Kind.GYRO:
            self._hear_gyro(heard.stamp, heard.message)
        elif heard.kind is Kind.SCAN:
            self._hear_scan(heard.stamp, heard.message)

    def end(self) -> None:
        """Take in what waits for more odometry: there is none."""
        self._see()

    def _hear_odometry(self, stamp: float, message: Any) -> None:
        pose = pose_of_odometry(message)
        if not pose.is_finite:
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

    def _turning_at(self, stamp: float) -> float | None:
        """Return the gyro's newest sample, rad/s, if it is of about that time."""
        if self._gyro is None or abs(self._gyro[0] - stamp) > SAME_TIME:
            return None
        return self._gyro[1]

    def _hear_gyro(self, stamp: float, message: Any) -> None:
        turning = message.angular_velocity.z
        if math.isfinite(turning):
            is_upside_down = self._mount(message.header.frame_id, "gyro").is_upside_down
            self._gyro = (stamp, -turning if is_upside_down else turning)

    def _hear_scan(self, stamp: float, message: LaserScan) -> None:
        """Keep a scan until odometry has reached its time, or the next scan comes."""
        if not math.isfinite(self._stamp):
            return
        self._see()
        self._scan = (stamp, message)
        if stamp <= self._stamp:
            self._see()

    def _see(self) -> None:
        if self._scan is None:
            return
        (stamp, scan), self._scan = self._scan, None
        if stamp > self._stamp + _LATEST:
            self._leave_out("scans of times without odometry")
            return
        try:
            ranges, lidar = ranges_of(scan), self._lidar_of(scan)
        except ValueError as error:
            self._leave_out(f"scans ({error})")
            return
        self.mapper.see(stamp, ranges, lidar)
        self.blind.see(stamp, ranges, lidar)
        self.scans += 1
        mapped, reckoned = self.mapper.pose, self.blind.pose
        self.rows.append(
            (stamp, mapped.x, mapped.y, mapped.theta, reckoned.x, reckoned.y, reckoned.theta)
        )

    def _lidar_of(self, scan: LaserScan) -> LidarModel:
        """Return the lidar of a scan, made anew only when something of it changed."""
        key = (
            scan.header.frame_id,
            len(scan.ranges),
            scan.angle_min,
            scan.angle_increment,
            scan.range_min,
            scan.range_max,
        )
        if self._lidar is None or self._lidar[0] != key:
            self._lidar = (key, self._mount(scan.header.frame_id, "lidar").lidar(scan))
        return self._lidar[1]

    def _mount(self, frame: str, sensor: str) -> Mount:
        """Return where a sensor is mounted: in the middle, and looking ahead, if nothing tells."""
        if frame not in self._frames:
            mount = self._mounts.mount(self._base, frame)
            if mount is None and sensor == "lidar":
                self._remarks.append(
                    f"no transform from {self._base!r} to {frame!r} was recorded: "
                    "the lidar is taken to be in the middle of the robot, and to look ahead"
                )
            self._frames[frame] = mount or Mount()
        return self._frames[frame]

    def _leave_out(self, why: str) -> None:
        self._left_out[why] = self._left_out.get(why, 0) + 1
