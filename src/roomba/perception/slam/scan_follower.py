"""Following the robot from scan to scan, in the frame of the newest submap."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose, wrap_angle
from roomba.perception.dead_reckoning import DeadReckoning
from roomba.perception.slam.mapping_config import MappingConfig
from roomba.perception.slam.surfels import Match, SurfelGrid

Floats = NDArray[np.float64]

_SCALES: Final = np.array([0.1, 0.05, 0.03])
"""m; of the rounds of a match."""
_ROUNDS: Final = 6
_STRIDE: Final = 2
"""Each such point follows the robot; keyframes have all of them."""
_FAR_REACH: Final = 3
"""Cells of surfels; so far a scan is matched after some that met nothing."""
_MANY: Final = 5
LEAST_POINTS: Final = 30
"""Fewer say nothing."""
_LEAST_SPREAD: Final = np.diag([0.001**2, 0.001**2, 0.0005**2])
"""m2, rad2; no prior is surer, be the robot standing or not."""


class ScanFollower:
    """Keeps ``here``, float64 [3], the pose at the newest scan; ``way`` is what was driven, m.

    Of that scan ``met`` is the share of points that met a known surface, ``close`` the share of
    those that lie in it. While it ``is_sure`` they confirm the pose, else it goes by the wheels.
    """

    def __init__(self, config: MappingConfig, reckoning: DeadReckoning) -> None:
        """Begin at the origin of the first submap."""
        self._config, self._reckoning = config, reckoning
        self._reckoned = reckoning.pose
        self._spread = np.zeros((3, 3))
        self._misses = 0
        self.here = np.zeros(3)
        self.way = self.met = self.close = 0.0
        self.is_sure = False

    @property
    def since(self) -> Pose:
        """Where the robot is now, by the wheels, seen from where it was at the newest scan."""
        return self._reckoned.inverse().compose(self._reckoning.pose)

    def restart(self) -> None:
        """Go on at the origin of another submap."""
        self.here = np.zeros(3)

    def jump(self) -> None:
        """Go on at the origin of another submap, where somebody put the robot down."""
        self.restart()
        self._reckoned = self._reckoning.pose
        self._spread[:] = 0.0

    def follow(self, reckoned: Pose, points: Floats, surfels: SurfelGrid) -> None:
        """Move on to ``reckoned``, and correct that by a scan, points [n, 4] seen from there."""
        moved_by = self._reckoned.inverse().compose(reckoned)
        self._reckoned = reckoned
        self.way += math.hypot(moved_by.x, moved_by.y)
        prior = Pose(*self.here.tolist()).compose(moved_by)
        self.here = np.array([prior.x, prior.y, prior.theta])
        self._spread += self._new_spread(prior.theta)
        match = self._match(points, surfels)
        self.is_sure = match is not None and self._is_good(match)
        self.met, self.close = (0.0, 0.0) if match is None else (match.met, match.close)
        if match is None or not self.is_sure:
            self._misses += 1
            return
        self.here = match.pose
        self.here[2] = wrap_angle(float(self.here[2]))
        self._spread[:] = 0.0
        self._misses = 0

    def _match(self, points: Floats, surfels: SurfelGrid) -> Match | None:
        match = surfels.match(
            points,
            self.here,
            self._spread + _LEAST_SPREAD,
            _SCALES,
            self._config.point_deviation,
            rounds=_ROUNDS,
            reach=_FAR_REACH if self._misses >= _MANY else 1,
            stride=_STRIDE,
        )
        return None if match is None or match.asked < LEAST_POINTS else match

    def _is_good(self, match: Match) -> bool:
        return match.met >= self._config.least_met and match.close >= self._config.least_close

    def _new_spread(self, heading: float) -> Floats:
        """Return what dead reckoning became unsure by since the last scan, [3, 3], submap frame."""
        cosine, sine = math.cos(heading), math.sin(heading)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        spread: Floats = turn @ self._reckoning.take_spread() @ turn.T
        return spread
