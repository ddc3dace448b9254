"""Correlative scan matching in a wide window: the pose in which points fit a place best.

The place is a :mod:`likelihood field <roomba.perception.slam.scan_matching.likelihood_field>`, and
all poses of the window are tried (Olson, "Real-time correlative scan matching", ICRA 2009), most of
them at once: :mod:`roomba.perception.slam.scan_matching.window_search`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.perception.slam.scan_matching.likelihood_field import likelihood_field
from roomba.perception.slam.scan_matching.window_search import search

_TURN_STEP: Final = 0.012
"""rad; a cell and a bit at the usual range of 5 m."""
_MOST_POINTS: Final = 250
"""Points that are used, at most: more make the search no surer."""
_ANOTHER: Final = 0.8
"""m; a pose farther than this from a match is another place."""
_NEARLY: Final = 0.8
"""Share of a match's score from which on another place cannot be told apart from it."""


def is_in_reach(points: Floats, reach: float) -> bool:
    """Whether some points, [n, 2 or more], are within ``reach``, m, of the origin."""
    return len(_within(points, reach)) > 0


@dataclass(frozen=True, slots=True, eq=False)
class CorrelativeMatch:
    """The best pose of a window, float64 [3], and the mean likelihood of the points there, 0..1."""

    pose: Floats
    score: float


class CorrelativeMatcher:
    """Matches points to those of one place, float64 [n, 4], x, y, m, and normal, in its frame."""

    def __init__(self, points: Floats, reach: float) -> None:
        """Make the grids; raises ValueError without a point within ``reach``, m, of the origin.

        Farther points are left out, both of the place and of the points that are matched: their
        bearing is less sure.
        """
        self._reach = reach
        near = np.ascontiguousarray(_within(points, reach))
        if not len(near):
            raise ValueError("expected points in reach, got none")
        self._field = likelihood_field(near)

    def best(
        self, points: Floats, around: Floats, window: float, turn: float, least: float
    ) -> CorrelativeMatch | None:
        """Return the best pose within ``window``, m, and ``turn``, rad, of a pose [3].

        ``points`` are float64 [n, 2 or more], x, y, m, relative to where they were seen from.
        Return None if no pose has a mean likelihood of more than ``least``, 0..1.
        """
        return self._best(points, around, window, turn, least, np.zeros(3))

    def is_unique(
        self,
        points: Floats,
        match: CorrelativeMatch,
        around: Floats,
        window: float,
        turn: float,
    ) -> bool:
        """Whether no other place in a window, as in :meth:`best`, fits nearly as well as a match.

        In a corridor that looks alike all along, another place does.
        """
        beside = np.array([*(match.pose[:2] - around[:2]), _ANOTHER])
        return self._best(points, around, window, turn, _NEARLY * match.score, beside) is None

    def _best(
        self,
        points: Floats,
        around: Floats,
        window: float,
        turn: float,
        least: float,
        beside: Floats,
    ) -> CorrelativeMatch | None:
        """Return the best pose in a window, as :meth:`best`; ``beside`` is as in ``search``."""
        near = _within(points, self._reach)
        stride = max(1, -(-len(near) // _MOST_POINTS))
        few = np.ascontiguousarray(near[::stride, :2])
        found = np.empty(4)
        if not len(few) or not search(
            self._field, few, around, window, turn, _TURN_STEP, least, beside, found
        ):
            return None
        return CorrelativeMatch(found[:3].copy(), float(found[3]))


def _within(points: Floats, reach: float) -> Floats:
    """Return the points, [n, 2 or more], that are within ``reach``, m, of their origin."""
    near: Floats = points[np.hypot(points[:, 0], points[:, 1]) < reach]
    return near
