"""Matching of a scan from a pose that is tried, and the choice of beams to compare many poses."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose, wrap_angle
from roomba.perception.matching.match_kernels import match
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField

FROM_NEAR: Final = np.array([0.15, 0.10, 0.05, 0.05])
FROM_AFAR: Final = np.array([0.40, 0.30, 0.20, 0.10, 0.05, 0.05])
"""m; beams that end farther off than this lose weight, round by round."""
_SPREAD: Final = np.diag([0.3**2, 0.3**2, 0.2**2])
"""m2, rad2; covariance of a pose that is tried."""


def matched(
    view: ScanView,
    field: SurfaceField,
    start: Pose,
    deviation: float,
    scales: NDArray[np.float64] = FROM_AFAR,
) -> tuple[Pose, Fit]:
    """Return the best pose for a scan near a start, and its fit; ``deviation`` is a beam's, m."""
    prior = start.as_array()
    pose, covariance = prior.copy(), _SPREAD.copy()
    match(
        field.values,
        field.place,
        view.ends,
        len(view),
        prior,
        covariance,
        scales,
        deviation * deviation,
        pose,
    )
    return Pose(float(pose[0]), float(pose[1]), wrap_angle(float(pose[2]))), view.fit(field, pose)


def evenly_chosen(count: int, most: int) -> NDArray[np.int64]:
    """Return the indices of ``most`` beams, evenly out of ``count``; all if there are fewer."""
    return np.linspace(0, count - 1, min(count, most)).astype(np.int64)
