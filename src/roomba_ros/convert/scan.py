"""Scans as values: the ranges of one, and the lidar that it is of."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import LaserScan

from roomba.perception.matching.plausible import scan_fault
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.readings import ScanReading
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.mounts import Mount, Mounts


class ScanDecoder:
    """Turns messages into scans; the model of the lidar is made anew only when that changed."""

    def __init__(self, mount_of: Callable[[str], Mount]) -> None:
        """``mount_of`` tells where the frame of a scan is on the robot."""
        self._mount_of = mount_of
        self._newest: tuple[tuple[object, ...], LidarModel] | None = None

    @staticmethod
    def on_robot(mounts: Mounts, base: str) -> ScanDecoder:
        """Return a decoder for a robot whose body is the frame ``base``.

        A lidar of which ``mounts`` do not tell is in the middle of the robot, and looks ahead.
        """
        return ScanDecoder(lambda frame: mounts.mount(base, frame) or Mount())

    def decode(self, message: LaserScan) -> ScanReading:
        """Return a scan, of time 0 if that was not told.

        Ranges that are not finite met nothing, or failed (REP 117). Raises MessageError for a scan
        that can be none.
        """
        ranges = np.array(message.ranges, np.float32)
        _require_scan(message, ranges)
        return ScanReading(message.header.stamp.to_sec(), ranges, self._lidar_of(message))

    def _lidar_of(self, message: LaserScan) -> LidarModel:
        mount = self._mount_of(message.header.frame_id)
        key = (
            len(message.ranges),
            message.angle_min,
            message.angle_increment,
            message.range_min,
            message.range_max,
            message.time_increment,
            mount,
        )
        if self._newest is None or self._newest[0] != key:
            self._newest = (key, _lidar(message, mount))
        return self._newest[1]


def _lidar(message: LaserScan, mount: Mount) -> LidarModel:
    angles = message.angle_min + np.arange(len(message.ranges)) * message.angle_increment
    if mount.is_upside_down:
        angles = -angles
    ranges = message.range_min, message.range_max
    return LidarModel(angles, *ranges, mount.pose, message.time_increment)


def _require_scan(message: LaserScan, ranges: NDArray[np.float32]) -> None:
    """Raise MessageError for a scan that can be none."""
    fault = scan_fault(
        ranges,
        message.angle_min,
        message.angle_increment,
        message.range_min,
        message.range_max,
    )
    if fault:
        raise MessageError(fault)
    # How many beams there are does not follow from angle_max: drivers round it, or leave it out.
    beams = len(ranges)
    if len(message.intensities) not in (0, beams):
        raise MessageError(
            f"expected {beams} intensities, as there are ranges, got {len(message.intensities)}"
        )
