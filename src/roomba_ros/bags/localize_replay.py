"""Replay of a recorded drive through the localizer."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.estimate import Estimate
from roomba.perception.localization.localizer import Localizer
from roomba.recordings.waiting import StampedScan, WaitingScan
from roomba_ros.bags.localize_recording import Heard, MessageKind
from roomba_ros.bags.recorded_sensors import RecordedSensors
from roomba_ros.convert.common import pose_of_odometry
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.localization import told_pose_of
from roomba_ros.convert.mounts import Mounts

_ROW_PERIOD: Final = 0.045
"""s; as often as the live node tells its pose, with something left for clocks that tremble."""
_SILENCE: Final = 0.25
"""s; without odometry for so long the other messages tell that time passes."""
_LATEST: Final = 1.0
"""s; a scan that odometry is so far behind is of a time that it knows nothing of."""
_GIVEN_DEVIATION: Final = (0.1, 0.1)
"""m, rad; deviations of a start that was typed."""


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """What was known at a moment: ``stamp`` and ``arrival`` are those of the recording, s.

    ``elapsed`` is the time of the recording that has passed, s: it only grows. ``way`` is what was
    travelled, m.
    """

    stamp: float
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
        mounts: Mounts,
        base: str,
        start: Pose | None,
    ) -> None:
        """Begin at ``start``, map frame; without one the whole map is searched.

        ``base`` is the frame of the robot's body, to which ``mounts`` lead.
        """
        self.scans = 0
        """Scans that were taken in."""
        self.start = "given" if start is not None else "searched for in the whole map"
        self.was_told = False
        """Whether it begins at a pose that was recorded."""
        self._sensors = RecordedSensors(mounts, base)
        self._waiting = WaitingScan()
        self._map, self._config = occupancy, config
        self._begin, self._deviation = start, _GIVEN_DEVIATION
        self._localizer: Localizer | None = None
        self._stamp = self._told_row = -math.inf
        self._elapsed = self._way = 0.0
        self._reckoned = Pose()
        self._is_told = start is not None

    @property
    def notes(self) -> list[str]:
        """What is worth knowing of what was heard."""
        return self._sensors.notes

    def hear(self, heard: Heard) -> Row | None:
        """Take in a message; return what is known then, if it is time to tell."""
        message = heard.message
        if heard.kind is MessageKind.ODOMETRY:
            self._hear_odometry(heard.stamp, message)
        elif heard.kind is MessageKind.GYRO:
            self._sensors.hear_gyro(heard.stamp, message)
        elif heard.kind is MessageKind.SCAN:
            self._hear_scan(heard.stamp, message)
        elif heard.kind is MessageKind.LIFTED and self._localizer is not None:
            # One wheel hangs over an edge; a robot that is held has both in the air.
            self._localizer.lift(message.is_left_dropped and message.is_right_dropped)
        elif heard.kind is MessageKind.TOLD:
            self._hear_told(message)
        return self._row(heard)

    def _hear_odometry(self, stamp: float, message: Odometry) -> None:
        try:
            pose = pose_of_odometry(message)
        except MessageError:
            self._sensors.leave_out("messages of odometry with numbers that are not finite")
            return
        if self._localizer is None:
            self._localizer = self._begun(stamp, pose)
        self._stamp = stamp
        self._localizer.move(stamp, pose, self._sensors.turning_at(stamp))
        step = self._reckoned.inverse().compose(self._localizer.reckoned)
        self._reckoned = self._localizer.reckoned
        self._way += math.hypot(step.x, step.y)
        self._see(self._localizer, self._waiting.ready(stamp))

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

    def _hear_scan(self, stamp: float, message: LaserScan) -> None:
        """Keep a scan until odometry has reached its last beam, or the next scan comes."""
        localizer = self._localizer
        if localizer is None:
            return
        scan = self._sensors.scan_of(message)
        if scan is not None:
            waited = self._waiting.put(StampedScan(stamp, scan.ranges, scan.lidar))
            self._see(localizer, waited)
        self._see(localizer, self._waiting.ready(self._stamp))

    def _see(self, localizer: Localizer, scan: StampedScan | None) -> None:
        if scan is None:
            return
        if scan.stamp > self._stamp + _LATEST:
            self._sensors.leave_out("scans of times without odometry")
            return
        localizer.see(*scan)
        self.scans += 1

    def _hear_told(self, message: PoseWithCovarianceStamped) -> None:
        """Begin anew at the first pose that was told, by a person or by the robot itself."""
        if self._is_told:
            return
        self._is_told = True
        try:
            self._begin, self._deviation = told_pose_of(message)
        except MessageError as error:
            self._sensors.remark(f"the recorded start is of no use: {error}")
            return
        self.start, self.was_told = "as recorded", True
        if self._localizer is not None:
            self._localizer.told(self._begin, self._deviation)

    def _row(self, heard: Heard) -> Row | None:
        localizer = self._localizer
        if localizer is None:
            return None
        period = _ROW_PERIOD if heard.kind is MessageKind.ODOMETRY else _SILENCE
        passed = heard.stamp - self._told_row
        if 0.0 <= passed < period:
            return None
        if passed < 0.0 and heard.kind is not MessageKind.ODOMETRY:
            return None
        if math.isfinite(passed):
            self._elapsed += max(0.0, passed)
        self._told_row = heard.stamp
        localizer.pass_time(heard.stamp)
        return Row(
            heard.stamp,
            heard.arrival,
            self._elapsed,
            self._way,
            localizer.estimate,
            localizer.map_to_odometry,
        )
