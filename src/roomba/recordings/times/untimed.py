"""Times for logs whose own ones do not tell their scans apart: missing, or cut to few digits.

What is known then is the order of the lines. It is kept, and so are the times that do differ.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.arrays import Floats, Ints64, Mask

_EQUAL: Final = 0.5
"""Share of times equal to the one before, from which they tell nothing; a log in which each scan is
written twice has no more.
"""
_TICKS: Final = 0.02
"""Share of the scans that begin another time; with fewer the clock is broken, not just coarse."""
_FEWEST_TICKS: Final = 3
"""So many different times of a channel are a coarse clock's, not a broken one's."""
_STEP: Final = 10.0
"""s from one scan to the next by a broken clock: so slow that turning within a scan is nothing."""


def tell_nothing(times: Floats) -> bool:
    """Whether most ``times`` of scans, s, in the order of recording, equal the one before."""
    return int(np.count_nonzero(np.diff(times) == 0.0)) > _EQUAL * len(times)


def times_by_order(stamps: Floats, arrivals: Floats) -> Floats | None:
    """Return times of a channel's messages, s, by their order; None where its times tell.

    Both are in the order of recording. Where neither tells messages apart, the one with more
    different times counts. With hardly any of them the order is no help, as it is not known what
    came between on other channels. What is returned is by the clock of the ``arrivals``.
    """
    if not (tell_nothing(stamps) and tell_nothing(arrivals)):
        return None
    told = max((arrivals, stamps), key=lambda times: len(np.unique(times)))
    times = np.maximum.accumulate(told)
    ticks = _ticks(times)
    if len(ticks) < _FEWEST_TICKS:
        return None
    late = float(np.median(arrivals - told))
    return np.asarray(_between(times, ticks) + late, np.float64)


def spread_times(times: Floats, is_scan: Mask) -> Floats:
    """Return times of lines, s, in their order: scans of a time lie evenly before the next time.

    ``times`` and ``is_scan`` [lines] are those of a log with at least a scan. The times of other
    lines do not count: they lie evenly between the scans around them.
    """
    scans = np.flatnonzero(is_scan)
    spread = _by_ticks(np.maximum.accumulate(times[scans]))
    return np.asarray(np.interp(np.arange(len(times)), scans, spread), np.float64)


def _by_ticks(times: Floats) -> Floats:
    """Return ``times``, s, which never go back, with equal ones spread evenly up to the next."""
    ticks = _ticks(times)
    if len(ticks) < 2 or len(ticks) < _TICKS * len(times):
        return np.asarray(times[0] + _STEP * np.arange(len(times)), np.float64)
    return _between(times, ticks)


def _ticks(times: Floats) -> Ints64:
    """Return the numbers of the ``times``, s, that differ from the one before, and of the first."""
    return np.concatenate(([0], 1 + np.flatnonzero(np.diff(times) > 0.0)))


def _between(times: Floats, ticks: Ints64) -> Floats:
    """Return ``times``, s, evenly from each of the ``ticks`` up to the next."""
    count = len(times)
    step = float(np.median(np.diff(times[ticks]) / np.diff(ticks)))
    end = float(times[-1]) + step * (count - int(ticks[-1]))
    known = [*times[ticks].tolist(), end]
    return np.asarray(np.interp(np.arange(count), [*ticks.tolist(), count], known), np.float64)
