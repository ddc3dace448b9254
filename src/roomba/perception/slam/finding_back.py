"""When scans stop to fit: how far around the robot is looked for then, and where it is found.

Scans may stop to fit because dead reckoning is wrong (wheels that slip, odometry that stands still
or leaps), because the robot was moved, or because what is in sight is new.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.perception.slam.correlative import CorrelativeMatcher, is_in_reach
from roomba.perception.slam.follow_kernels import LEAST_POINTS, is_apart
from roomba.perception.slam.scan_follower import ScanFollower
from roomba.perception.slam.surfels import SurfelGrid

Floats = NDArray[np.float64]

_AT_ONCE: Final = 2
_EVERY: Final = 3
"""Of scans in a row that do not fit, the first ones are searched for, and then each such one."""
_SEARCHED_WAY: Final = 0.5
_SEARCHED_TURN: Final = 0.8
"""m, rad; so far to each side,"""
_SEARCHED_SHARE: Final = 0.2
"""and by this share of what was driven and turned since a scan confirmed the pose,"""
_FARTHEST: Final = 4.0
"""m; and by what it drives in that time, but no farther than this."""
_LIKELIHOOD: Final = 0.5
"""Mean likelihood of points, 0..1, from which a pose is looked at closely."""
_STRIDE: Final = 2
"""Each such point of the keyframes is looked at: neighbours say the same."""
_LEARNING: Final = 0.05
"""Share of the newest scan in how well scans usually agree."""
_PACE_FADES: Final = 10.0
"""s; after so long the fastest pace counts a third."""
_DOUBTFUL: Final = 0.85
"""A scan agrees badly that agrees less than by this share of what is usual."""
_STANDS: Final = 0.03
"""m and rad; less than this is no motion of the wheels."""
_BETTER: Final = 1.2
"""Times that a place found must agree better than the one that is thought to be right."""


class FindingBack:
    """Keeps how well scans agree with what was seen before, and how fast the robot drives."""

    def __init__(self) -> None:
        """Begin where nothing was seen."""
        self._usual = self._pace = 0.0
        self._stamp = self._way = 0.0
        self._well_since: float | None = None
        self._well_at = np.zeros(3)
        self._misses = self._doubts = 0

    @property
    def misses(self) -> int:
        """Scans in a row that show enough and confirm nothing."""
        return self._misses

    def begin_again(self) -> None:
        """The map goes on in a piece that the next scan is the first of."""
        self._misses = self._doubts = 0
        self._well_since = None

    def saw(self, stamp: float, follower: ScanFollower, points: int) -> None:
        """Take how well the newest scan of so many points fits, and its stamp, s."""
        self._count(stamp, follower, points)
        elapsed = stamp - self._stamp
        if elapsed > 0.0 and follower.is_sure:
            pace = (follower.way - self._way) / elapsed
            self._pace = max(math.exp(-elapsed / _PACE_FADES) * self._pace, pace)
        self._stamp, self._way = stamp, follower.way

    @property
    def is_due(self) -> bool:
        """Whether the newest scan is to be searched for."""
        count = self._misses or self._doubts
        return 0 < count <= _AT_ONCE or (count > 0 and count % _EVERY == 0)

    def search(
        self, follower: ScanFollower, points: Floats, clouds: list[Floats], surfels: SurfelGrid
    ) -> None:
        """Look for where a scan, points [n, 4], fits on ``clouds``, [m, 4] each, around it.

        They are in the frame of the newest submap, as the surfels are that confirm what is found.
        """
        if not clouds or len(points) < LEAST_POINTS:
            return
        # As seen from where it is thought to be: what is far from there is left out.
        here = follower.here
        seen = np.ascontiguousarray(np.concatenate(clouds)[::_STRIDE, :2] - here[:2])
        if not is_in_reach(seen):
            return
        thought = np.array([0.0, 0.0, here[2]])
        window, turn = self._window(follower)
        found = CorrelativeMatcher(seen).best(points, thought, window, turn, _LIKELIHOOD)
        if found is not None:
            pose = np.array([*(found.pose[:2] + here[:2]), found.pose[2]])
            follower.try_at(pose, points, surfels, _BETTER)
            self._misses *= not follower.is_sure

    def _window(self, follower: ScanFollower) -> tuple[float, float]:
        """Return how far around it may be, m and rad."""
        since = 0.0 if self._well_since is None else self._stamp - self._well_since
        unseen = min(self._pace * max(since, 0.0), _FARTHEST)
        way = _SEARCHED_WAY + _SEARCHED_SHARE * follower.unsure_way + unseen
        turn = _SEARCHED_TURN + _SEARCHED_SHARE * follower.unsure_turn
        return way, min(turn, math.pi)

    def _count(self, stamp: float, follower: ScanFollower, points: int) -> None:
        """Count the scans in a row that confirm nothing, or less than is usual."""
        if not follower.is_sure:
            self._misses += points >= LEAST_POINTS
            return
        self._misses = 0
        agreement = follower.met * follower.close
        reckoned = follower.state["reckoned"][0]
        stands = not is_apart(reckoned, self._well_at, _STANDS, _STANDS)
        if agreement < _DOUBTFUL * self._usual and stands:
            self._doubts += 1
            return
        self._doubts = 0
        self._usual += _LEARNING * (agreement - self._usual)
        self._well_since, self._well_at = stamp, reckoned.copy()
