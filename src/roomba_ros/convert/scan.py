"""Scans as values: the ranges of one, and the lidar that it is of."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from sensor_msgs.msg import LaserScan

from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.readings import ScanReading
from roomba_ros.convert.errors import MessageError, require_finite
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
        that has no beams, or angles that are none.
        """
        ranges = np.array(message.ranges, np.float32)
        return ScanReading(message.header.stamp.to_sec(), ranges, self._lidar_of(message))

    def _lidar_of(self, message: LaserScan) -> LidarModel:
        _require_fan(message)
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


def _require_fan(message: LaserScan) -> None:
    """Raise MessageError unless the beams go to as many different directions as there are beams."""
    beams, first, step = len(message.ranges), message.angle_min, message.angle_increment
    require_finite("a scan's angles", first, step)
    if not beams or (step == 0.0 and beams > 1):
        raise MessageError(
            f"expected a scan with beams, each at another angle, got {beams} from {first:g} on by "
            f"{step:g} rad"
        )
    # How many beams there are does not follow from angle_max: drivers round it, or leave it out.
    if len(message.intensities) not in (0, beams):
        raise MessageError(
            f"expected {beams} intensities, as there are ranges, got {len(message.intensities)}"
        )
    if math.isnan(message.range_max) or not 0.0 <= message.range_min < message.range_max:
        raise MessageError(
            f"expected ranges from 0 m or more on up to a larger one, got "
            f"{message.range_min:g} to {message.range_max:g} m"
        )
