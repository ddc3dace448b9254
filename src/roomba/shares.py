"""Shares of a whole: never more than all of it, and all only where nothing is left."""

from __future__ import annotations

import math
from typing import Final

_SLACK: Final = 1e-6
"""%; what sums of small parts may be off."""


def share_of(part: float, whole: float) -> float:
    """Return which share of the ``whole`` a ``part`` is, 0..1; all of nothing is 1.

    What is counted as the part may be more than the whole is by now: that is 1. NaN stays NaN.
    """
    if whole <= 0.0:
        return 1.0
    share = part / whole
    return share if math.isnan(share) else min(max(share, 0.0), 1.0)


def whole_percent(share: float) -> int:
    """Return a share as a whole number of percent, 0..100; 100 is all of it, and nothing less."""
    return min(max(math.floor(100.0 * share + _SLACK), 0), 100)
