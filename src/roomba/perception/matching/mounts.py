"""Where sensors are on a robot, from transforms between frames fixed to it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose

_DEEPEST: Final = 50
"""The most frames between a sensor and the root of its tree; more mean a cycle."""
UPRIGHT: Final = (0.0, 0.0, 1.0)
UPSIDE_DOWN: Final = (0.0, 0.0, -1.0)
"""The robot's vertical along the axes of a sensor that stands, and of one that hangs."""
_DIGITS: Final = 6
"""Digits to which the vertical is rounded: rotations are no more exact than that."""
_SHORTEST_ROTATION: Final = 1e-6
"""Length of a quaternion; a shorter one is no rotation."""


class FrameTransform(NamedTuple):
    """Where the frame ``child`` is in ``parent``: ``matrix`` is float64 [4, 4], m."""

    parent: str
    child: str
    matrix: NDArray[np.float64]

    @staticmethod
    def of(
        parent: str, child: str, shift: Sequence[float], turn: Sequence[float]
    ) -> FrameTransform:
        """Return the transform of a translation x, y, z, m, and a quaternion x, y, z, w.

        Raises ValueError for numbers that are not finite, or a rotation of zeros.
        """
        parent, child = frame_name(parent), frame_name(child)
        if not all(map(math.isfinite, (*shift, *turn))):
            told = ", ".join(f"{number:g}" for number in (*turn, *shift))
            raise ValueError(f"expected a transform of {child!r} of finite numbers, got ({told})")
        length = math.sqrt(sum(number * number for number in turn))
        if length < _SHORTEST_ROTATION:
            raise ValueError(f"expected a rotation of {child!r}, got a quaternion of zeros")
        x, y, z, w = (number / length for number in turn)
        matrix = np.eye(4)
        matrix[:3, :3] = (
            (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
            (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
            (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
        )
        matrix[:3, 3] = shift
        return FrameTransform(parent, child, matrix)

    @property
    def pose(self) -> Pose:
        """The planar part."""
        heading = math.atan2(self.matrix[1, 0], self.matrix[0, 0])
        return Pose(float(self.matrix[0, 3]), float(self.matrix[1, 3]), heading)


@dataclass(frozen=True, slots=True)
class Mount:
    """Where a sensor is on the robot, as seen from above, and how it stands.

    ``up`` is the robot's vertical along the sensor's axes x, y, z: a unit vector.
    """

    pose: Pose = field(default_factory=Pose)
    up: tuple[float, float, float] = UPRIGHT

    @property
    def is_upside_down(self) -> bool:
        """Whether the sensor hangs rather than stands."""
        return self.up[2] < 0.0

    def about_vertical(self, turning: tuple[float, float, float]) -> float:
        """Return the turning about the robot's vertical, of a ``turning`` about the sensor's axes.

        A level axis does not count, as some sensors report NaN about it.
        """
        return sum(share * speed for share, speed in zip(self.up, turning, strict=True) if share)


class Mounts:
    """A tree of frames that do not move against each other."""

    def __init__(self) -> None:
        """Begin with no frame known."""
        self._parents: dict[str, tuple[str, NDArray[np.float64]]] = {}
        self._changes = 0
        self._found: tuple[tuple[int, str, str], Mount | None] = ((0, "", ""), None)

    def add(self, transforms: Iterable[FrameTransform]) -> None:
        """Add transforms, or replace those of the same child frames."""
        for transform in transforms:
            self._parents[transform.child] = (transform.parent, transform.matrix)
        self._changes += 1

    def mount(self, base: str, frame: str) -> Mount | None:
        """Return where ``frame`` is on the robot, whose frame is ``base``; None if not known.

        The last result is kept, as this is asked for each scan of a lidar.
        """
        asked, found = (self._changes, base, frame), self._found
        if found[0] != asked:
            found = self._found = (asked, self._find(base, frame))
        return found[1]

    def _find(self, base: str, frame: str) -> Mount | None:
        root, place = self._from_root(frame_name(frame))
        base_root, base_place = self._from_root(frame_name(base))
        if root != base_root:
            return None
        matrix = np.linalg.inv(base_place) @ place
        x, y, z = matrix[2, :3].round(_DIGITS).tolist()
        return Mount(FrameTransform(base, frame, matrix).pose, (x, y, z))

    def _from_root(self, frame: str) -> tuple[str, NDArray[np.float64]]:
        """Return the root of a frame's tree, and where the frame is in it, float64 [4, 4]."""
        place = np.eye(4)
        for _ in range(_DEEPEST):
            if frame not in self._parents:
                break
            frame, step = self._parents[frame]
            place = step @ place
        return frame, place


def frame_name(frame: str) -> str:
    """Return a frame's name without the slash that tf once began names with."""
    return frame.lstrip("/")
