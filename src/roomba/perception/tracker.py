"""Following a pose that is known: each scan corrects it by what the map shows nearby."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.config import LocalizationConfig
from roomba.geometry import Pose
from roomba.perception.match_kernels import match
from roomba.perception.scan_view import Fit, ScanView
from roomba.perception.surface_field import SurfaceField

_NARROW: Final = np.array([0.10, 0.05, 0.05])
_WIDE: Final = np.array([0.40, 0.30, 0.20, 0.10, 0.05, 0.05])
"""m; beams that end farther off than this lose weight, round by round."""
_UNSURE: Final = 0.08
"""m; a pose less sure than this is matched from farther away."""
_STRIDE: Final = 8
"""Each such beam is judged; of 360 these are enough to notice a wrong pose."""
_SMOOTHING: Final = 0.4
"""Share of the newest scan in what the fit is now: about the last three scans count."""
_ADAPTING: Final = 0.02
"""Share of it in the usual fit: about the last 5 s."""
_WORSE: Final = 0.3
"""Share of beams that agree less than usual, at which the pose is doubted."""
_THROUGH: Final = 0.15
"""Share of beams that go through walls more than usual, at which the pose is doubted."""
_LEAST: Final = 0.35
"""Share of beams that must agree, whatever is usual."""
_STILL: Final = np.diag([0.0005**2, 0.0005**2, 0.0003**2])
"""m2, rad2; what a scan leaves unsure however often it is seen: errors of the map."""


class Tracker:
    """A pose in the map and its covariance, float64 [3, 3], of x, y (m2) and theta (rad2)."""

    def __init__(
        self,
        field: SurfaceField,
        config: LocalizationConfig,
        pose: Pose,
        covariance: NDArray[np.float64],
    ) -> None:
        """Begin where the robot is known to be."""
        self.pose = pose
        self.covariance = covariance
        self.fit: Fit | None = None
        self._field, self._config = field, config
        self._agree = self._through = 0.0
        self._usual_agree = self._usual_through = 0.0

    def move(self, step: Pose, spread: NDArray[np.float64]) -> None:
        """Go on by a step, given in the robot's frame; ``spread`` as of DeadReckoning."""
        self.pose, self.covariance = moved(self.pose, self.covariance, step, spread)

    def see(self, view: ScanView) -> None:
        """Correct the pose by a scan that is taken here."""
        prior = np.array([self.pose.x, self.pose.y, self.pose.theta])
        pose, covariance = prior.copy(), self.covariance + _STILL
        is_unsure = max(covariance[0, 0], covariance[1, 1]) > _UNSURE**2
        match(
            self._field.values,
            self._field.place,
            view.ends,
            len(view),
            prior,
            covariance,
            _WIDE if is_unsure else _NARROW,
            self._beam_variance(len(view)),
            pose,
        )
        self.pose = Pose(*pose.tolist())
        self.covariance = covariance

    def judge(self, view: ScanView) -> Fit:
        """Return how well a scan fits the pose, and remember that."""
        pose = np.array([self.pose.x, self.pose.y, self.pose.theta])
        fit = view.fit(self._field, pose, _STRIDE)
        if self.fit is None:
            self.trust(fit)
        self.fit = fit
        self._agree += _SMOOTHING * (fit.agree - self._agree)
        self._through += _SMOOTHING * (fit.through - self._through)
        self._usual_agree += _ADAPTING * (fit.agree - self._usual_agree)
        self._usual_through += _ADAPTING * (fit.through - self._usual_through)
        return fit

    def _beam_variance(self, beams: int) -> float:
        """Return the variance of a beam, m2.

        Few beams are of one thing: they err together, and so do the scans that follow.
        """
        cell = 0.5 * self._field.frame.resolution
        share = max(1.0, self._config.least_beams / max(beams, 1))
        return (self._config.beam_deviation**2 + cell**2) * share**2

    @property
    def is_doubtful(self) -> bool:
        """Whether scans fit so much worse than usual that the robot may be somewhere else."""
        return (
            self._agree < max(_LEAST, self._usual_agree - _WORSE)
            or self._through > self._usual_through + _THROUGH
        )

    def trust(self, fit: Fit) -> None:
        """Take this fit for the usual one: the place was compared with all others."""
        self.fit = fit
        self._agree = self._usual_agree = fit.agree
        self._through = self._usual_through = fit.through


def moved(
    pose: Pose, covariance: NDArray[np.float64], step: Pose, spread: NDArray[np.float64]
) -> tuple[Pose, NDArray[np.float64]]:
    """Return a pose and its covariance after a step in its own frame, unsure by ``spread``.

    ``spread`` is float64 [3, 3] along the axes of the robot after the step.
    """
    after = pose.compose(step)
    jacobian = np.array(
        [[1.0, 0.0, pose.y - after.y], [0.0, 1.0, after.x - pose.x], [0.0, 0.0, 1.0]]
    )
    turn = Pose(0.0, 0.0, after.theta)
    ahead, left = turn.compose(Pose(1.0, 0.0, 0.0)), turn.compose(Pose(0.0, 1.0, 0.0))
    axes = np.array([[ahead.x, left.x, 0.0], [ahead.y, left.y, 0.0], [0.0, 0.0, 1.0]])
    return after, jacobian @ covariance @ jacobian.T + axes @ spread @ axes.T
