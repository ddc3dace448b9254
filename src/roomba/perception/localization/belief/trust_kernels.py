"""Compiled: how far dead reckoning is to be trusted, as scans show it on the way.

The deviations that a robot is configured with are those of its own wheels on its own floors. What
matches correct, against what dead reckoning was unsure by meanwhile, tells of any other wheels.
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
"""Share of the newest scan in how far off dead reckoning is."""
_MARGIN: Final = 4.0
"""What was seen of its errors is taken times this: they are not the same all the time."""
_MOST_OFF: Final = 200.0
"""Times its variance that one scan makes it off at most: a jump says nothing of the usual."""
_LEAST_SPREAD: Final = (0.001**2, 0.001**2, 0.0005**2)
"""m2, rad2; variances of less motion, which the match itself is no surer than."""


@inner_part
def note_correction(belief: Row, before: NDArray[np.float64]) -> None:
    """Keep by what a scan moved the pose from ``before`` [3], and what it was unsure by since."""
    pose, off = belief.pose, belief.off
    cosine, sine = math.cos(before[2]), math.sin(before[2])
    x, y = pose[0] - before[0], pose[1] - before[1]
    off[0], off[1] = cosine * x + sine * y, cosine * y - sine * x
    off[2] = wrapped(pose[2] - before[2])
    for axis in range(3):
        belief.reckoned_spread[axis], belief.spread[axis] = belief.spread[axis], 0.0


@inner_part
def learn_trust(belief: Row) -> None:
    """Learn from the correction that was noted how many times its variances dead reckoning is off.

    It is never trusted more than it was configured to be.
    """
    scale = belief.odometry_scale
    for axis in range(3):
        thought = belief.reckoned_spread[axis]
        if thought < _LEAST_SPREAD[axis]:
            continue
        seen = min(_MARGIN * belief.off[axis] * belief.off[axis] / thought, _MOST_OFF)
        scale[axis] = max(1.0, scale[axis] + _LEARNING * (seen - scale[axis]))
