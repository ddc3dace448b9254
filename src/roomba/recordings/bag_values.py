"""Messages of bags as values.

The messages are those of rosbags, which have the fields of ROS 1 and 2. A message is refused for
the reasons for which a node of this robot would refuse it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, Final

import numpy as np

from roomba.geometry import Pose, heading_of
from roomba.perception.matching.mounts import FrameTransform, frame_name
from roomba.perception.matching.plausible import is_measured, scan_fault
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.log import MountOf
from roomba.recordings.readings import (
    UNUSABLE_ODOMETRY,
    UNUSABLE_SCANS,
    Kind,
    LidarScan,
    Lifted,
    Odometry,
    OwnPose,
    Refused,
    ToldPose,
    TruePose,
    Turning,
    Value,
)

_MAP: Final = "map"
_NOT_FINITE: Final = "its numbers are not finite"
_CLIPPED: Final = 0.1
"""If more than this share of a scan's beams are as long as the longest one, they are cut there."""
_UNEVEN: Final = 0.02
"""Share by which times of a lidar's turns may differ: 1 mrad where a robot turns by 0.5 rad/s."""
_LEAST_DEVIATION: Final = 0.1
"""m, rad; of a told pose whose sender does not say how sure it is."""


class LidarBook:
    """The newest lidar of each frame; its model is made anew only when the lidar changed.

    Some drivers tell with each scan how fast the lidar turned just then: that is no change.
    """

    def __init__(self, mount_of: MountOf) -> None:
        """``mount_of`` tells where the frame of a sensor is on the robot."""
        self.mount_of = mount_of
        self._newest: dict[str, tuple[tuple[object, ...], float, LidarModel]] = {}
        self._cut_at: dict[str, float] = {}

    def lidar_of(self, message: Any) -> LidarModel:
        """Return the lidar of a scan."""
        frame = str(message.header.frame_id)
        first, step, beams = message.angle_min, message.angle_increment, len(message.ranges)
        nearest, _ = _told_ranges(message)
        ranges, increment = (nearest, self._farthest(message)), message.time_increment
        key = (beams, first, step, *ranges)
        known = self._newest.get(frame)
        if known is not None and known[0] == key and _is_same(increment, known[1]):
            return known[2]
        mount = self.mount_of(frame, Kind.SCAN)
        angles = first + step * np.arange(beams)
        angles = -angles if mount.is_upside_down else angles
        lidar = LidarModel(angles, *ranges, mount.pose, increment)
        self._newest[frame] = (key, increment, lidar)
        return lidar

    def _farthest(self, message: Any) -> float:
        """Return from which range on a beam met nothing, m.

        Some drivers cut ranges at one value, and tell another one as the largest.
        """
        frame, (nearest, told) = str(message.header.frame_id), _told_ranges(message)
        ranges = np.asarray(message.ranges, np.float32)
        longest = float(ranges.max(initial=0.0, where=ranges < np.float32(told)))
        if longest > self._cut_at.get(frame, 0.0):
            self._cut_at.pop(frame, None)
            if longest > nearest and np.mean(ranges == np.float32(longest)) > _CLIPPED:
                self._cut_at[frame] = longest
        return min(told, self._cut_at.get(frame, told))


def decoded(kind: Kind, message: Any, lidars: LidarBook) -> Value | Refused:
    """Return the value of a message, or the reason why there is none."""
    return _DECODERS[kind](message, lidars)


def transforms_in(message: Any) -> Iterator[tuple[float, FrameTransform]]:
    """Yield the transforms of a message that are not broken, with their stamps, s; 0: none."""
    for each in () if message is None else message.transforms:
        shift, turn, stamp = each.transform.translation, each.transform.rotation, each.header.stamp
        try:
            transform = FrameTransform.of(
                each.header.frame_id,
                each.child_frame_id,
                (shift.x, shift.y, shift.z),
                (turn.x, turn.y, turn.z, turn.w),
            )
        except ValueError:
            continue
        yield stamp.sec + 1e-9 * stamp.nanosec, transform


def with_first_echoes(message: Any) -> Any:
    """Return a scan that has several echoes of each beam with the first ones as its ranges.

    A beam without an echo met nothing.
    """
    firsts = [beam.echoes[0] if len(beam.echoes) else math.inf for beam in message.ranges]
    return replace(message, ranges=np.array(firsts, np.float32))


