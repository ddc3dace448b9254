"""What replays of a recorded drive have in common: gyro, lidars, and what is noted."""

from __future__ import annotations

import math
from typing import Any, Final

from sensor_msgs.msg import LaserScan

from roomba.perception.matching.scan_view import LidarModel
from roomba_ros.bags.localize_mounts import Mount, Mounts
from roomba_ros.convert.localization import SAME_TIME

LATEST: Final = 1.0
"""s; a scan that odometry is so far behind is of a time that it knows nothing of."""


class RecordedDrive:
    """Keeps what was heard of gyro and mounts; ``notes`` says what was left out, and why."""

    def __init__(self, mounts: Mounts, base: str) -> None:
        """``base`` is the frame of the robot's body, to which ``mounts`` lead."""
        self.scans = 0
        """Scans that were taken in."""
        self._mounts, self._base = mounts, base
        self._gyro: tuple[float, float] | None = None
        self._scan: tuple[float, LaserScan] | None = None
        self._lidar: tuple[tuple[object, ...], LidarModel] | None = None
        self._frames: dict[str, Mount] = {}
        self._left_out: dict[str, int] = {}
        self._remarks: list[str] = []

    @property
    def notes(self) -> list[str]:
        """What is worth knowing of what was heard."""
        left_out = [f"{count} {why}: left out" for why, count in self._left_out.items()]
        return [*self._remarks, *left_out]

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
