"""Where the robot is: a localizer on a known map, or a mapper on the one that it makes."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.robot import TimingConfig
from roomba.geometry import Pose
from roomba.perception.localization.estimate import Estimate
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.readings import Readings, ScanReading


class Place(Protocol):
    """What knows where the robot is: a localizer on its map, or a mapper on the one it makes."""

    belief: NDArray[np.void]
    """What is reckoned by wheels and gyro, BELIEF [1]."""

    @property
    def estimate(self) -> Estimate:
        """What is known now."""

    @property
    def is_calm(self) -> bool:
        """Whether the place is known and nothing else waits to be done for it."""

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air."""

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, at a time, s."""

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Take a scan, float32 [beams], m."""


class PlaceKeeper:
    """Passes readings on: all motion, and a scan in each ``scan_period``.

    ``seen_at`` is the stamp of the last scan that was passed on, s.
    """

    def __init__(self, place: Place, timing: TimingConfig) -> None:
        """Begin with no scan."""
        self.place = place
        self.apart = least_apart(timing)
        self.seen_at = -math.inf

    def follow(self, readings: Readings) -> ScanReading | None:
        """Take the readings of a tick; return the scan that was passed on, if there was one."""
        self.place.lift(readings.is_lifted)
        self.place.move(readings.time, readings.odometry, readings.turning)
        scan = readings.scan
        if scan is None or 0.0 <= scan.stamp - self.seen_at < self.apart:
            return None
        self.seen_at = scan.stamp
        self.place.see(scan.stamp, scan.ranges, scan.lidar)
        return scan


def least_apart(timing: TimingConfig) -> float:
    """Return how long after a scan the next one is looked at, s: ticks do not fall on scans."""
    return timing.scan_period - 0.5 * timing.tick
