"""Replay of a recorded drive through the mapper."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.commands.map.blind_map import BlindMap
from roomba.commands.map.drive.odometry_gaps import ALWAYS, GapsInOrder, OdometryGap
from roomba.commands.map.drive.pauses import PauseSeeker
from roomba.commands.map.drive.trajectory import Trajectory
from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper
from roomba.recordings.drives.turning import NewestTurning
from roomba.recordings.readings import LidarScan, Lifted, Odometry, Turning, Value
from roomba.recordings.times.waiting import StampedScan, WaitingScan

_GUESSED: Final = {
    "way_noise": 0.2,
    "side_noise": 0.1,
    "wheel_turn_noise": 0.1,
    "turn_noise": 0.1,
    "turn_way_noise": 0.1,
}
"""m, rad per square root of m, rad: noise of motion that is only guessed from the pace so far."""
_MAY_START: Final = {"standing_deviation": 0.05, "standing_heading": 0.05}
"""m, rad: noise of a guessed step of a robot that stood, which may start at any time."""
_LONGEST: Final = 1.5
"""s; after a longer time the robot's pace so far says nothing about its motion."""
_FEWEST: Final = 10
"""Scans; only a drive with as many is reported as one whose scans mostly fit nothing."""
_MOST_UNFITTING: Final = 0.5
"""Share of the scans that fit nothing; with more of them a map is hardly of any use."""
_MOST_BENT: Final = 4.0
"""Degrees; a map is reported that may be bent by more, at two standard deviations."""
_LATEST: Final = 1.0
"""s; a scan that is newer than all odometry by more is left out: its pose is unknown."""


def guessed(config: LocalizationConfig) -> LocalizationConfig:
    """Return numbers for motion that is only guessed, by scans, in place of those for wheels."""
    return config.model_copy(update=_GUESSED)


class PacedOdometry:
    """Replaces odometry in its gaps: the robot goes on at the pace that scans showed so far."""

    def __init__(self, pose: Pose, stamp: float) -> None:
        """Begin where odometry ended, at ``stamp``, s; infinite if there was none."""
        self._pose, self._stamp = pose, stamp

    def at(self, stamp: float, pace: NDArray[np.float64]) -> Pose:
        """Return the robot's pose at a scan, s, by its pace so far, [3], m/s and rad/s."""
        elapsed, self._stamp = stamp - self._stamp, stamp
        if 0.0 < elapsed < _LONGEST:
            self._pose = self._pose.compose(Pose(*(elapsed * pace).tolist()))
        return self._pose


