"""Clocks that go at another rate than the recorder's: in other units, or a little fast or slow.

A stamp is of the clock of a driver, an arrival of that of the recorder. On one clock a message is
recorded as long after its stamp at the end of a drive as at its begin.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.recordings.times.stamps import arrivals_tell, delay_of, valid_stamps

_LEAST: Final = 50
"""Messages; of fewer no rate is told."""
_UNITS: Final = {1e3: "ms", 1e6: "µs", 1e9: "ns"}
_SAME_UNIT: Final = 0.05
"""Share by which a rate may be off that of a unit."""
_EVEN: Final = 0.2
"""Share of a delay's growth by which its middle may be off the mean of both ends."""
_FASTEST: Final = 0.05
"""Share by which a clock may be fast or slow; no clock is more."""
_PARTS: Final = 10
_ONE: Final = 0.05
"""Parts of a channel, and the share by which the rate of each may be off that of all of it."""
_SAME_RATE: Final = 0.02
"""Share by which the rates of two channels may differ if the recorder's clock is what is off."""


def unit_of(stamps: Floats, arrivals: Floats) -> tuple[float, str]:
    """Return how many units of a channel's stamps make a second, and their name; else 1.0, "s".

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


def drift_of_recorder(reference: float, drifts: Sequence[float]) -> float:
    """Return by how much the recorder's clock drifts beside all channels, s in a second; else 0.

    ``drifts`` are those of all channels, and ``reference`` is that of the channel whose clock
    counts. At least one other channel must have the same drift.
    """
    near = [abs(drift - reference) < _SAME_RATE * abs(1.0 - reference) for drift in drifts]
    return reference if sum(near) > 1 else 0.0


def drift_of_played(stamps: Floats, arrivals: Floats) -> float:
    """Return the same as :func:`drift_of`, but also a drift that is larger than any clock's.

    The stamps must go on at one rate all along the channel.
    """
    valid = valid_stamps(stamps)
    count = int(np.count_nonzero(valid))
    if count < _LEAST or not arrivals_tell(stamps[valid], arrivals):
        return 0.0
    parts = (np.array_split(each[valid], _PARTS) for each in (stamps, arrivals))
    told, came = ([float(np.median(part)) for part in each] for each in parts)
    spent = np.diff(came)
    rate = (told[-1] - told[0]) / (came[-1] - came[0]) if (spent > 0.0).all() else 0.0
    is_one_rate = rate > 0.0 and bool((np.abs(np.diff(told) / spent / rate - 1.0) < _ONE).all())
    return 1.0 - rate if is_one_rate else 0.0


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