def _is_same(increment: float, known: float) -> bool:
    """Whether a time between beams, s, is the known one, but for a motor that turns unevenly."""
    return abs(increment - known) <= _UNEVEN * abs(known)


def _told_ranges(message: Any) -> tuple[float, float]:
    """Return the least and the largest range of a scan that count, m.

    A driver that does not tell them has NaN as the least, or 0 as the largest.
    """
    nearest = float(message.range_min)
    return 0.0 if math.isnan(nearest) else nearest, float(message.range_max) or math.inf


def _scan(message: Any, lidars: LidarBook) -> Value | Refused:
    # A copy: arrays of a file are read-only, and loops would be compiled once more for those.
    ranges = np.array(message.ranges, np.float32)
    first, step = message.angle_min, message.angle_increment
    fault = scan_fault(ranges, first, step, *_told_ranges(message))
    if fault:
        return Refused(UNUSABLE_SCANS, fault)
    return LidarScan(ranges, lidars.lidar_of(message))


def _odometry(message: Any, lidars: LidarBook) -> Value | Refused:
    if isinstance(message, FrameTransform):
        pose = message.pose
    else:
        turn = message.pose.pose.orientation
        if not any((turn.x, turn.y, turn.z, turn.w)):
            return Refused(UNUSABLE_ODOMETRY, "its orientation is (0, 0, 0, 0), which is none")
        pose = _pose(message.pose.pose)
    return Odometry(pose) if pose.is_finite else Refused(UNUSABLE_ODOMETRY, _NOT_FINITE)


def _true_pose(message: Any, lidars: LidarBook) -> Value | Refused:
    pose = _pose(message.pose)
    if not pose.is_finite:
        return Refused("true poses", _NOT_FINITE)
    return TruePose(pose)


def _lifted(message: Any, lidars: LidarBook) -> Value | Refused:
    return Lifted(bool(message.is_left_dropped and message.is_right_dropped))


def _told_pose(message: Any, lidars: LidarBook) -> Value | Refused:
    pose, covariance = _pose(message.pose.pose), message.pose.covariance
    variances = (max(covariance[0], covariance[7]), covariance[35])
    why = _off_map(message, pose, *variances)
    if why:
        return Refused("told poses", why)
    across, turned = (
        math.sqrt(variance) if variance > 0.0 else _LEAST_DEVIATION for variance in variances
    )
    return ToldPose(pose, (across, turned))


def _own_pose(message: Any, lidars: LidarBook) -> Value | Refused:
    if hasattr(message, "pos_x"):
        pose = Pose(float(message.pos_x), float(message.pos_y))
        why = _off_map(None, pose)
    else:
        pose = _pose(message.pose if hasattr(message.pose, "position") else message.pose.pose)
        why = _off_map(message, pose)
    return Refused("poses of the robot itself", why) if why else OwnPose(pose)


def _off_map(message: Any, pose: Pose, *numbers: float) -> str:
    """Return why a pose is none on the map; "" if it is one. No frame means that of the map."""
    frame = "" if message is None else frame_name(str(message.header.frame_id))
    if frame not in ("", _MAP):
        return f"expected the frame {_MAP!r}, got {frame!r}"
    return "" if pose.is_finite and all(map(math.isfinite, numbers)) else _NOT_FINITE


def _turning(message: Any, lidars: LidarBook) -> Value | Refused:
    if not is_measured(message.angular_velocity_covariance):
        return Refused("messages of the gyro", "they say that no turning is measured")
    turning = message.angular_velocity
    mount = lidars.mount_of(str(message.header.frame_id), Kind.GYRO)
    speed = mount.about_vertical((float(turning.x), float(turning.y), float(turning.z)))
    if not math.isfinite(speed):
        return Refused("messages of the gyro", f"it turns by {speed:g} rad/s")
    return Turning(speed)


def _pose(message: Any) -> Pose:
    """Return the planar part of a pose; its quaternion need not be of unit length."""
    place, turn = message.position, message.orientation
    theta = heading_of(turn.x, turn.y, turn.z, turn.w)
    return Pose(float(place.x), float(place.y), theta)


_DECODERS: Final[dict[Kind, Callable[[Any, LidarBook], Value | Refused]]] = {
    Kind.GYRO: _turning,
    Kind.ODOMETRY: _odometry,
    Kind.TRUTH: _true_pose,
    Kind.LIFTED: _lifted,
    Kind.TOLD: _told_pose,
    Kind.SCAN: _scan,
    Kind.OWN_POSE: _own_pose,
}
