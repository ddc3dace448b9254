"""Localization of a recorded drive: the localizer hears what was recorded as if it were there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, LaserScan

from roomba.config import RobotConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.estimate import Estimate
from roomba.perception.localizer import Localizer
from roomba.perception.scan_view import LidarModel
from roomba_ros.convert import pose_of_odometry
from roomba_ros.convert_localization import SAME_TIME, ranges_of, told_pose_of
from roomba_ros.localize_mounts import Mount, Mounts
from roomba_ros.localize_recording import Heard, Kind

_ROW_PERIOD: Final = 0.045
"""s; as often as the live node tells its pose, with something left for clocks that tremble."""
_SILENCE: Final = 0.25
"""s; without odometry for so long the other messages tell that time passes."""
_LATEST: Final = 1.0
"""s; a scan that odometry is so far behind is of a time that it knows nothing of."""
_GIVEN_DEVIATION: Final = (0.1, 0.1)
"""m, rad; how unsure a start is that somebody typed."""


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
        self._map, self._config = occupancy, config
        self._mounts, self._base = mounts, base
        self._begin, self._deviation = start, _GIVEN_DEVIATION
        self._localizer: Localizer | None = None
        self._stamp = self._told_row = -math.inf
        self._elapsed = self._way = 0.0
        self._reckoned = Pose()
        self._gyro: tuple[float, float] | None = None
        self._scan: tuple[float, LaserScan] | None = None
        self._lidar: tuple[tuple[object, ...], LidarModel] | None = None
        self._frames: dict[str, Mount] = {}
        self._is_told = start is not None
        self._left_out: dict[str, int] = {}
        self._remarks: list[str] = []

    @property
    def notes(self) -> list[str]:
        """What is worth knowing of what was heard."""
        left_out = [f"{count} {why}: left out" for why, count in self._left_out.items()]
        return [*self._remarks, *left_out]

    def hear(self, heard: Heard) -> Row | None:
        """Take in a message; return what is known then, if it is time to tell."""
        message = heard.message
        if heard.kind is Kind.ODOMETRY:
            self._hear_odometry(heard.stamp, message)
        elif heard.kind is Kind.GYRO:
            self._hear_gyro(heard.stamp, message)
        elif heard.kind is Kind.SCAN:
            self._hear_scan(heard.stamp, message)
        elif heard.kind is Kind.LIFTED and self._localizer is not None:
            # One wheel hangs over an edge; a robot that is held has both in the air.
            self._localizer.lift(message.is_left_dropped and message.is_right_dropped)
        elif heard.kind is Kind.TOLD:
            self._hear_told(message)
        return self._row(heard)

    def _hear_odometry(self, stamp: float, message: Odometry) -> None:
        pose = pose_of_odometry(message)
        if not pose.is_finite:
            self._leave_out("messages of odometry with numbers that are not finite")
            return
        if self._localizer is None:
            self._localizer = self._begun(stamp, pose)
        self._stamp = stamp
        self._localizer.move(stamp, pose, self._turning_at(stamp))
        step = self._reckoned.inverse().compose(self._localizer.reckoned)
        self._reckoned = self._localizer.reckoned
        self._way += math.hypot(step.x, step.y)
        if self._scan is not None and self._scan[0] <= stamp:
            self._see(self._localizer)

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
            localizer.forget("nobody told where it began")
        return localizer

    def _turning_at(self, stamp: float) -> float | None:
        """Return the gyro's newest sample, rad/s, if it is of about that time."""
        if self._gyro is None or abs(self._gyro[0] - stamp) > SAME_TIME:
            return None
        return self._gyro[1]

    def _hear_gyro(self, stamp: float, message: Imu) -> None:
        turning = message.angular_velocity.z
        if math.isfinite(turning):
            is_upside_down = self._mount(message.header.frame_id, "gyro").is_upside_down
            self._gyro = (stamp, -turning if is_upside_down else turning)

    def _hear_scan(self, stamp: float, message: LaserScan) -> None:
        """Keep a scan until odometry has reached its time, or the next scan comes."""
        if self._localizer is None:
            return
        if self._scan is not None:
            self._see(self._localizer)
        self._scan = (stamp, message)
        if stamp <= self._stamp:
            self._see(self._localizer)

    def _see(self, localizer: Localizer) -> None:
        if self._scan is None:
            return
        (stamp, scan), self._scan = self._scan, None
        if stamp > self._stamp + _LATEST:
            self._leave_out("scans of times without odometry")
            return
        try:
            localizer.see(stamp, ranges_of(scan), self._lidar_of(scan))
        except ValueError as error:
            self._leave_out(f"scans ({error})")
            return
        self.scans += 1

    def _lidar_of(self, scan: LaserScan) -> LidarModel:
        """Return the lidar of a scan, made anew only when something of it changed."""
        key = (
            scan.header.frame_id,
            len(scan.ranges),
            scan.angle_min,
            scan.angle_increment,
            scan.range_min,
            scan.range_max,
        )
        if self._lidar is None or self._lidar[0] != key:
            self._lidar = (key, self._mount(scan.header.frame_id, "lidar").lidar(scan))
        return self._lidar[1]

    def _mount(self, frame: str, sensor: str) -> Mount:
        """Return where a sensor is mounted: in the middle, and looking ahead, if nothing tells."""
        if frame not in self._frames:
            mount = self._mounts.mount(self._base, frame)
            if mount is None and sensor == "lidar":
                self._remarks.append(
                    f"no transform from {self._base!r} to {frame!r} was recorded: "
                    "the lidar is taken to be in the middle of the robot, and to look ahead"
                )
            self._frames[frame] = mount or Mount()
        return self._frames[frame]

    def _hear_told(self, message: PoseWithCovarianceStamped) -> None:
        """Begin anew where somebody, or the robot itself, first told that it is."""
        if self._is_told:
            return
        self._is_told = True
        frame = message.header.frame_id.lstrip("/")
        try:
            if frame not in ("", "map"):
                raise ValueError(f"expected the frame 'map', got {frame!r}")
            self._begin, self._deviation = told_pose_of(message)
        except ValueError as error:
            self._remarks.append(f"the recorded start is of no use: {error}")
            return
        self.start, self.was_told = "as recorded", True
        if self._localizer is not None:
            self._localizer.told(self._begin, self._deviation)

    def _leave_out(self, why: str) -> None:
        self._left_out[why] = self._left_out.get(why, 0) + 1

    def _row(self, heard: Heard) -> Row | None:
        localizer = self._localizer
        if localizer is None:
            return None
        period = _ROW_PERIOD if heard.kind is Kind.ODOMETRY else _SILENCE
        passed = heard.stamp - self._told_row
        if 0.0 <= passed < period:
            return None
        if passed < 0.0 and heard.kind is not Kind.ODOMETRY:
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
