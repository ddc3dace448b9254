"""The estimate of the robot's pose, as it is reported."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose

UNKNOWN_COVARIANCE: Final = np.diag([100.0**2, 100.0**2, math.pi**2])
"""Of a pose that is not known at all, m2 and rad2: not to be changed in place."""


class Knowledge(Enum):
    """How well the robot knows where it is."""

    KNOWN = "known"
    """The pose can be relied on."""
    ROUGH = "rough"
    """The pose is by wheels and gyro alone, or by too little in sight: enough to drive slowly."""
    SEARCHING = "searching"
    """The pose is not known: places are compared, and looking around helps."""
    LOST = "lost"
    """The pose was not found in time; a person should help."""

    @property
    def is_usable(self) -> bool:
        """Whether the pose is good enough to drive by."""
        return self in (Knowledge.KNOWN, Knowledge.ROUGH)


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """Where the robot is, map frame, as far as it knows.

    ``covariance`` is float64 [3, 3], of x, y (m2) and theta (rad2), and UNKNOWN_COVARIANCE if the
    pose is not known at all. ``agreement`` is the share of the last scan's beams that agree with
    the map; ``reason`` says why the pose is not known, and what helps.
    """

    pose: Pose
    covariance: NDArray[np.float64]
    knowledge: Knowledge
    agreement: float
    reason: str

    @property
    def position_deviation(self) -> float:
        """Standard deviation of the position along its worst direction, m."""
        return worst_deviation(self.covariance)

    @property
    def heading_deviation(self) -> float:
        """Standard deviation of the heading, rad."""
        return math.sqrt(max(0.0, float(self.covariance[2, 2])))


def worst_deviation(covariance: NDArray[np.float64]) -> float:
    """Return the standard deviation along the worst direction of the floor, m; NaN is infinite."""
    xx, xy, yy = float(covariance[0, 0]), float(covariance[0, 1]), float(covariance[1, 1])
    variance = 0.5 * (xx + yy) + math.hypot(0.5 * (xx - yy), xy)
    return math.inf if math.isnan(variance) else math.sqrt(max(0.0, variance))
