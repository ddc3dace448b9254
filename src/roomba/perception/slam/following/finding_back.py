"""The search for the robot when scans no longer fit: when it is due, how wide, and its result.

Scans may no longer fit because dead reckoning is wrong (wheels that slip, odometry that stands
still or leaps), because the robot was moved, or because the surroundings are new.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.mapping import MappingConfig
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.slam.following.finding_back_kernels import FINDING, is_due
from roomba.perception.slam.following.scan_follower import ScanFollower
from roomba.perception.slam.scan_matching.correlative import CorrelativeMatcher, is_in_reach

_STRIDE: Final = 2
"""Stride over the points of keyframes: neighbours say the same."""


class FindingBack:
    """Keeps how well scans agree with what was seen before, and how fast the robot drives.

    Its state is in ``state``, FINDING [1], with which kernels may go on.
    """

    def __init__(self, config: MappingConfig) -> None:
        """Begin with nothing seen."""
        self._config, self._reach = config.following, config.search_reach
        self.state = np.zeros(1, FINDING)
        self._row = self.state[0]
        self._row["doubtful"] = self._config.doubtful
        self._row["pace_fades"] = self._config.pace_fades
        self._row["far_apart"] = self._config.far_apart
        self._row["well_since"] = np.nan

    def begin_again(self) -> None:
        """Begin anew, as the map goes on in a new piece that begins with the next scan."""
        self._row["misses"] = self._row["doubts"] = 0
        self._row["well_since"] = np.nan

    @property
    def is_due(self) -> bool:
        """Whether to search for where the newest scan fits."""
        return bool(is_due(self.state))

    @property
    def shows_carried(self) -> bool:
        """Whether scans no longer fitted from one to the next, though the wheels hardly moved."""
        row, config = self._row, self._config
        hardly_drove = row["lost_way"] < config.carried_way
        return bool(hardly_drove and row["lost_turn"] < config.carried_turn)

    def is_without_hold(self, follower: ScanFollower) -> bool:
        """Whether scans have failed to fit for so long that the map must go on in a new piece.

        The new piece begins at the dead-reckoned pose.
        """
        config = self._config
        is_searched = self._row["misses"] >= config.given_up_after
        if not is_searched or not follower.shows_enough:
            return False
        return follower.unsure_way > config.piece_way or follower.unsure_turn > config.piece_turn

    def search(self, follower: ScanFollower, clouds: list[Floats]) -> bool:
        """Search around the robot for where the newest scan fits on ``clouds``, [m, 4] each.

        The clouds are in the frame of the newest submap, and so are the surfels that confirm a
        match. Returns whether the match is farther off than wheels slip, so that this one scan may
        be wrong.
        """
        points, config = follower.points, self._config
        if not clouds or not follower.shows_enough:
            return False
        # Relative to where the robot is thought to be: the matcher drops points far from there.
        here = follower.here
        seen = np.concatenate(clouds)[::_STRIDE] - (here[0], here[1], 0.0, 0.0)
        if not is_in_reach(seen, self._reach):
            return False
        thought = np.array([0.0, 0.0, here[2]])
        way, turn = self._slip(follower)
        matcher = CorrelativeMatcher(seen, self._reach)
        window = way + self._unseen(follower)
        found = matcher.best(points, thought, window, turn, config.likelihood)
        if found is None and self._is_far_apart(follower):
            found = matcher.best(points, thought, way / 2, turn / 2, config.likelihood_apart)
        if found is None:
            return False
        share = config.searched_share
        far = config.leap_way + share * follower.unsure_way
        far_turn = config.leap_turn + share * follower.unsure_turn
        pose = np.array([*(found.pose[:2] + here[:2]), found.pose[2]])
        follower.try_at(pose, config.better)
        self._row["misses"] *= not follower.is_sure
        return bool(is_apart(follower.here, here, far, far_turn))

    def _is_far_apart(self, follower: ScanFollower) -> bool:
        """Whether scans are so far apart on the way that each shows much that none before showed.

        Then even the right pose has a low likelihood, and is only accepted near the expected one.
        """
        misses = max(int(self._row["misses"]), 1)
        return follower.unsure_way >= self._config.far_apart * misses

    def _slip(self, follower: ScanFollower) -> tuple[float, float]:
        """Return how far wheels that slip may have been off, m and rad."""
        config = self._config
        way = config.searched_way + config.searched_share * follower.unsure_way
        turn = config.searched_turn + config.searched_share * follower.unsure_turn
        return way, min(turn, math.pi)

    def _unseen(self, follower: ScanFollower) -> float:
        """Return how far the robot may have driven, m, while odometry stood still."""
        row = self._row
        since = float(row["stamp"] - row["well_since"])
        driven = float(row["pace"]) * since if since > 0.0 else 0.0
        return min(max(driven - follower.unsure_way, 0.0), self._config.searched_farthest)
