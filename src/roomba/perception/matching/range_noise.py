"""The noise of a lidar's ranges, measured from its scans.

Along a straight wall 1/r is a sinusoid of the beam's angle, so that its fourth difference over five
neighbouring beams is next to nothing but noise. Where beams meet corners, legs or different things
the difference is large; the median of many differences leaves these out. A single wrong range
spoils five differences, so that soon most are spoilt: then the lowest tenth tells more.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry, inner_part

Rows = NDArray[np.void]

_BINS: Final = 160
_FIRST, _LAST = 1e-4, 1.0
"""m; the range of deviations that the histogram covers, in steps of 6 %."""
_STEP: Final = math.log(_LAST / _FIRST) / _BINS
LEAST_SAMPLES: Final = 300
"""Fewer samples say too little."""
_MOST_SAMPLES: Final = 100_000
"""Above this number of samples all counts so far are halved."""
_PER_MEDIAN: Final = 1.4826
"""Standard deviation of a normal distribution over the median of its absolute values."""
_PER_TENTH: Final = 1.0 / 0.12566
"""The same over the first decile of its absolute values."""
_SPOILT: Final = 0.05
"""m; no lidar is so noisy: with a larger deviation most differences come of wrong ranges."""
_OF_FIVE: Final = math.sqrt(1.0 + 16.0 + 36.0 + 16.0 + 1.0)
"""Standard deviation of a fourth difference over that of each of its terms."""
_FARTHEST: Final = 8.0
"""m; neighbouring beams farther off are too far apart to meet one surface."""
_TYPICAL: Final = 0.005
"""m; taken for the deviation before anything is known."""
_LEAST: Final = 0.001
"""m; the least deviation: ranges that are rounded may seem to have no noise."""


NOISE: Final = np.dtype(
    [
        ("counts", "i8", (_BINS,)),  # of differences between neighbouring beams, by size
        ("total", "i8"),  # of all these
        ("deviation", "f8"),  # m; standard deviation of a range
    ],
    align=True,
)
"""What is known of a lidar's noise, one row."""


def unknown_noise() -> Rows:
    """Return the noise that is assumed before a scan came, NOISE [1]."""
    noise = np.zeros(1, NOISE)
    noise["deviation"] = _TYPICAL
    return noise


@entry
def measure_noise(
    noises: Rows, ranges: NDArray[np.float32], nearest: float, farthest: float
) -> None:
    """Take a scan, float32 [beams], m; ranges count from ``nearest`` to ``farthest``, m."""
    noise = noises[0]
    counts = noise.counts
    noise.total += _count(ranges, nearest, min(farthest, _FARTHEST), counts)
    if noise.total >= LEAST_SAMPLES:
        noise.deviation = max(_LEAST, _PER_MEDIAN * _quantile(counts, 0.5 * noise.total))
        if noise.deviation > _SPOILT:
            of_least = _PER_TENTH * _quantile(counts, 0.1 * noise.total)
            noise.deviation = max(_LEAST, min(noise.deviation, of_least))
    if noise.total > _MOST_SAMPLES:
        noise.total = 0
        for place in range(_BINS):
            counts[place] //= 2
            noise.total += counts[place]


@inner_part
def _quantile(counts: NDArray[np.int64], below: float) -> float:
    """Return the deviation, m, below which ``below`` of the samples in ``counts`` [_BINS] lie."""
    sum_so_far, place = 0, 0
    while sum_so_far + counts[place] < below:
        sum_so_far += counts[place]
        place += 1
    return _FIRST * math.exp((place + 0.5) * _STEP)


@inner_part
def _count(
    ranges: NDArray[np.float32], nearest: float, farthest: float, counts: NDArray[np.int64]
) -> int:
    """Add to ``counts`` [_BINS] the deviation that each five neighbouring beams show.

    Returns how many samples were added.
    """
    samples = whole = 0
    # 1/r of the last five beams, the newest one last.
    a = b = c = d = e = 0.0
    for last in range(ranges.size):
        length = ranges[last]
        a, b, c, d = b, c, d, e
        if not nearest <= length < farthest or length <= 0.0:
            whole = 0
            continue
        e = 1.0 / length
        whole += 1
        if whole < 5:
            continue
        difference = a - 4.0 * b + 6.0 * c - 4.0 * d + e
        length = ranges[last - 2]
        off = abs(difference) * length * length / _OF_FIVE
        place = math.log(max(off, _FIRST) / _FIRST) / _STEP
        counts[min(int(place), _BINS - 1)] += 1
        samples += 1
    return samples
