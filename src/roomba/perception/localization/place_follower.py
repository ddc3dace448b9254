"""The robot's place on a map, followed while it is known.

Dead reckoning carries the pose from scan to scan, and each scan corrects the pose by the map.
Meanwhile the follower learns how late scans are, and where the map's walls really stand.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.sensors import GyroConfig
from roomba.geometry import Pose, wrap_angle
from roomba.grid import OccupancyMap
from roomba.perception.calibration.kernels import apply_lidar
from roomba.perception.calibration.latency import learn_latency, no_latency
from roomba.perception.calibration.lidar import lidar_correction
from roomba.perception.localization.belief.belief import Rows, numbers_of, unknown_belief
from roomba.perception.localization.belief.correct_kernels import calibrate, deviation
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.localization.learned_walls import LearnedWalls
from roomba.perception.localization.tracker import Tracker
from roomba.perception.matching.pose_kernels import pose_then
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField


class PlaceFollower:
    """Keeps ``belief``, one row: the pose, how unsure it is, and what was learned on the way.

    ``reckoning`` tells how the robot moved, ``field`` and ``walls`` are those of the map, and
    ``numbers`` the parameters of the kernels. ``reckoned`` poses are those of DeadReckoning.
    """

    def __init__(
        self,
        occupancy: OccupancyMap | None,
        config: LocalizationConfig,
        gyro: GyroConfig,
        stride: int,
    ) -> None:
        """Begin at the map's origin; call :meth:`begin_at` to tell where the robot really is.

        Every ``stride``-th scan of the lidar is shown.
        """
        self.belief: Rows = unknown_belief()
        self.row, self.numbers = self.belief[0], numbers_of(config, gyro, stride)
        self.reckoning = DeadReckoning(config, gyro, self.belief)
        self._config = config
        self._latency = no_latency()
        self.use(occupancy)
        self.begin_at(Pose(0.0, 0.0, 0.0), np.zeros((3, 3)))

    def use(self, occupancy: OccupancyMap | None) -> None:
        """Go on with another map, of which no wall is learned yet; None: there is no map."""
        self.field = SurfaceField.of(occupancy) if occupancy else SurfaceField.unknown()
        self.walls = LearnedWalls(self.field, self.belief)

    def begin_at(self, pose: Pose, covariance: NDArray[np.float64]) -> None:
        """Go on at another pose of the map, with a covariance, float64 [3, 3], m2 and rad2."""
        self.forget_heading()
        self.tracker = Tracker(self.field, pose, covariance, self.belief, self.numbers)

    def forget_heading(self) -> None:
        """Learn no latency from the next scan's turn, as the pose was changed by other means."""
        self._heading = math.nan

    @property
    def latency(self) -> float:
        """How late scans are against odometry, s, as learned so far."""
        return float(self._latency[0]["seconds"])

    @property
    def position_deviation(self) -> float:
        """How unsure the position is, m, along the axis where it is least sure."""
        return deviation(self.row["covariance"])

    @property
    def heading_deviation(self) -> float:
        """How unsure the heading is, rad."""
        return math.sqrt(self.tracker.covariance[2, 2])

    def pose_then(self, reckoned: Pose) -> Pose:
        """Return where the robot was on the map when dead reckoning had it at ``reckoned``.

        The result is that of compiled code, to the last bit.
        """
        here, then = self.tracker.pose.as_array(), reckoned.as_array()
        return Pose(*pose_then(here, self.row["reckoned"], then))

    def correct(
        self, view: ScanView, stamp: float, reckoned: Pose, *, tells_places_apart: bool
    ) -> Fit | None:
        """Correct the pose by a scan that was taken at ``reckoned``, perhaps a little ago.

        ``stamp`` is when that was, s. Return how well the scan fits, None if it does not tell.
        """
        is_late = not self.reckoning.is_newest(stamp)
        if is_late:
            self.tracker.pose = self.pose_then(reckoned)
        self.tracker.see(view)
        fit = self.tracker.judge(view) if tells_places_apart else None
        tells_turn = fit is not None and not self.tracker.is_doubtful
        self._compare_turns(stamp, self.tracker.pose.theta if tells_turn else math.nan)
        self.walls.learn()
        if is_late:
            self.tracker.pose = self._pose_since(reckoned)
        calibrate(self.belief)
        return fit

    def go_by_lidar(self) -> None:
        """Apply the lidar's measured mount, if it is known better by now; call this between scans.

        Points that were seen stay where they are on the map: the pose of the robot's body moves.
        """
        if not self.row["calibration"]["is_lidar_due"]:
            return
        before = lidar_correction(self.belief)
        apply_lidar(self.row["calibration"])
        by = before.compose(lidar_correction(self.belief).inverse())
        self.tracker.pose = self.tracker.pose.compose(by)
        self.forget_heading()

    def _pose_since(self, reckoned: Pose) -> Pose:
        """Return where the robot is now, if it was at the tracker's pose at ``reckoned``."""
        here, then = self.tracker.pose.as_array(), reckoned.as_array()
        return Pose(*pose_then(here, then, self.row["reckoned"]))

    def _compare_turns(self, stamp: float, heading: float) -> None:
        """Learn how late scans are from the turn since the scan before, if both fit the map.

        ``heading`` is how the robot was turned, rad, map frame; nan if the scan does not tell.
        """
        came = stamp + self.latency
        turn = wrap_angle(heading - self._heading)
        learn_latency(self._latency, turn, came, self.reckoning.path)
        self._heading = heading
