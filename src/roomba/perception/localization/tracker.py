"""Pose tracking: each scan corrects a known pose by the map's surfaces nearby."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.sensors import GyroConfig
from roomba.geometry import Pose
from roomba.perception.localization.belief.belief import AGREE, Rows, numbers_of, unknown_belief
from roomba.perception.localization.belief.correct_kernels import judge_ends, match_ends, trust
from roomba.perception.localization.belief.reckon_kernels import carry
from roomba.perception.matching.fit_kernels import JUDGE_LANES
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField


class Tracker:
    """A pose in the map and its covariance, float64 [3, 3], of x, y (m2) and theta (rad2)."""

    def __init__(
        self,
        field: SurfaceField,
        config: LocalizationConfig,
        pose: Pose,
        covariance: NDArray[np.float64],
        belief: Rows | None = None,
        numbers: Rows | None = None,
    ) -> None:
        """Begin where the robot is known to be; of a ``belief`` it takes the place over.

        ``numbers`` are those that its owner goes by; by default those for each scan of a lidar.
        """
        self._beliefs = unknown_belief() if belief is None else belief
        self._belief = self._beliefs[0]
        self._pose: NDArray[np.float64] = self._belief["pose"]
        self._covariance: NDArray[np.float64] = self._belief["covariance"]
        self._fit: NDArray[np.float64] = self._belief["fit"]
        self._numbers = numbers_of(config, GyroConfig()) if numbers is None else numbers
        self._field, self._place = field.values, field.place
        self.pose, self.covariance = pose, covariance
        self._belief["is_judged"] = self._belief["is_doubtful"] = False
        self._belief["calibration"]["is_open"] = False

    @property
    def pose(self) -> Pose:
        """Where the robot is."""
        return Pose(*self._pose.tolist())

    @pose.setter
    def pose(self, pose: Pose) -> None:
        self._pose[:] = pose.x, pose.y, pose.theta

    @property
    def covariance(self) -> NDArray[np.float64]:
        """How unsure that is: a copy."""
        return self._covariance.copy()

    @covariance.setter
    def covariance(self, covariance: NDArray[np.float64]) -> None:
        self._covariance[:] = covariance

    @property
    def map_spread(self) -> NDArray[np.float64]:
        """Covariance of the pose by the map's errors, float64 [3, 3]: a copy."""
        spread: NDArray[np.float64] = self._belief["map_spread"].copy()
        return spread

    @property
    def fit(self) -> Fit | None:
        """How well the last scan fits, if there was one that tells."""
        return Fit(*self._fit.tolist()) if self._belief["is_judged"] else None

    @property
    def agreement(self) -> float:
        """Share of the last scan's beams that agree with the map; 0 if no scan told yet."""
        return float(self._fit[AGREE]) if self._belief["is_judged"] else 0.0

    def move(self, step: Pose, spread: NDArray[np.float64]) -> None:
        """Go on by a step, given in the robot's frame; ``spread`` as of DeadReckoning."""
        self.pose, self.covariance = moved(self.pose, self.covariance, step, spread)

    def see(self, view: ScanView) -> None:
        """Correct the pose by a scan that is taken here."""
        match_ends(
            self._beliefs,
            self._numbers,
            self._field,
            self._place,
            view.ends,
            len(view),
            np.empty((2, len(view))),
        )

    def judge(self, view: ScanView) -> Fit:
        """Return how well a scan fits the pose, and remember that."""
        judge_ends(
            self._beliefs,
            self._numbers,
            self._field,
            self._place,
            view.ends,
            len(view),
            view.mount,
            np.empty((JUDGE_LANES, len(view))),
        )
        return Fit(*self._fit.tolist())

    @property
    def is_doubtful(self) -> bool:
        """Whether scans fit so much worse than usual that the robot may be somewhere else."""
        return bool(self._belief["is_doubtful"])

    def trust(self, fit: Fit) -> None:
        """Take this fit for the usual one: the place was compared with all others."""
        self._fit[:] = fit.agree, fit.short, fit.through, fit.evidence
        self._belief["is_doubtful"] = False
        trust(self._beliefs)


def moved(
    pose: Pose, covariance: NDArray[np.float64], step: Pose, spread: NDArray[np.float64]
) -> tuple[Pose, NDArray[np.float64]]:
    """Return a pose and its covariance after a step in its own frame, unsure by ``spread``.

    ``spread`` is float64 [3, 3] along the axes of the robot after the step, of which the diagonal
    counts.
    """
    after, unsure = pose.as_array(), covariance.copy()
    carry(after, unsure, step.x, step.y, step.theta, *np.diag(spread).tolist())
    return Pose(*after.tolist()), unsure
