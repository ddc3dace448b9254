"""The lidar's mount as configured, corrected by what the robot measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.calibration.state import AHEAD, TURNED
from roomba.perception.matching.scan_view import LidarModel


class CorrectedLidar:
    """Lidars whose mounts are moved by ``correction``, robot's frame.

    :meth:`of` returns the same object for as long as the lidar and ``correction`` are the same.
    """

    def __init__(self) -> None:
        """Begin without a correction."""
        self.correction = Pose()
        self._newest: tuple[LidarModel, Pose, LidarModel] | None = None

    def of(self, told: LidarModel) -> LidarModel:
        """Return a lidar with its mount corrected: the configured one if there is no correction."""
        correction = self.correction
        if correction == Pose():
            return told
        if self._newest is None or self._newest[0] is not told or self._newest[1] != correction:
            self._newest = told, correction, told.moved(correction)
        return self._newest[2]


def lidar_correction(beliefs: NDArray[np.void]) -> Pose:
    """Return the correction of the lidar's mount, robot's frame, that a BELIEF [1] applies."""
    return Pose(*beliefs[0]["calibration"]["applied"][AHEAD : TURNED + 1].tolist())
