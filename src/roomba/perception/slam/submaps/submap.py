"""Submaps: stretches of a drive so short that the scans in them need no correction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.perception.slam.submaps.pose_graph import composed


@dataclass(frozen=True, slots=True, eq=False)
class Keyframe:
    """A scan that is kept: float32 [n, 4], robot's frame, and its pose [3] in its submap.

    ``open``, float32 [m, 2], robot's frame, are the ends of open ways, along beams without an echo:
    see :mod:`roomba.perception.slam.drawing.open_ways`.
    """

    points: NDArray[np.float32]
    pose: Floats
    open: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 2), np.float32))


@dataclass(frozen=True, slots=True, eq=False)
class KeptSubmap:
    """A saved submap: ``way`` is what was driven before it, m; ``keyframes`` those so far."""

    way: float
    keyframes: tuple[Keyframe, ...]


@dataclass(slots=True, eq=False)
class Submap:
    """Keyframes in the frame of the first one; ``way`` is what was driven before it, m."""

    way: float
    keyframes: list[Keyframe] = field(default_factory=list)
    cloud: Floats = field(default_factory=lambda: np.zeros((0, 4)))
    """float64 [n, 4]; points of all keyframes in the submap's frame, once it is closed."""

    def close(self, most: int) -> None:
        """Close the submap: keep at most ``most`` of its points with normals as its cloud."""
        points = cloud_of(self.keyframes)
        stride = max(1, -(-len(points) // most))
        self.cloud = np.ascontiguousarray(points[::stride])

    def poses(self, pose: Floats) -> Floats:
        """Return where the keyframes were taken, float64 [n, 3], if the submap is at ``pose``."""
        relative = np.array([frame.pose for frame in self.keyframes]).reshape(-1, 3)
        return composed(np.broadcast_to(pose, relative.shape), relative)


def cloud_of(keyframes: Sequence[Keyframe]) -> Floats:
    """Return the points with normals of some keyframes of a submap, [n, 4], its frame."""
    clouds = [moved(frame.points, frame.pose) for frame in keyframes]
    points = np.concatenate(clouds) if clouds else np.zeros((0, 4))
    with_normals: Floats = points[np.any(points[:, 2:] != 0.0, axis=1)]
    return with_normals


def moved(points: NDArray[np.float32] | Floats, pose: Floats) -> Floats:
    """Return points with normals, [n, 4], moved from the frame at ``pose`` [3] into its parent."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    turn = np.array([[cosine, sine], [-sine, cosine]])
    wide = np.asarray(points, np.float64)
    return np.column_stack((wide[:, :2] @ turn + pose[:2], wide[:, 2:] @ turn))
