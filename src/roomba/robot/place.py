"""Where the robot is: a localizer on a known map, or a mapper on the one that it makes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.configuration.robot import RobotConfig, TimingConfig
from roomba.geometry import Pose, Twist
from roomba.perception.calibration.lidar import CorrectedLidar, lidar_correction
from roomba.perception.localization.belief.belief import Rows
from roomba.perception.localization.estimate import Estimate
from roomba.perception.matching.reckoned_path import ReckonedPath
from roomba.perception.matching.scan_view import LidarModel, PlacedScan
from roomba.robot.look_around import SearchDrive
from roomba.robot.readings import Readings, ScanReading


class Place(Protocol):
    """What knows where the robot is: a localizer on its map, or a mapper on the one it makes."""

    belief: Rows
    """What is reckoned by wheels and gyro, BELIEF [1]."""

    numbers: Rows
    """The numbers by which it reckons."""

    path: ReckonedPath
    """The way that it reckoned."""

    placed: PlacedScan | None
    """The newest scan with the pose where it was taken, if that is known."""

    @property
    def estimate(self) -> Estimate:
        """What is known now."""

    @property
    def is_calm(self) -> bool:
        """Whether the place is known and nothing else waits to be done for it."""

    @property
    def sight_to_look_around(self) -> tuple[Pose, Floats] | None:
        """The reckoned pose and what is in sight, if driving a little helps to find the place.

        In sight are the ends of beams, float64 [n, 2 or more], m, robot's frame.
        """

    def look_anew(self) -> None:
        """Give a search for its place its whole time again: the robot begins to look around."""

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air."""

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, at a time, s."""

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Take a scan, float32 [beams], m."""

    def feel(self, radius: float, first: float, last: float) -> None:
        """Take a touch of the robot's round body, of ``radius``, m.

        ``first`` and ``last``, rad, robot's frame, are the bearings between which it was pressed.
        """

    def go_by_lidar(self) -> None:
        """Use the lidar's mounting as it is known better by now; a mapper keeps it as it was."""


class ScanSelection:
    """Selects the scans that are looked at: one each ``scan_period``, not those between.

    ``apart`` is the least time from one selected scan to the next, s: half a tick less than the
    period, as ticks do not fall on scans. ``seen_at`` is when the last one was taken that was
    selected, s.
    """

    def __init__(self, timing: TimingConfig) -> None:
        """Begin with no scan: the first one is selected."""
        self.apart = timing.scan_period - 0.5 * timing.tick
        self.seen_at = -math.inf

    def selects(self, scan: ScanReading | None) -> bool:
        """Whether a scan is to be looked at; call it once for each, in the order of time."""
        if scan is None or 0.0 <= scan.stamp - self.seen_at < self.apart:
            return False
        self.seen_at = scan.stamp
        return True

    def resumed(self, seen_at: float) -> None:
        """Go on after kernels that selected scans, the last one taken at ``seen_at``, s."""
        self.seen_at = seen_at


class PlaceKeeper:
    """Passes readings on: all motion, and the scans that are selected.

    ``place`` may be replaced at any time.
    """

    def __init__(self, place: Place, robot: RobotConfig) -> None:
        """Begin with no scan."""
        self.place = place
        self.scans = ScanSelection(robot.timing)
        self._lidars = CorrectedLidar()
        self._search = SearchDrive(robot.body, robot.looking_around)
        self._body, self._was_touching = robot.body, False

    def follow(self, readings: Readings) -> ScanReading | None:
        """Take the readings of a tick; return the scan that was passed on, if there was one."""
        self.place.lift(readings.is_lifted)
        self.place.move(readings.time, readings.odometry, readings.turning)
        self._feel(readings)
        scan = readings.scan
        if scan is None or not self.scans.selects(scan):
            return None
        self.place.see(scan.stamp, scan.ranges, self.lidar(scan.lidar))
        return self.recalibrated(scan)

    def _feel(self, readings: Readings) -> None:
        """Pass on what the bumper begins to feel: it may be a mirror."""
        is_new, self._was_touching = readings.bumps and not self._was_touching, readings.bumps
        if is_new:
            left, right = readings.bumper_left, readings.bumper_right
            self.place.feel(self._body.radius, *self._body.pressed(left, right))

    def lidar(self, told: LidarModel) -> LidarModel:
        """Return a lidar with its mounting as the robot measured it."""
        self._lidars.correction = lidar_correction(self.place.belief)
        return self._lidars.of(told)

    @property
    def gyro_bias(self) -> float:
        """What is known of the gyro's bias, rad/s."""
        belief = self.place.belief[0]
        return float(belief["bias"] + belief["calibration"]["gyro_bias"])

    def recalibrated(self, scan: ScanReading) -> ScanReading:
        """Use the lidar's mounting as it is known by now; return the scan with that lidar."""
        self.place.go_by_lidar()
        return replace(scan, lidar=self.lidar(scan.lidar))

    def look_around(self, now: float, *, touches: bool) -> Twist | None:
        """Return what is to be driven to find the place; None while that does not help.

        ``now`` is in s of the robot's clock; ``touches`` tells whether bumper or cliff sensors
        found something.
        """
        return self._search.tick(now, self.place, touches)
