"""Checks of messages: scans whose numbers no planar lidar has in m and rad, and sensor data that
its own driver marks as not measured.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

FARTHEST_ECHO: Final = 100.0
"""m; no planar lidar that a robot carries measures more: a longer range means no echo."""
_UNMEASURED: Final = -1.0
"""The first variance of data that a driver does not measure (sensor_msgs/Imu)."""
_WIDEST: Final = 4.0 * math.pi
"""rad; no scan covers more than two turns."""
_LEAST: Final = 10
"""Beams; if fewer have too long a range, these beams may just have failed."""


def is_measured(covariance: Sequence[float]) -> bool:
    """Return whether a sensor_msgs/Imu measures the quantity that has this ``covariance``, [9]."""
    return covariance[0] != _UNMEASURED


def scan_fault(
    ranges: NDArray[np.float32], first: float, step: float, nearest: float, farthest: float
) -> str:
    """Return what was expected of a scan, and what came; "" if nothing is wrong with it.

    ``ranges`` is float32 [beams], m, the beams go from the angle ``first`` on by ``step``, rad, and
    ranges count from ``nearest`` to ``farthest``, m. Single ranges are no reason to refuse a scan,
    as single beams may fail.
    """
    beams = len(ranges)
    if not (math.isfinite(first) and math.isfinite(step)):
        return f"expected finite angles, got beams from {first:g} on by {step:g} rad"
    if not beams or (step == 0.0 and beams > 1):
        return (
            f"expected a scan with beams, each at another angle, got {beams} from {first:g} on by "
            f"{step:g} rad"
        )
    if abs(step) * (beams - 1) > _WIDEST:
        return (
            f"expected beams of one turn or two, got {beams} from {first:g} on by {step:g} rad: "
            "are the angles in degrees?"
        )
    if math.isnan(farthest) or not 0.0 <= nearest < farthest:
        return (
            "expected ranges from 0 m or more on up to a larger one, got "
            f"{nearest:g} to {farthest:g} m"
        )
    # Comparisons with NaN are false, and infinite is no length.
    echoes = ranges[(ranges > 0.0) & (ranges < 1e3 * FARTHEST_ECHO)]
    far = echoes[echoes > FARTHEST_ECHO]
    is_usual = len(far) >= _LEAST and 2 * len(far) > len(echoes)
    # The same number again and again is how a driver reports that there was no echo.
    if is_usual and 2 * len(np.unique(far)) > len(far):
        return (
            f"expected ranges up to {FARTHEST_ECHO:g} m, got {len(far)} of {len(echoes)} that are "
            f"farther, {float(np.median(far)):g} m in the middle: are they in mm?"
        )
    return ""
