"""Compiled: how far dead reckoning is to be trusted, as scans show it on the way.

The configured deviations are those of one robot's wheels on its own floors. The corrections by
matched scans, relative to dead reckoning's variances since the scan before, show those of others.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.compilation import inner_part
from roomba.perception.localization.belief.belief import Row

_LEARNING: Final = 0.02
"""Share of the newest scan in the factors on dead reckoning's variances."""
_MARGIN: Final = 4.0
"""Factor on the squared errors that were seen, as errors are larger at times."""
_MOST_OFF: Final = 200.0
"""Limit of the factor that one scan shows: a jump says nothing of the usual errors."""
_LEAST_SPREAD: Final = (0.001**2, 0.001**2, 0.0005**2)
"""m2, rad2; a step with smaller variances teaches nothing: the match itself is no more exact."""


@inner_part
def note_correction(belief: Row, before: NDArray[np.float64]) -> None:
    """Note how a scan moved the pose from ``before`` [3], and the variances since the last scan."""
    pose, off = belief.pose, belief.off
    cosine, sine = math.cos(before[2]), math.sin(before[2])
    x, y = pose[0] - before[0], pose[1] - before[1]
    off[0], off[1] = cosine * x + sine * y, cosine * y - sine * x
    off[2] = wrapped(pose[2] - before[2])
    for axis in range(3):
        belief.reckoned_spread[axis], belief.spread[axis] = belief.spread[axis], 0.0


@inner_part
def learn_trust(belief: Row) -> None:
    """Learn the factors on dead reckoning's variances from the correction that was noted.

    They are never below 1: dead reckoning is not trusted more than it was configured to be.
    """
    scale = belief.odometry_scale
    for axis in range(3):
        thought = belief.reckoned_spread[axis]
        if thought < _LEAST_SPREAD[axis]:
            continue
        seen = min(_MARGIN * belief.off[axis] * belief.off[axis] / thought, _MOST_OFF)
        scale[axis] = max(1.0, scale[axis] + _LEARNING * (seen - scale[axis]))
