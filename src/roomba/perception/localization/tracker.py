"""Pose tracking: each scan corrects a known pose by the map's surfaces nearby."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.localization.belief.behind_kernels import BEHIND_LANES
from roomba.perception.localization.belief.belief import AGREE, Rows
from roomba.perception.localization.belief.correct_kernels import judge_ends, match_ends, trust
from roomba.perception.matching.fit_kernels import JUDGE_LANES
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField


class Tracker:
    """A pose in the map and its covariance, float64 [3, 3], of x, y (m2) and theta (rad2)."""

    def __init__(
        self,
        field: SurfaceField,
        pose: Pose,
        covariance: NDArray[np.float64],
        belief: Rows,
        numbers: Rows,
    ) -> None:
        """Begin where the robot is known to be; pose and covariance go to the owner's ``belief``.

        ``numbers`` are the owner's parameters for kernels.
        """
        self._beliefs, self._belief, self._numbers = belief, belief[0], numbers
        self._pose: NDArray[np.float64] = self._belief["pose"]
        self._covariance: NDArray[np.float64] = self._belief["covariance"]
        self._fit: NDArray[np.float64] = self._belief["fit"]
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
        """A copy of the pose's covariance."""
        return self._covariance.copy()

    @covariance.setter
    def covariance(self, covariance: NDArray[np.float64]) -> None:
        self._covariance[:] = covariance

    @property
    def map_spread(self) -> NDArray[np.float64]:
        """A copy of the pose's covariance by the map's errors, float64 [3, 3]."""
        spread: NDArray[np.float64] = self._belief["map_spread"].copy()
        return spread

    @property
    def fit(self) -> Fit | None:
        """How well the last scan fits that was judged; None before the first."""
        return Fit(*self._fit.tolist()) if self._belief["is_judged"] else None

    @property
    def agreement(self) -> float:
        """Share of beams that agree with the map in the last scan that was judged; 0 before it."""
        return float(self._fit[AGREE]) if self._belief["is_judged"] else 0.0

    def see(self, view: ScanView) -> None:
        """Correct the pose by a scan that is taken here."""
        match_ends(
            self._beliefs,
            self._numbers,
            self._field,
            self._place,
            view.ends,
            len(view),
            np.empty((BEHIND_LANES, len(view))),
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
