"""Shares of a whole: never more than all of it, and all only where nothing is left."""

from __future__ import annotations

import math
from typing import Final

_SLACK: Final = 1e-6
"""%; rounding error that sums of small parts may have."""


def share_of(part: float, whole: float) -> float:
    """Return which share of the ``whole`` a ``part`` is, 0..1; all of nothing is 1.

    The whole may have shrunk since the part was counted: a part above the whole gives 1. NaN stays
    NaN.
    """
    if whole <= 0.0:
        return 1.0
    share = part / whole
    return share if math.isnan(share) else min(max(share, 0.0), 1.0)


def whole_percent(share: float) -> int:
    """Return a share as whole percent, 0..100, rounded down: only all of it gives 100."""
    return min(max(math.floor(100.0 * share + _SLACK), 0), 100)
