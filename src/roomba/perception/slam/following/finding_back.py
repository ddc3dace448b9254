"""When scans stop to fit: how far around the robot is looked for then, and where it is found.

Scans may stop to fit because dead reckoning is wrong (wheels that slip, odometry that stands still
or leaps), because the robot was moved, or because what is in sight is new.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.perception.slam.following.finding_back_kernels import FINDING, is_due
from roomba.perception.slam.following.follow_kernels import LEAST_POINTS
from roomba.perception.slam.following.scan_follower import ScanFollower
from roomba.perception.slam.scan_matching.correlative import CorrelativeMatcher, is_in_reach

Floats = NDArray[np.float64]

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
_GIVEN_UP_AFTER: Final = 7
"""Scans that show enough and confirm nothing, searched for twice."""
_PIECE_WAY: Final = 0.6
_PIECE_TURN: Final = 2.0
"""m, rad; driven and turned without a scan that confirms the pose: then the map goes on in a piece
of its own, which is joined when it is known how."""
_BETTER: Final = 1.2
"""Times that a place found must agree better than the one that is thought to be right."""


class FindingBack:
    """Keeps how well scans agree with what was seen before, and how fast the robot drives.

    All of it is in ``state``, FINDING [1], that kernels go on with.
    """

    def __init__(self) -> None:
        """Begin where nothing was seen."""
        self.state = np.zeros(1, FINDING)
        self._row = self.state[0]
        self._row["well_since"] = np.nan

    def begin_again(self) -> None:
        """The map goes on in a piece that the next scan is the first of."""
        self._row["misses"] = self._row["doubts"] = 0
        self._row["well_since"] = np.nan

    @property
    def is_due(self) -> bool:
        """Whether the newest scan is to be searched for."""
        return bool(is_due(self.state))

    def is_without_hold(self, follower: ScanFollower) -> bool:
        """Whether it has gone on for so long unconfirmed that the map must come to where it is."""
        if self._row["misses"] < _GIVEN_UP_AFTER or len(follower.points) < LEAST_POINTS:
            return False
        return follower.unsure_way > _PIECE_WAY or follower.unsure_turn > _PIECE_TURN

    def search(self, follower: ScanFollower, clouds: list[Floats]) -> None:
        """Look for where the newest scan fits on ``clouds``, [m, 4] each, around it.

        They are in the frame of the newest submap, as the surfels are that confirm what is found.
        """
        points = follower.points
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
            follower.try_at(pose, _BETTER)
            self._row["misses"] *= not follower.is_sure

    def _window(self, follower: ScanFollower) -> tuple[float, float]:
        """Return how far around it may be, m and rad."""
        row = self._row
        since = row["stamp"] - row["well_since"]
        unseen = min(float(row["pace"]) * float(since if since > 0.0 else 0.0), _FARTHEST)
        way = _SEARCHED_WAY + _SEARCHED_SHARE * follower.unsure_way + unseen
        turn = _SEARCHED_TURN + _SEARCHED_SHARE * follower.unsure_turn
        return way, min(turn, math.pi)
