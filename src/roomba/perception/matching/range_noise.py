"""The noise of a lidar's ranges, measured from its scans.

Along a straight wall 1/r is a sinusoid of the beam's angle, so that its fourth difference over five
neighbouring beams is next to nothing but noise. Where beams meet corners, legs or different things
it is large, which the median of many leaves out.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

_BINS: Final = 160
_FIRST, _LAST = 1e-4, 1.0
"""m; deviations between which samples are told apart, in steps of 6 %."""
_STEP: Final = math.log(_LAST / _FIRST) / _BINS
_LEAST_SAMPLES: Final = 300
"""Fewer say too little."""
_MOST_SAMPLES: Final = 100_000
"""With more the older ones count half."""
_PER_MEDIAN: Final = 1.4826
"""Standard deviation of a normal distribution in medians of its absolute values."""
_OF_FIVE: Final = math.sqrt(1.0 + 16.0 + 36.0 + 16.0 + 1.0)
"""Standard deviation of a fourth difference in those of its terms."""
_FARTHEST: Final = 8.0
"""m; neighbouring beams farther off are too far apart to meet one surface."""
_TYPICAL: Final = 0.005
"""m; before anything is known."""
_LEAST: Final = 0.001
"""m; ranges that are rounded may seem to have no noise."""


class RangeNoise:
    """The standard deviation of a lidar's ranges, from the differences of neighbouring beams."""

    def __init__(self) -> None:
        """Begin without a sample."""
        self._counts = np.zeros(_BINS, np.int64)
        self.deviation = _TYPICAL
        """Standard deviation of a range, m."""

    def add(self, ranges: NDArray[np.float32], nearest: float, farthest: float) -> None:
        """Take a scan, float32 [beams], m; ranges count from ``nearest`` to ``farthest``, m."""
        _count(ranges, nearest, min(farthest, _FARTHEST), self._counts)
        total = int(self._counts.sum())
        if total >= _LEAST_SAMPLES:
            middle = int(np.searchsorted(np.cumsum(self._counts), 0.5 * total))
            median = _FIRST * math.exp((middle + 0.5) * _STEP)
            self.deviation = max(_LEAST, _PER_MEDIAN * median)
        if total > _MOST_SAMPLES:
            self._counts //= 2


@njit(cache=True, nogil=True, error_model="numpy")
def _count(
    ranges: NDArray[np.float32], nearest: float, farthest: float, counts: NDArray[np.int64]
) -> None:
    """Add to ``counts`` [_BINS] the deviations that each five neighbouring beams show."""
    inverse = np.zeros(5)
    for last in range(4, ranges.size):
        is_whole = True
        for index in range(5):
            length = ranges[last - 4 + index]
            is_whole &= nearest <= length <= farthest
            inverse[index] = 1.0 / length if length > 0.0 else 0.0
        if not is_whole:
            continue
        difference = (
            inverse[0] - 4.0 * inverse[1] + 6.0 * inverse[2] - 4.0 * inverse[3] + inverse[4]
        )
        length = ranges[last - 2]
        off = abs(difference) * length * length / _OF_FIVE
        place = math.log(max(off, _FIRST) / _FIRST) / _STEP
        counts[min(int(place), _BINS - 1)] += 1
