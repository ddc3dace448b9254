"""How the robot moved, by its wheels' encoders and its gyro, and how sure that is."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.sensors import GyroConfig
from roomba.geometry import Pose
from roomba.perception.calibration.state import begin_calibration, forget_wheels
from roomba.perception.localization.belief.belief import Rows, numbers_of, unknown_belief
from roomba.perception.localization.belief.reckon_kernels import reckon_on
from roomba.perception.matching.reckoned_path import ReckonedPath, pose_at


class DeadReckoning:
    """Keeps a pose in a frame of its own, in which it never jumps but slowly drifts.

    Wheels and gyro both measure each turn; they are weighted by their variances. Kernels may go on
    with its ``belief``, ``numbers`` and ``path``.
    """

    def __init__(
        self, config: LocalizationConfig, gyro: GyroConfig, belief: Rows | None = None
    ) -> None:
        """Begin at the origin; the pose on the map of a ``belief``, if given, moves along."""
        self._gyro = gyro
        self.belief = unknown_belief() if belief is None else belief
        self._belief = self.belief[0]
        begin_calibration(self._belief["calibration"], config, gyro)
        self._measured = self._belief["calibration"].copy()
        self._trusted: NDArray[np.float64] = self._belief["odometry_scale"].copy()
        self._reckoned: NDArray[np.float64] = self._belief["reckoned"]
        self.numbers = numbers_of(config, gyro)
        self.path = ReckonedPath.empty()

    def begin_guessing(self, config: LocalizationConfig) -> None:
        """Go on with guessed odometry, to which what was learned of the wheels does not apply."""
        row = self._belief["calibration"]
        self._measured, self._trusted = row.copy(), self._belief["odometry_scale"].copy()
        forget_wheels(row, config)
        self._belief["odometry_scale"] = 1.0
        self.numbers[:] = numbers_of(config, self._gyro)

    def end_guessing(self, config: LocalizationConfig) -> None:
        """Go on with the wheels, as they were known before."""
        self._belief["calibration"] = self._measured
        self._belief["odometry_scale"] = self._trusted
        self._belief["calibration"]["is_open"] = False
        self.numbers[:] = numbers_of(config, self._gyro)

    def move(self, stamp: float, odometry: Pose, turning: float | None) -> None:
        """Take wheel odometry and the gyro's turning speed, rad/s, if there is one, at a time.

        Odometry a little older than the last is left out, and so is a jump. If the clock was set
        back the way still counts, but the time that it took is not known.
        """
        reckon_on(
            self.belief,
            self.numbers,
            self.path,
            float(stamp),  # for an int the kernel would be compiled once more
            odometry.x,
            odometry.y,
            odometry.theta,
            math.nan if turning is None else turning,
        )

    def at(self, stamp: float) -> Pose | None:
        """Return the pose at a time, between those that were told; None if that is too long ago."""
        pose = np.empty(3)
        return Pose(*pose.tolist()) if pose_at(self.path, stamp, pose) else None

    def is_newest(self, stamp: float) -> bool:
        """Whether nothing newer than this was told, and something was."""
        return -math.inf < float(self._belief["stamp"]) <= stamp

    @property
    def pose(self) -> Pose:
        """The newest pose."""
        return Pose(*self._reckoned.tolist())

    @property
    def odometry(self) -> Pose:
        """The newest odometry, in its own frame."""
        return Pose(*self._belief["odometry"].tolist())
