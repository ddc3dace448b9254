"""Scan messages as values: the ranges, and the model of the lidar that measured them."""

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
    """Turns messages into scans; makes a new model of the lidar only when its numbers change."""

    def __init__(self, mount_of: Callable[[str], Mount]) -> None:
        """``mount_of`` tells where the frame of a scan is on the robot."""
        self._mount_of = mount_of
        self._newest: tuple[tuple[object, ...], LidarModel] | None = None

    @staticmethod
    def on_robot(mounts: Mounts, base: str) -> ScanDecoder:
        """Return a decoder for a robot whose body is the frame ``base``.

        A lidar that ``mounts`` do not contain is taken to sit in the robot's middle, looking ahead.
        """
        return ScanDecoder(lambda frame: mounts.mount(base, frame) or Mount())

    def decode(self, message: LaserScan) -> ScanReading:
        """Return a scan; its time is 0 if the message has no stamp.

        A range that is not finite means that the beam met nothing, or failed (REP 117). Raises
        MessageError for an impossible scan.
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
    """Raise MessageError for an impossible scan."""
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
