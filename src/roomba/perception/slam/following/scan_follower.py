"""Following the robot from scan to scan, in the frame of the newest submap."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.configuration.mapping import FollowingConfig, MappingConfig
from roomba.geometry import Pose
from roomba.perception.calibration.latency import no_latency
from roomba.perception.localization.belief.belief import Rows
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.range_noise import unknown_noise
from roomba.perception.matching.reckoned_path import pose_at
from roomba.perception.matching.sweep import SWEEP_WORK
from roomba.perception.slam.following.follow_kernels import FOLLOWER, follow, moved_since
from roomba.perception.slam.following.scan_kernels import (
    Following,
    compare_turns,
    follow_points,
    is_apart_from_keyframe,
    see_points,
)
from roomba.perception.slam.scan_matching.surface_kernels import POINT, room_for_sums
from roomba.perception.slam.scan_matching.surfels import SurfelGrid

_TAKEN_UP_SPREAD: Final = np.diag([0.1**2, 0.1**2, 0.05**2])
"""m2, rad2; covariance of a pose by the wheels alone, after a restart of the mapping process."""
_FOUND_SPREAD: Final = np.diag([0.1**2, 0.1**2, 0.05**2])
"""m2, rad2; covariance of a pose that a search found."""


class ScanFollower:
    """Keeps ``here``, float64 [3], the pose at the newest scan; ``way`` is what was driven, m.

    ``met`` is the share of that scan's points that met a known surface, ``close`` the share of
    these that lie in its plane. While the follower ``is_sure`` scans confirm the pose, otherwise it
    goes by the wheels. Its state is in ``state``, FOLLOWER [1], with which kernels may go on. Call
    :meth:`use` with the lidar before a scan is followed.
    """

    def __init__(self, config: MappingConfig, reckoning: DeadReckoning, finding: Rows) -> None:
        """Begin at the origin of the first submap; ``finding``, FINDING [1], notes scans' fits."""
        self._reckoning, self._finding = reckoning, finding
        self.state = np.zeros(1, FOLLOWER)
        self._noise, self._latency = unknown_noise(), no_latency()
        self._late: Rows | None = None
        """The latency learned before, kept while dead reckoning is guessed; else None."""
        self._row = row = self.state[0]
        row["variance"] = config.point_deviation**2
        self._config = config.following
        row["least_points"] = config.following.least_points
        self._use_standing(config.following)
        row["many_misses"] = config.following.many_misses
        row["least_met"], row["least_close"] = config.least_met, config.least_close
        row["keyframe_way"], row["keyframe_turn"] = config.keyframe_way, config.keyframe_turn
        row["odometry_scale"] = 1.0
        self._learned: Floats = row["odometry_scale"].copy()
        row["range_deviation"] = self.range_noise
        self._go_on_from(np.zeros(3))

    def use(self, beams: LidarBeams, surfels: SurfelGrid) -> None:
        """Follow the scans of a lidar, by what ``surfels`` shows."""
        count = len(beams.directions)
        self._row["least_points"] = least_points(count, self._config)
        self.following = Following(
            self.state,
            self._reckoning.belief,
            self._reckoning.path,
            self._noise,
            self._latency,
            self._finding,
            surfels.arrays,
            beams,
            np.empty((count, POINT)),
            room_for_sums(count),
            np.empty(count, np.float32),
            np.empty((SWEEP_WORK, count)),
        )

    def begin_guessing(self, config: FollowingConfig) -> None:
        """Go on with guessed dead reckoning, of which nothing was learned yet.

        It is guessed from the scans, so that scans are not late against it.
        """
        self._late = self._latency.copy()
        self._latency[:] = no_latency()
        self._learned = self._row["odometry_scale"].copy()
        self._row["odometry_scale"] = 1.0
        self._use_standing(config)

    def end_guessing(self, config: FollowingConfig) -> None:
        """Go on with dead reckoning as it was known before."""
        if self._late is not None:
            self._latency[:] = self._late
            self._latency["before"], self._late = np.nan, None
        self._row["odometry_scale"] = self._learned
        self._use_standing(config)

    def find_reckoned(self, stamp: float) -> bool:
        """Look up where dead reckoning had the robot at a scan, and tell whether that is known."""
        return pose_at(self._reckoning.path, stamp - self.latency, self._row["scanned_at"])

    def see(self, stamp: float, ranges: NDArray[np.float32]) -> Floats:
        """Find the points, float64 [n, 4], that a scan shows, float32 [beams], m."""
        see_points(self.following, stamp, ranges)
        return self.points

    @property
    def points(self) -> Floats:
        """What the newest scan shows, float64 [n, 4], robot's frame."""
        return self.following.points[: int(self._row["points"])]

    def follow(self, stamp: float) -> None:
        """Move on to where dead reckoning had the robot at a scan, and correct that by the scan."""
        follow_points(self.following, stamp)

    def compare_turns(self, stamp: float) -> None:
        """Learn how late scans are, if the newest two confirmed where the robot was."""
        if self._late is None:
            compare_turns(self.following, stamp)

    @property
    def range_noise(self) -> float:
        """Standard deviation of the lidar's ranges, m, as measured so far."""
        return float(self._noise[0]["deviation"])

    @property
    def latency(self) -> float:
        """How late scans are against odometry, s, as learned so far."""
        return float(self._latency[0]["seconds"])

    @property
    def here(self) -> Floats:
        """A copy of the pose at the newest scan, float64 [3], newest submap's frame."""
        here: Floats = self._row["here"].copy()
        return here

    @property
    def way(self) -> float:
        """What was driven, m."""
        return float(self._row["way"])

    @property
    def pace(self) -> Floats:
        """The robot's pace between the newest two scans: ahead, aside, m/s, turning, rad/s."""
        pace: Floats = self._row["pace"].copy()
        return pace

    @property
    def met(self) -> float:
        """Share of the newest scan's points that met a known surface."""
        return float(self._row["met"])

    @property
    def close(self) -> float:
        """Share of these that lie in the surface's plane."""
        return float(self._row["close"])

    @property
    def unsure_way(self) -> float:
        """What was driven since a scan confirmed the pose, m."""
        return float(self._row["unsure_way"])

    @property
    def unsure_turn(self) -> float:
        """What was turned since a scan confirmed the pose, rad."""
        return float(self._row["unsure_turn"])

    @property
    def shows_enough(self) -> bool:
        """Whether the newest scan has enough points to count."""
        return bool(self._row["points"] >= self._row["least_points"])

    @property
    def is_sure(self) -> bool:
        """Whether the newest scan confirmed the pose."""
        return bool(self._row["is_sure"])

    def since(self, then: Pose) -> Pose:
        """Return where the robot is now by the wheels, if it was at ``then`` at the newest scan."""
        moved = moved_since(self.state, self._reckoning.belief, then.x, then.y, then.theta)
        return Pose(*moved)

    def restart(self) -> None:
        """Go on at the origin of another submap."""
        self._row["here"] = 0.0
        self._drop_window()

    def begin_piece(self) -> None:
        """Go on at the origin of another submap, which lies where the newest scan was taken."""
        self.restart()
        self._row["spread"] = 0.0
        self._row["unsure_way"] = self._row["unsure_turn"] = 0.0

    def jump(self) -> None:
        """Go on at the origin of another submap, where the robot was put down."""
        self._go_on_from(np.zeros(3))

    def take_up(self, here: Floats, way: float) -> None:
        """Go on about ``here``, [3], where another process stopped after ``way``, m, in all."""
        self._go_on_from(here)
        self._row["way"], self._row["spread"] = way, _TAKEN_UP_SPREAD

    def keep(self) -> None:
        """Note that the newest scan is kept as a keyframe."""
        self.keep_at(self._row["here"])

    def keep_at(self, pose: Floats) -> None:
        """Note that the newest keyframe was taken at ``pose`` [3], newest submap's frame."""
        self._row["keyframe"] = pose

    @property
    def is_apart(self) -> bool:
        """Whether the newest scan was taken so far from the newest keyframe as to be kept."""
        return bool(is_apart_from_keyframe(self.state))

    @property
    def misses(self) -> int:
        """Scans since the last one that confirmed the pose."""
        return int(self._row["misses"])

    def try_at(self, pose: Floats, better: float = 1.0) -> None:
        """Move the estimate to ``pose`` [3] if the newest scan confirms it; else leave it.

        Where the scan confirms both, it must agree ``better`` times as well with ``pose``.
        """
        before, parts = self.state.copy(), self.following
        self._drop_window()
        least = better * self.met * self.close if self.is_sure else 0.0
        self._row["here"], self._row["spread"] = pose, _FOUND_SPREAD
        reckoned, points = self._row["reckoned"].copy(), self._row["points"]
        follow(self.state, parts.belief, reckoned, parts.surfels, parts.points, points, 0.0, 0.0)
        if not self.is_sure or self.met * self.close < least:
            self.state[:] = before

    def _drop_window(self) -> None:
        """Drop the window of the calibration, as poses are in another frame from now on."""
        self._reckoning.belief[0]["calibration"]["is_open"] = False

    def _use_standing(self, config: FollowingConfig) -> None:
        """Set the variances of a step that dead reckoning reports as 0."""
        way, turn = config.standing_deviation**2, config.standing_heading**2
        self._row["standing"] = way, way, turn

    def _go_on_from(self, here: Floats) -> None:
        self.begin_piece()
        self._row["here"] = here
        reckoned = self._reckoning.pose
        self._row["reckoned"] = reckoned.x, reckoned.y, reckoned.theta


def least_points(beams: int, config: FollowingConfig) -> int:
    """Return how many points a scan of ``beams`` beams must have to count."""
    return min(config.least_points, max(config.fewest_points, beams // 4))
