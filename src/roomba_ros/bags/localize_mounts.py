"""Where sensors are mounted on a robot, by the transforms that it recorded."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from geometry_msgs.msg import TransformStamped
from numpy.typing import NDArray
from sensor_msgs.msg import LaserScan

from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba_ros.convert.localization import lidar_of

_DEEPEST: Final = 50
"""Frames between a sensor and the root of its tree; more are a circle."""


@dataclass(frozen=True, slots=True)
class Mount:
    """Where a sensor is on the robot, as seen from above, and whether it hangs upside down."""

    pose: Pose = field(default_factory=Pose)
    is_upside_down: bool = False

    def lidar(self, scan: LaserScan) -> LidarModel:
        """Return the lidar that a scan is of, mounted so; raises ValueError for a broken scan."""
        if self.is_upside_down:
            scan = LaserScan(
                angle_min=-scan.angle_min,
                angle_increment=-scan.angle_increment,
                range_min=scan.range_min,
                range_max=scan.range_max,
                ranges=scan.ranges,
            )
        return lidar_of(scan, self.pose)


class Mounts:
    """A tree of frames that do not move against each other."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self._parents: dict[str, tuple[str, NDArray[np.float64]]] = {}

    def add(self, transforms: Iterable[TransformStamped]) -> None:
        """Learn where frames are in others."""
        for transform in transforms:
            place = _matrix_of(transform)
            if place is not None:
                parent = _name(transform.header.frame_id)
                self._parents[_name(transform.child_frame_id)] = (parent, place)

    def knows(self, frame: str) -> bool:
        """Whether it is known where a frame is."""
        return _name(frame) in self._parents

    def mount(self, base: str, frame: str) -> Mount | None:
        """Return where ``frame`` is on the robot, whose frame is ``base``; None if not known."""
        root, place = self._from_root(_name(frame))
        base_root, base_place = self._from_root(_name(base))
        if root != base_root:
            return None
        matrix = np.linalg.inv(base_place) @ place
        heading = math.atan2(matrix[1, 0], matrix[0, 0])
        return Mount(Pose(float(matrix[0, 3]), float(matrix[1, 3]), heading), matrix[2, 2] < 0.0)

    def _from_root(self, frame: str) -> tuple[str, NDArray[np.float64]]:
        """Return the root of a frame's tree, and where the frame is in it, float64 [4, 4]."""
        place = np.eye(4)
        for _ in range(_DEEPEST):
            if frame not in self._parents:
                break
            frame, step = self._parents[frame]
            place = step @ place
        return frame, place


def _name(frame: str) -> str:
    return frame.lstrip("/")


def _matrix_of(message: TransformStamped) -> NDArray[np.float64] | None:
    """Return a transform, float64 [4, 4]; None for one that is none."""
    shift, turn = message.transform.translation, message.transform.rotation
    numbers = np.array([turn.x, turn.y, turn.z, turn.w, shift.x, shift.y, shift.z])
    length = float(np.linalg.norm(numbers[:4]))
    if not np.isfinite(numbers).all() or length < 1e-6:
        return None
    x, y, z, w = (numbers[:4] / length).tolist()
    matrix = np.eye(4)
    matrix[:3, :3] = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    matrix[:3, 3] = numbers[4:]
    return matrix
