"""Replay of a recorded drive through the localizer."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import Final

from roomba.commands.map.drive.replay import guessed
from roomba.commands.map.drive.whole_odometry import WholeOdometry
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.estimate import Estimate
from roomba.perception.localization.localizer import Localizer
from roomba.recordings.drives.turning import NewestTurning
from roomba.recordings.readings import (
    LidarScan,
    Lifted,
    Reading,
    ToldPose,
    Turning,
)
from roomba.recordings.times.waiting import StampedScan, WaitingScan

_ROW_PERIOD: Final = 0.045
"""s between two rows: a bit less than between two poses of the live node, as clocks jitter."""
_SILENCE: Final = 0.25
"""s without odometry after which the stamps of other messages show that time passes."""
_LATEST: Final = 1.0
"""s; a scan that is newer than all odometry by more is left out: its pose is unknown."""
_GIVEN_DEVIATION: Final = (0.1, 0.1)
"""m, rad; deviations of a start that was typed."""


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """What was known at a moment: ``stamp`` and ``arrival`` are those of the recording, s.

    ``elapsed`` is the recording's time that has passed, s; ``way`` the distance travelled, m.
    ``map_to_odometry`` is the pose of the recorded odometry's frame in the map. ``scan_stamp`` is
    this moment in the stamps of scans, which may be late: a scan with this stamp was taken at this
    pose. Maps of a drive have their places by the stamps of scans, too.
    """

    stamp: float
    scan_stamp: float
    arrival: float
    elapsed: float
    way: float
    estimate: Estimate
    map_to_odometry: Pose


class Replay:
    """Feeds a localizer; ``notes`` says what was left out, and why."""

    def __init__(
        self,
        occupancy: OccupancyMap,
        config: RobotConfig,
        odometry: WholeOdometry,
        start: Pose | None,
    ) -> None:
        """Begin at ``start``, map frame; without one the whole map is searched."""
        self.scans = 0
        """Number of scans that were used."""
        self.was_told = False
        """Whether the drive begins at a recorded pose."""
        self._map, self._config, self._odometry = occupancy, config, odometry
        self._begin, self._deviation = start, _GIVEN_DEVIATION
        self._localizer: Localizer | None = None
        self._is_guessing = False
        self._turning = NewestTurning()
        self._waiting = WaitingScan()
        self._left_out: Counter[str] = Counter()
        self._stamp = self._scan_stamp = self._told_row = -math.inf
        self._elapsed = self._way = 0.0
        self._reckoned = Pose()

    @property
    def notes(self) -> list[str]:
        """What was left out."""
        return [f"{count} {what}: left out" for what, count in self._left_out.items()]

    def hear(self, reading: Reading) -> Row | None:
        """Take a reading, in the order of time; return a row if one is due."""
        stamp, value, _ = reading
        odometry = self._odometry.hear(reading)
        if odometry is not None:
            self._hear_odometry(stamp, odometry)
        if isinstance(value, Turning):
            self._turning.hear(stamp, value.speed)
        elif isinstance(value, LidarScan):
            self._hear_scan(StampedScan(stamp, value.ranges, value.lidar))
        elif isinstance(value, Lifted) and self._localizer is not None:
            self._localizer.lift(value.is_lifted)
        elif isinstance(value, ToldPose):
            self._hear_told(value)
        return self._row(reading, is_moved=odometry is not None)

    def _hear_odometry(self, stamp: float, pose: Pose) -> None:
        if self._localizer is None:
            self._localizer = self._begun(stamp, pose)
        self._stamp = stamp
        self._trust(self._localizer)
        self._localizer.move(stamp, pose, self._turning.at(stamp))
        step = self._reckoned.inverse().compose(self._localizer.reckoned)
        self._reckoned = self._localizer.reckoned
        self._way += math.hypot(step.x, step.y)
        self._see(self._localizer, self._waiting.ready(stamp))

    def _trust(self, localizer: Localizer) -> None:
        """Trust steps of scans less than wheels: along a bare corridor they are guesses."""
        if self._odometry.is_guessed == self._is_guessing:
            return
        self._is_guessing, config = self._odometry.is_guessed, self._config.localization
        if self._is_guessing:
            localizer.reckoning.begin_guessing(guessed(config))
        else:
            localizer.reckoning.end_guessing(config)

    def _begun(self, stamp: float, odometry: Pose) -> Localizer:
        config = self._config
        localizer = Localizer(
            self._map,
            config.localization,
            config.gyro,
            config.body.radius,
            self._begin or Pose(),
            self._deviation,
        )
        if self._begin is None:
            localizer.move(stamp, odometry)
            localizer.forget("no start was given")
        return localizer

    def _hear_scan(self, scan: StampedScan) -> None:
        """Keep a scan until odometry has reached its last beam, or the next scan comes."""
        if self._localizer is not None:
            self._see(self._localizer, self._waiting.put(scan))
            self._see(self._localizer, self._waiting.ready(self._stamp))

    def _see(self, localizer: Localizer, scan: StampedScan | None) -> None:
        if scan is None:
            return
        if scan.stamp > self._stamp + _LATEST:
            self._left_out["scans of times without odometry"] += 1
            return
        localizer.see(*scan)
        self.scans += 1

    def _hear_told(self, told: ToldPose) -> None:
        """Begin anew at the first recorded pose that a person or the robot itself set."""
        if self._begin is not None:
            return
        self._begin, self._deviation = told
        self.was_told = True
        if self._localizer is not None:
            self._localizer.told(self._begin, self._deviation)

    def _row(self, reading: Reading, *, is_moved: bool) -> Row | None:
        localizer = self._localizer
        if localizer is None:
            return None
        period = _ROW_PERIOD if is_moved else _SILENCE
        passed = reading.stamp - self._told_row
        if passed < period:
            return None
        if math.isfinite(passed):
            self._elapsed += passed
        self._told_row = reading.stamp
        localizer.pass_time(reading.stamp)
        # The time never goes back, even if scans turn out to be less late.
        self._scan_stamp = max(self._scan_stamp, reading.stamp + localizer.latency)
        return Row(
            reading.stamp,
            self._scan_stamp,
            reading.arrival,
            self._elapsed,
            self._way,
            localizer.estimate,
            localizer.map_to_odometry.compose(self._odometry.frame),
        )
