"""Clocks that go at another rate than the recorder's: in other units, or a little fast or slow.

A stamp is of the clock of a driver, an arrival of that of the recorder. On one clock a message is
recorded as long after its stamp at the end of a drive as at its begin.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.recordings.times.stamps import arrivals_tell, delay_of, valid_stamps

_LEAST: Final = 50
"""Messages; of fewer no rate is told."""
_UNITS: Final = {1e3: "ms", 1e6: "µs", 1e9: "ns"}
_SAME_UNIT: Final = 0.05
"""So much, as a share, a rate may be off that of a unit."""
_EVEN: Final = 0.2
"""Share of what a delay grew by; so far off the mean of both ends it may be in the middle."""
_FASTEST: Final = 0.05
"""Share; no clock is more fast or slow."""


def unit_of(stamps: Floats, arrivals: Floats) -> tuple[float, str]:
    """Return how many units of a channel's stamps are a second, and their name; (1.0, "s").

    ``stamps``, in those units, and ``arrivals``, s, are [n], in the order of recording.
    """
    ends = _ends(stamps, arrivals)
    if ends is not None:
        (first, _, last), (begin, _, end) = ends
        rate = (last - first) / (end - begin)
        for unit, name in _UNITS.items():
            if abs(rate / unit - 1.0) < _SAME_UNIT:
                return unit, name
    return 1.0, "s"


def drift_of(stamps: Floats, arrivals: Floats) -> float:
    """Return by how much the delay of a channel's messages grows evenly, s in a second; else 0.

    ``stamps`` and ``arrivals`` are [n], s, in the order of recording.
    """
    ends = _ends(stamps, arrivals)
    if ends is None or delay_of(stamps, arrivals) is None:
        return 0.0
    delays, spent = ends[1] - ends[0], float(ends[1][2] - ends[1][0])
    grown = float(delays[2] - delays[0])
    is_even = abs(float(delays[1] - 0.5 * (delays[0] + delays[2]))) < _EVEN * abs(grown)
    return grown / spent if is_even and abs(grown) < _FASTEST * spent else 0.0


def _ends(stamps: Floats, arrivals: Floats) -> tuple[Floats, Floats] | None:
    """Return the median stamps and arrivals, [3] each, s, of the first, the middle and the last
    tenth; None where they tell nothing.
    """
    valid = valid_stamps(stamps)
    stamps, arrivals = stamps[valid], arrivals[valid]
    count = len(stamps)
    if count < _LEAST or not arrivals_tell(stamps, arrivals):
        return None
    tenth = count // 10
    middle = (count - tenth) // 2
    parts = slice(0, tenth), slice(middle, middle + tenth), slice(count - tenth, count)
    told = np.array([(np.median(stamps[part]), np.median(arrivals[part])) for part in parts])
    return (told[:, 0], told[:, 1]) if told[2, 1] > told[0, 1] else None
