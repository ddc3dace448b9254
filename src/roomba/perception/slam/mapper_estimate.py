"""The estimate of the robot's pose by a mapper: how sure it is, and why it is unsure."""

from __future__ import annotations

from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.mapping import FollowingConfig
from roomba.geometry import Pose
from roomba.perception.localization.estimate import UNKNOWN_COVARIANCE, Estimate, Knowledge
from roomba.perception.slam.following.scan_follower import ScanFollower

_WAS_LIFTED: Final = (
    "the robot was lifted while it made its map: put it on its station, tell where it is (in RViz: "
    "2D Pose Estimate), or drive it a little where the map shows enough"
)
_NO_MATCH: Final = "what is in sight does not fit what was seen just now; going by wheels and gyro"


def estimate_at(pose: Pose, follower: ScanFollower, config: FollowingConfig) -> Estimate:
    """Return the estimate of a robot at ``pose``, map frame, that is followed from scan to scan."""
    agreement = follower.met * follower.close
    if follower.is_sure:
        sure = _spread(config.sure_deviation, config.sure_heading)
        return Estimate(pose, sure, Knowledge.KNOWN, agreement, "")
    unsure = _spread(config.unsure_deviation, config.unsure_heading)
    return Estimate(pose, unsure, Knowledge.ROUGH, agreement, _NO_MATCH)


def lost_estimate(pose: Pose) -> Estimate:
    """Return the estimate of a robot that was carried, and was at ``pose`` before."""
    return Estimate(pose, UNKNOWN_COVARIANCE, Knowledge.LOST, 0.0, _WAS_LIFTED)


@cache
def _spread(deviation: float, heading: float) -> NDArray[np.float64]:
    """Return the covariance of a pose by its standard deviations, m and rad."""
    return np.diag([deviation**2, deviation**2, heading**2])