class MapReplay:
    """Feeds a mapper, and a map by odometry alone; ``notes`` says what was left out, and why."""

    def __init__(
        self,
        config: RobotConfig,
        mapping: MappingConfig,
        start: Pose,
        gaps: Sequence[OdometryGap] = (),
    ) -> None:
        """Begin at ``start``, map frame; in ``gaps`` of odometry it goes by scans alone."""
        self._gaps = GapsInOrder(gaps)
        self._by_scans: PacedOdometry | None = None
        self.has_odometry = ALWAYS not in gaps
        self._wheel_noise = config.localization, mapping.following
        self._guessed_noise = (
            guessed(config.localization),
            mapping.following.model_copy(update=_MAY_START),
        )
        self.mapper = Mapper(mapping, config.localization, config.gyro, start)
        self.blind = BlindMap(mapping, config.localization, config.gyro, start)
        self.trajectory = Trajectory()
        self.scans = 0
        """Number of scans that were used."""
        self.unconfirmed = 0
        """Number of used scans that fitted nothing seen before."""
        self.way = self.elapsed = 0.0
        self.seconds = 0.0
        """s of one core that the mapper took."""
        self.left_out: Counter[str] = Counter()
        self.lidar: LidarModel | None = None
        """The lidar of the newest scan."""
        self._blind_rows: list[tuple[float, float, float, float]] = []
        self._stamp = -math.inf
        self._fed = self._frame = Pose()
        """The newest pose in the frame of the first odometry, and the present odometry's frame in
        that."""
        self._at: Pose | None = None
        self._is_lifted = False
        self._turning = NewestTurning()
        self._waiting = WaitingScan()
        self._pauses = PauseSeeker()

    @property
    def by_odometry(self) -> NDArray[np.float64]:
        """Rows of t (s), x, y (m), theta (rad) at each scan by odometry alone.

        Without odometry the robot is assumed to keep its pace between the scans before.
        """
        return np.array(self._blind_rows).reshape(-1, 4)

    @property
    def notes(self) -> list[str]:
        """Notes on left-out readings, on scans that fitted nothing, and on a bent map."""
        told = [f"{count} {what}: left out" for what, count in self.left_out.items()]
        if self.scans >= _FEWEST and self.unconfirmed > _MOST_UNFITTING * self.scans:
            told.append(
                f"{self.unconfirmed} of {self.scans} scans fitted nothing seen before: this map is "
                "hardly worth anything; look whether each scan is a whole turn of one lidar, and "
                "whether angles, times and ranges are true"
            )
        apart, laid = self.mapper.ways_apart, self.mapper.parts_laid
        if laid:
            told.append(
                "the robot seems to have been carried, or driven while nothing was recorded: what "
                "it saw from then on was found on the rest of the map, and is drawn there (parts "
                f"of the map: {laid})"
            )
        if apart:
            told.append(
                f"{sum(apart):.1f} m of the way, parts of the map: {len(apart)}, lie only where "
                "the robot was thought to be: scans fitted nothing before them, and what was seen "
                "there was found nowhere else; it may be drawn at a wrong place"
            )
        drift = self.mapper.heading_drift
        bent = 2.0 * math.degrees(drift.deviation)
        if bent > _MOST_BENT:
            told.append(
                f"too few places were seen again to hold the heading: the map may be bent by ± "
                f"{bent:.0f} degrees between its begin and what was seen after {drift.way:.0f} m "
                "of the way"
            )
        return told

    def hear(self, stamp: float, value: Value) -> None:
        """Take in a reading, in the order of time; true poses say nothing."""
        if isinstance(value, Odometry):
            self._hear_odometry(stamp, value.pose)
        elif isinstance(value, Turning):
            self._turning.hear(stamp, value.speed)
        elif isinstance(value, Lifted):
            self._hear_lifted(is_lifted=value.is_lifted)
        elif isinstance(value, LidarScan):
            self._hear_scan(stamp, value)

    def end(self) -> None:
        """Take in what waits for more odometry: there is none."""
        self._see(self._waiting.last())

    def finish(self) -> OccupancyMap:
        """Return the finished map; raises ValueError if nothing was seen."""
        began = time.process_time()
        occupancy = self.mapper.finish()
        self.seconds += time.process_time() - began
        return occupancy

    def _hear_odometry(self, stamp: float, pose: Pose) -> None:
        if self._gaps.has(stamp):
            return
        if self._by_scans is not None:
            here = self._by_scans.at(stamp, self.mapper.pace)
            self._by_scans, self._frame = None, here.compose(pose.inverse())
            self.mapper.end_guessing(*self._wheel_noise)
        paused = self._pauses.hear(stamp)
        if paused is not None:
            self.mapper.miss(paused)
        self._move(stamp, self._frame.compose(pose))

    def _move_by_scans(self, stamp: float) -> None:
        """Go on at the robot's pace until a scan."""
        if self._by_scans is None:
            self._by_scans = PacedOdometry(self._fed, self._gaps.begin)
            self.mapper.begin_guessing(*self._guessed_noise)
        self._move(stamp, self._by_scans.at(stamp, self.mapper.pace))

    def _move(self, stamp: float, pose: Pose) -> None:
        """Move to the robot's pose in the frame of the first odometry."""
        if math.isfinite(self._stamp):
            self.elapsed += max(0.0, stamp - self._stamp)
        self._stamp, self._fed = stamp, pose
        turning = self._turning.at(stamp)
        began = time.process_time()
        self.mapper.move(stamp, pose, turning)
        self.seconds += time.process_time() - began
        self.blind.move(stamp, pose, turning)
        here = self.blind.pose
        if self._at is not None:
            self.way += here.distance_to(self._at.x, self._at.y)
        self._at = here
        self._see(self._waiting.ready(stamp))

    def _hear_lifted(self, *, is_lifted: bool) -> None:
        """Leave out scans while the robot is carried; mapping goes on where it is set down."""
        if is_lifted:
            # The scan that waits for odometry was taken on the floor.
            self._see(self._waiting.last())
            self.mapper.lift(is_lifted)
        elif self._is_lifted:
            self.mapper.set_down()
        self._is_lifted = is_lifted

    def _hear_scan(self, stamp: float, scan: LidarScan) -> None:
        """Keep a scan until odometry has reached its last beam, or the next scan comes."""
        self._pauses.see(stamp)
        if self._gaps.has(stamp):
            self._move_by_scans(stamp)
        if not math.isfinite(self._stamp):
            self.left_out["scans before the first odometry"] += 1
            return
        if self._is_lifted:
            self.left_out["scans while it was carried"] += 1
            return
        self._see(self._waiting.put(StampedScan(stamp, scan.ranges, scan.lidar)))
        self._see(self._waiting.ready(self._stamp))

    def _see(self, scan: StampedScan | None) -> None:
        if scan is None:
            return
        stamp = scan.stamp
        if stamp > self._stamp + _LATEST:
            self.left_out["scans of times without odometry"] += 1
            return
        began = time.process_time()
        self.mapper.see(stamp, scan.ranges, scan.lidar)
        self.seconds += time.process_time() - began
        self.blind.see(stamp, scan.ranges, scan.lidar)
        self.trajectory.add(stamp, self.mapper)
        self.scans += 1
        self.lidar = scan.lidar
        self.unconfirmed += self.mapper.estimate.knowledge is not Knowledge.KNOWN
        here = self.blind.at(stamp)
        self._blind_rows.append((stamp, here.x, here.y, here.theta))
