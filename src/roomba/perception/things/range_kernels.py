"""Compiled: how noisy ranges are, and which of them lie between two things.

A beam is as wide as a finger. Where it meets the edge of something it is sent back by that and by
what is behind, and its range lies between both, where there is nothing.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import inner_part, part
from roomba.perception.matching.range_noise import LEAST_SAMPLES, measure_noise, unknown_noise

Ranges = NDArray[np.float32]
Rows = NDArray[np.void]

_STEP: Final = 0.5
"""m; the noise of ranges is measured for each interval of this length by itself."""
_EVERY: Final = 5
"""The noise of every fifth scan is measured."""
_UNKNOWN: Final = 0.02
"""m; noise of ranges if neither it nor that of farther ranges is known: hardly a lidar has more."""
_STEEP: Final = 5.7
"""Tangent of 80 degrees: a surface that beams meet at a larger angle is hardly seen."""
_OF_TWO: Final = math.sqrt(2.0)
_OF_THREE: Final = math.sqrt(6.0)
"""Deviation, over that of one range, of the difference of two, and of a third range by two."""


def unknown_noises(farthest: float) -> Rows:
    """Return the noise that is assumed for ranges up to ``farthest``, m, before a scan came."""
    noises = np.concatenate([unknown_noise() for _ in range(math.ceil(farthest / _STEP))])
    noises["deviation"] = _UNKNOWN
    return noises


@inner_part
def measure_noises(noises: Rows, scan: int, ranges: Ranges, nearest: float) -> None:
    """Take a scan, float32 [beams], m, as it was measured; ``scan`` is its number."""
    if scan % _EVERY != 0:
        return
    for index in range(noises.size):
        first = max(nearest, index * _STEP)
        measure_noise(noises[index : index + 1], ranges, first, (index + 1) * _STEP)
    # Where too few ranges were measured, take the noise of the next farther ones.
    farther = _UNKNOWN
    for index in range(noises.size - 1, -1, -1):
        if noises[index]["total"] < LEAST_SAMPLES:
            noises[index]["deviation"] = farther
        farther = float(noises[index]["deviation"])


@part
def noise_at(noises: Rows, away: float) -> float:
    """Return the standard deviation of a range, m."""
    return float(noises[min(int(away / _STEP), noises.size - 1)]["deviation"])


@inner_part
def is_mixed(ranges: Ranges, beam: int, step: float, around: int, slack: float) -> bool:
    """Whether a range lies between two things that its neighbours met, on no surface with these.

    ``step`` is the angle between beams, rad, of which ``around`` fill a turn; each range may be off
    by ``slack``, m.
    """
    length = float(ranges[beam])
    right, righter = _beside(ranges, beam, -1, around), _beside(ranges, beam, -2, around)
    left, lefter = _beside(ranges, beam, 1, around), _beside(ranges, beam, 2, around)
    wide = abs(step) * length
    near = _OF_TWO * slack + wide
    if abs(right - length) <= near or abs(left - length) <= near:
        return False
    if not (right <= length or left <= length):
        # The range is shorter than both neighbours: it is of something thin before them.
        return False
    is_between = abs(left - right) <= 2.0 * _STEEP * wide and _is_in_line(
        length, 0.5 * (1.0 / right + 1.0 / left), _OF_TWO * slack
    )
    return not (
        is_between
        or _is_in_line(length, 2.0 / right - 1.0 / righter, _OF_THREE * slack)
        or _is_in_line(length, 2.0 / left - 1.0 / lefter, _OF_THREE * slack)
    )


@part
def _is_in_line(length: float, inverse: float, slack: float) -> bool:
    """Whether a range agrees with 1/r as its neighbours predict it: 1/r is even along a line."""
    return abs(inverse * length - 1.0) * length <= slack


@part
def _beside(ranges: Ranges, beam: int, way: int, around: int) -> float:
    """Return the range, m, ``way`` beams to the left of a beam; nan if there is none."""
    other = (beam + way) % around
    return float(ranges[other]) if other < ranges.size else math.nan
