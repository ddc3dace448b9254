"""Times for logs whose own ones do not tell their scans apart: missing, or cut to few digits.

What is known then is the order of the lines. It is kept, and so are the times that do differ.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

_EQUAL: Final = 0.5
"""Share of times equal to the one before, from which they tell nothing; a log in which each scan is
written twice has no more.
"""
_TICKS: Final = 0.02
"""Share of the scans that begin another time; with fewer the clock is broken, not just coarse."""
_STEP: Final = 10.0
"""s from one scan to the next by a broken clock: so slow that turning within a scan is nothing."""


def tell_nothing(times: Floats) -> bool:
    """Whether most of the ``times`` of scans, s, in the order of recording, equal the last one."""
    return int(np.count_nonzero(np.diff(times) == 0.0)) > _EQUAL * len(times)


def spread_times(times: Floats, is_scan: Mask) -> Floats:
    """Return times of lines, s, in their order: scans of a time lie evenly before the next time.

    ``times`` and ``is_scan`` [lines] are those of a log with at least a scan. The times of other
    lines do not count: they lie evenly between the scans around them.
    """
    scans = np.flatnonzero(is_scan)
    spread = _by_ticks(np.maximum.accumulate(times[scans]))
    return np.asarray(np.interp(np.arange(len(times)), scans, spread), np.float64)


def _by_ticks(times: Floats) -> Floats:
    """Return ``times``, s, that never go back with the equal ones spread up to the next."""
    count = len(times)
    ticks = np.concatenate(([0], 1 + np.flatnonzero(np.diff(times) > 0.0)))
    if len(ticks) < 2 or len(ticks) < _TICKS * count:
        return np.asarray(times[0] + _STEP * np.arange(count), np.float64)
    step = float(np.median(np.diff(times[ticks]) / np.diff(ticks)))
    end = float(times[-1]) + step * (count - int(ticks[-1]))
    known = [*times[ticks].tolist(), end]
    return np.asarray(np.interp(np.arange(count), [*ticks.tolist(), count], known), np.float64)
