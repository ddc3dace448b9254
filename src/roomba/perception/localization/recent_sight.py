"""Comparison of a scan with those of the last seconds, by dead reckoning in between.

If they agree the robot was not carried, however badly the map fits: furniture was moved around it.
A robot that was carried sees what contradicts the earlier scans.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import RecentSightConfig
from roomba.geometry import Pose
from roomba.perception.localization.recent_sight_kernels import KEPT, Sights, newest_of, note_sight
from roomba.perception.matching.scan_view import ScanView

_SECTORS: Final = 360
"""Directions that are told apart."""


class RecentSight:
    """Scans of the last seconds, each with where dead reckoning said that it was taken.

    Kernels may go on with its ``arrays``.
    """

    def __init__(self, config: RecentSightConfig) -> None:
        """Begin with nothing seen, and no room yet: see :meth:`reserve`."""
        self._config = config
        self._mount = np.zeros(3)
        self._ring = np.zeros(2, np.int64)
        self._stamps, self._places = np.zeros(KEPT), np.zeros((KEPT, 3))
        self._counts = np.zeros(KEPT, np.int64)
        self._ends = np.zeros((KEPT, 0, 4))

    @property
    def arrays(self) -> Sights:
        """The scans as kernels know them; ask anew after scans of more beams."""
        return Sights(
            self._ring, self._stamps, self._places, self._counts, self._ends, self._config.apart
        )

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
        place = reckoned.as_array()
        note_sight(self.arrays, stamp, place, view.ends, len(view))

    def is_still(self, stamp: float, reckoned: Pose, view: ScanView) -> bool:
        """Whether a scan shows what was seen some time before, seen from where the robot is now."""
        for number in range(int(self._ring[1])):
            kept = newest_of(self._ring, number)
            if self._config.newest <= stamp - self._stamps[kept] <= self._config.oldest:
                before = ScanView(self._ends[kept, : self._counts[kept]], self._mount)
                place = Pose(*self._places[kept].tolist())
                return _is_same(before, view, place.inverse().compose(reckoned), self._config)
        return False


def _is_same(before: ScanView, view: ScanView, step: Pose, config: RecentSightConfig) -> bool:
    """Whether a scan, taken a ``step`` after another one, shows the same as that one.

    A beam that ends behind the surfaces seen before is no difference: what it met was hidden.
    """
    if not len(before) or not len(view):
        return False
    nearest, farthest = _outline(before)
    cosine, sine = math.cos(step.theta), math.sin(step.theta)
    x = step.x + cosine * view.ends[:, 0] - sine * view.ends[:, 1] - before.mount[0]
    y = step.y + sine * view.ends[:, 0] + cosine * view.ends[:, 1] - before.mount[1]
    away, sector = np.hypot(x, y), _sectors(x, y)
    slack = config.slack + config.slack_share * away
    is_before = away < nearest[sector] - slack
    is_behind = away > farthest[sector] + slack
    other = int(np.count_nonzero(is_before & np.isfinite(nearest[sector])))
    same = int(np.count_nonzero(~is_before & ~is_behind))
    is_enough = same >= config.least_same * len(view)
    return is_enough and other <= config.most_other * (same + other)


def _outline(view: ScanView) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the nearest and the farthest range in each sector and its two neighbours, m."""
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
