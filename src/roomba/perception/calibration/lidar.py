"""The lidar as it is mounted, by what the robot measured of that."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.calibration.state import AHEAD, TURNED
from roomba.perception.matching.scan_view import LidarModel


class CorrectedLidar:
    """Returns the same lidar for as long as ``correction`` is the same.

    By that its mount is moved, robot's frame; without one the lidar is what is told of it.
    """

    def __init__(self) -> None:
        """Begin without a correction."""
        self.correction = Pose()
        self._newest: tuple[LidarModel, Pose, LidarModel] | None = None

    def of(self, told: LidarModel) -> LidarModel:
        """Return where a lidar really is."""
        correction = self.correction
        if correction == Pose():
            return told
        if self._newest is None or self._newest[0] is not told or self._newest[1] != correction:
            self._newest = told, correction, told.moved(correction)
        return self._newest[2]


def lidar_correction(beliefs: NDArray[np.void]) -> Pose:
    """Return by what the lidar's mount is moved, robot's frame, of a BELIEF [1]."""
    return Pose(*beliefs[0]["calibration"]["applied"][AHEAD : TURNED + 1].tolist())
