"""Gaps between things that look hardly wide enough: planning closes them.

Only a part of a thing is seen, and at the next look the thing may seem nearer. A robot that drives
in between the legs of a chair may then be shut in there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import RoundObstacle

_SIZE: Final = 0.01
"""m; radius of what is put into a gap to close it."""
_ALONE: Final = 0.9
"""Share of half the things' distance that a gap's middle keeps from all; else it is a corner."""


def closed_gaps(things: Sequence[RoundObstacle], reach: float, spare: float) -> list[RoundObstacle]:
    """Return round things, m, that close the gaps between ``things`` which are hardly wide enough.

    ``reach`` is what the body's middle keeps away from things, m; ``spare``, m, is how much
    more than that a gap must be wide.
    """
    if len(things) < 2:
        return []
    array = np.array(things, np.float64)
    first, second = np.triu_indices(len(array), 1)
    away = np.hypot(*(array[first, :2] - array[second, :2]).T)
    gap = away - array[first, 2] - array[second, 2]
    is_narrow = (gap >= 2.0 * reach) & (gap < 2.0 * reach + spare)
    first, second, away = first[is_narrow], second[is_narrow], away[is_narrow]
    middles = 0.5 * (array[first, :2] + array[second, :2])
    if not len(middles):
        return []
    nearest = _nearest(middles, array)
    alone = middles[nearest >= _ALONE * 0.5 * away]
    return [(x, y, _SIZE) for x, y in alone.tolist()]


def _nearest(points: NDArray[np.float64], things: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far the nearest thing's middle is from each point, m."""
    away = [np.hypot(*(things[:, :2] - point).T).min() for point in points]
    return np.array(away, np.float64)
