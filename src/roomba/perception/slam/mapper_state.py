"""The state of a map that is being made: enough to continue it in another process."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from roomba.arrays import Floats
from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.mirrors.mirror import KeptMirror
from roomba.perception.slam.submaps.pose_graph import Link
from roomba.perception.slam.submaps.submap import KeptSubmap


@dataclass(frozen=True, slots=True)
class LidarNumbers:
    """The lidar that made the map: see :class:`roomba.perception.matching.scan_view.LidarModel`."""

    beams: int
    first_angle: float
    step: float
    nearest: float
    farthest: float
    mount: Pose

    @staticmethod
    def of(lidar: LidarModel) -> LidarNumbers:
        """Return the numbers of a lidar."""
        arrays = lidar.arrays()
        return LidarNumbers(
            lidar.beams,
            arrays.first_angle,
            arrays.step,
            arrays.nearest,
            arrays.farthest,
            Pose(*lidar.mount.tolist()),
        )

    @property
    def model(self) -> LidarModel:
        """The lidar itself."""
        angles = self.first_angle + self.step * np.arange(self.beams)
        return LidarModel(angles, self.nearest, self.farthest, self.mount)


@dataclass(frozen=True, slots=True, eq=False)
class MapperState:
    """A map that is being made, at one moment.

    ``poses``, float64 [n, 3], are those of the ``submaps`` on the map, as the ``links`` place them;
    the newest is the last. ``way`` was driven in all, m. Walls lie ``phase``, m, off whole cells.
    ``version`` is that of the :class:`roomba.perception.slam.mapper.Mapper`. ``is_lost``: the robot
    was carried, and not found again yet. ``mirrors`` are in the frames of submaps.
    """

    submaps: tuple[KeptSubmap, ...]
    poses: Floats
    links: tuple[Link, ...]
    way: float
    phase: tuple[float, float]
    lidar: LidarNumbers
    version: int
    is_lost: bool = False
    mirrors: tuple[KeptMirror, ...] = ()
