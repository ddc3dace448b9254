"""The mounts of sensors on a robot, from static transforms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from geometry_msgs.msg import TransformStamped
from numpy.typing import NDArray
from tf2_msgs.msg import TFMessage

from roomba.geometry import Pose
from roomba_ros.convert.errors import MessageError, require_finite

_DEEPEST: Final = 50
"""The most frames between a sensor and the root of its tree; more mean a cycle."""
_SHORTEST_ROTATION: Final = 1e-6
"""Length of a quaternion; a shorter one is no rotation."""


class FrameTransform(NamedTuple):
    """Where the frame ``child`` is in ``parent``: ``matrix`` is float64 [4, 4], m."""

    parent: str
    child: str
    matrix: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Mount:
    """Where a sensor is on the robot, as seen from above, and whether it hangs upside down."""

    pose: Pose = field(default_factory=Pose)
    is_upside_down: bool = False


class Mounts:
    """A tree of frames that do not move against each other."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self._parents: dict[str, tuple[str, NDArray[np.float64]]] = {}

    def add(self, transforms: Iterable[FrameTransform]) -> None:
        """Learn where frames are in others."""
        for transform in transforms:
            self._parents[transform.child] = (transform.parent, transform.matrix)

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
        upside_down = bool(matrix[2, 2] < 0.0)
        return Mount(Pose(float(matrix[0, 3]), float(matrix[1, 3]), heading), upside_down)

    def _from_root(self, frame: str) -> tuple[str, NDArray[np.float64]]:
        """Return the root of a frame's tree, and where the frame is in it, float64 [4, 4]."""
        place = np.eye(4)
        for _ in range(_DEEPEST):
            if frame not in self._parents:
                break
            frame, step = self._parents[frame]
            place = step @ place
        return frame, place


def transforms_of(message: TFMessage) -> list[FrameTransform]:
    """Return the transforms of a message; raises MessageError if there is none, or a broken one."""
    if not message.transforms:
        raise MessageError("expected transforms, got none")
    return [transform_of(transform) for transform in message.transforms]


def usable_transforms(messages: Iterable[TransformStamped]) -> Iterator[FrameTransform]:
    """Yield the transforms that are not broken."""
    for message in messages:
        try:
            yield transform_of(message)
        except MessageError:
            continue


def transform_of(message: TransformStamped) -> FrameTransform:
    """Return a transform.

    Raises MessageError for numbers that are not finite, or a rotation of zeros.
    """
    shift, turn = message.transform.translation, message.transform.rotation
    numbers = np.array([turn.x, turn.y, turn.z, turn.w, shift.x, shift.y, shift.z])
    child = _name(message.child_frame_id)
    require_finite(f"a transform of {child!r}", *numbers.tolist())
    length = float(np.linalg.norm(numbers[:4]))
    if length < _SHORTEST_ROTATION:
        raise MessageError(f"expected a rotation of {child!r}, got a quaternion of zeros")
    x, y, z, w = (numbers[:4] / length).tolist()
    matrix = np.eye(4)
    matrix[:3, :3] = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    matrix[:3, 3] = numbers[4:]
    return FrameTransform(_name(message.header.frame_id), child, matrix)


def _name(frame: str) -> str:
    return frame.lstrip("/")
