"""Following the robot from scan to scan, in the frame of the newest submap."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.slam.follow_kernels import FOLLOWER, follow, moved_since
from roomba.perception.slam.surfels import SurfelGrid

Floats = NDArray[np.float64]

_TAKEN_UP_SPREAD: Final = np.diag([0.1**2, 0.1**2, 0.05**2])
"""m2, rad2; of a pose by the wheels alone, after the mapping process was away."""
_FOUND_SPREAD: Final = np.diag([0.1**2, 0.1**2, 0.05**2])
"""m2, rad2; of a pose that a search found."""


class ScanFollower:
    """Keeps ``here``, float64 [3], the pose at the newest scan; ``way`` is what was driven, m.

    Of that scan ``met`` is the share of points that met a known surface, ``close`` the share of
    those that lie in it. While it ``is_sure`` they confirm the pose, else it goes by the wheels.
    All of it is in ``state``, FOLLOWER [1], that kernels go on with.
    """

    def __init__(self, config: MappingConfig, reckoning: DeadReckoning) -> None:
        """Begin at the origin of the first submap."""
        self._reckoning = reckoning
        self.state = np.zeros(1, FOLLOWER)
        self._row = row = self.state[0]
        row["variance"] = config.point_deviation**2
        row["least_met"], row["least_close"] = config.least_met, config.least_close
        row["odometry_scale"] = 1.0
        self._go_on_from(np.zeros(3))

    @property
    def here(self) -> Floats:
        """A copy, as it is now."""
        here: Floats = self._row["here"].copy()
        return here

    @property
    def way(self) -> float:
        """What was driven, m."""
        return float(self._row["way"])

    @property
    def met(self) -> float:
        """Share of the newest scan's points that met a known surface."""
        return float(self._row["met"])

    @property
    def close(self) -> float:
        """Share of those that lie in it."""
        return float(self._row["close"])

    @property
    def unsure_way(self) -> float:
        """What was driven since a scan confirmed the pose, m."""
        return float(self._row["unsure_way"])

    @property
    def unsure_turn(self) -> float:
        """What was turned since then, rad."""
        return float(self._row["unsure_turn"])

    def use_noise(self, deviation: float) -> None:
        """Go by the standard deviation of a range, m."""
        self._row["range_deviation"] = deviation

    @property
    def is_sure(self) -> bool:
        """Whether the newest scan confirmed the pose."""
        return bool(self._row["is_sure"])

    def since(self, then: Pose) -> Pose:
        """Return where the robot is now, by the wheels, that was there at the newest scan."""
        moved = moved_since(self.state, self._reckoning.belief, then.x, then.y, then.theta)
        return Pose(*moved)

    def restart(self) -> None:
        """Go on at the origin of another submap."""
        self._row["here"] = 0.0

    def jump(self) -> None:
        """Go on at the origin of another submap, where the robot was put down."""
        self._go_on_from(np.zeros(3))

    def take_up(self, here: Floats, way: float) -> None:
        """Go on about ``here``, [3], after what another process did; ``way`` was driven by then."""
        self._go_on_from(here)
        self._row["way"], self._row["spread"] = way, _TAKEN_UP_SPREAD

    def follow(self, reckoned: Pose, points: Floats, surfels: SurfelGrid) -> None:
        """Move on to ``reckoned``, and correct that by a scan, points [n, 4] seen from there."""
        at = np.array([reckoned.x, reckoned.y, reckoned.theta])
        follow(self.state, self._reckoning.belief, at, surfels.arrays, points, len(points))

    @property
    def misses(self) -> int:
        """Scans since one confirmed the pose."""
        return int(self._row["misses"])

    def try_at(
        self, pose: Floats, points: Floats, surfels: SurfelGrid, better: float = 1.0
    ) -> None:
        """Be at ``pose`` [3] if a scan, points [n, 4], confirms it; else stay where it was.

        Where a scan confirms both, it must agree ``better`` times as well with ``pose``.
        """
        before = self.state.copy()
        least = better * self.met * self.close if self.is_sure else 0.0
        self._row["here"], self._row["spread"] = pose, _FOUND_SPREAD
        reckoned = self._row["reckoned"].copy()
        follow(self.state, self._reckoning.belief, reckoned, surfels.arrays, points, len(points))
        if not self.is_sure or self.met * self.close < least:
            self.state[:] = before

    def _go_on_from(self, here: Floats) -> None:
        self._row["here"], self._row["spread"] = here, 0.0
        self._row["unsure_way"] = self._row["unsure_turn"] = 0.0
        reckoned = self._reckoning.pose
        self._row["reckoned"] = reckoned.x, reckoned.y, reckoned.theta
