"""Comparison of a scan with those of the last seconds, by dead reckoning in between.

If they agree the robot was not carried, however badly the map fits: furniture was moved around it.
A robot that was carried sees what contradicts the earlier scans.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.localization.recent_sight_kernels import KEPT, Sights, newest_of, note_sight
from roomba.perception.matching.scan_view import ScanView

_SECTORS: Final = 360
"""Directions that are told apart."""
_OLD_ENOUGH: Final = 1.0
"""s; the least age of a scan to compare with: later ones may be from after it was carried."""
_TOO_OLD: Final = 6.0
"""s; the greatest age: by then it may have driven elsewhere."""
_SLACK: Final = 0.10
_SLACK_SHARE: Final = 0.03
"""m, and share of the range: how far from what was seen a beam may end and mean the same."""
_LEAST_SAME: Final = 0.4
"""Share of all beams that must end where something was seen."""
_MOST_OTHER: Final = 0.2
"""Share, of these and those that end where nothing was, that the latter may have."""


class RecentSight:
    """Scans of the last seconds, each with where dead reckoning said that it was taken.

    Kernels may go on with its ``arrays``.
    """

    def __init__(self, beams: int = 0) -> None:
        """Begin with nothing seen; there is room for scans of so many ``beams``, and for larger."""
        self._mount = np.zeros(3)
        self._ring = np.zeros(2, np.int64)
        self._stamps, self._places = np.zeros(KEPT), np.zeros((KEPT, 3))
        self._counts = np.zeros(KEPT, np.int64)
        self._ends = np.zeros((KEPT, beams, 4))

    @property
    def arrays(self) -> Sights:
        """Return it as kernels know it: another one after scans of more beams."""
        return Sights(self._ring, self._stamps, self._places, self._counts, self._ends)

    def reserve(self, beams: int) -> None:
        """Make room for scans of so many beams."""
        before = self._ends
        if beams > before.shape[1]:
            self._ends = np.zeros((KEPT, beams, 4))
            self._ends[:, : before.shape[1]] = before

    def note(self, stamp: float, reckoned: Pose, view: ScanView) -> None:
        """Keep a scan that was taken at a time, s, and a place of dead reckoning's frame."""
        self.reserve(len(view))
        self._mount = view.mount
        place = np.array([reckoned.x, reckoned.y, reckoned.theta])
        note_sight(self.arrays, stamp, place, view.ends, len(view))

    def is_still(self, stamp: float, reckoned: Pose, view: ScanView) -> bool:
        """Whether a newer scan shows what was seen there before it."""
        for number in range(int(self._ring[1])):
            kept = newest_of(self._ring, number)
            if _OLD_ENOUGH <= stamp - self._stamps[kept] <= _TOO_OLD:
                before = ScanView(self._ends[kept, : self._counts[kept]], self._mount)
                place = Pose(*self._places[kept].tolist())
                return _is_same(before, view, place.inverse().compose(reckoned))
        return False


def _is_same(before: ScanView, view: ScanView, step: Pose) -> bool:
    """Whether a scan shows the same as one before it, taken a ``step`` further on.

    What lies behind what was seen then may be new: it was hidden.
    """
    if not len(before) or not len(view):
        return False
    nearest, farthest = _outline(before)
    cosine, sine = math.cos(step.theta), math.sin(step.theta)
    x = step.x + cosine * view.ends[:, 0] - sine * view.ends[:, 1] - before.mount[0]
    y = step.y + sine * view.ends[:, 0] + cosine * view.ends[:, 1] - before.mount[1]
    away, sector = np.hypot(x, y), _sectors(x, y)
    slack = _SLACK + _SLACK_SHARE * away
    is_before = away < nearest[sector] - slack
    is_behind = away > farthest[sector] + slack
    other = int(np.count_nonzero(is_before & np.isfinite(nearest[sector])))
    same = int(np.count_nonzero(~is_before & ~is_behind))
    return same >= _LEAST_SAME * len(view) and other <= _MOST_OTHER * (same + other)


def _outline(view: ScanView) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return for each sector how near and how far what was seen in it and next to it is, m."""
    x, y = view.ends[:, 0] - view.mount[0], view.ends[:, 1] - view.mount[1]
    away, sector = np.hypot(x, y), _sectors(x, y)
    nearest, farthest = np.full(_SECTORS, np.inf), np.zeros(_SECTORS)
    for aside in (-1, 0, 1):
        np.minimum.at(nearest, (sector + aside) % _SECTORS, away)
        np.maximum.at(farthest, (sector + aside) % _SECTORS, away)
    farthest[np.isinf(nearest)] = np.inf
    return nearest, farthest


def _sectors(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return in which sector points lie, as seen from the origin."""
    turns = np.arctan2(y, x) / (2.0 * math.pi)
    return np.asarray(np.floor(turns * _SECTORS).astype(np.int64) % _SECTORS)
