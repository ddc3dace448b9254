"""Odometry of a whole drive: in the gaps of the recorded one it continues by scans."""

from __future__ import annotations

from collections.abc import Sequence

from roomba.commands.map.drive.odometry_gaps import GapsInOrder, OdometryGap, gaps_of
from roomba.commands.map.drive.replay import MapReplay
from roomba.configuration.frozen import load_config
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose
from roomba.perception.slam.mapper import Mapper
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import LidarScan, Odometry, Reading


class WholeOdometry:
    """Recorded odometry; in its ``gaps`` a map that is made meanwhile gives the robot's steps.

    ``frame`` is where the frame of the recorded odometry lies in the frame of this one. They are
    the same until the first gap. ``is_guessed`` tells whether the newest step is of that map.
    """

    def __init__(
        self, config: RobotConfig, mapping: MappingConfig, gaps: Sequence[OdometryGap]
    ) -> None:
        """Without gaps no map is made."""
        self.frame = Pose()
        self.is_guessed = False
        self._pose = self._recorded = Pose()
        self._gaps = GapsInOrder(gaps)
        self._replay = MapReplay(config, mapping, Pose(), gaps) if gaps else None

    def hear(self, reading: Reading) -> Pose | None:
        """Take in a reading, in the order of time; return where odometry is then, if it tells."""
        value, replay = reading.value, self._replay
        if replay is None:
            return value.pose if isinstance(value, Odometry) else None
        has_gap = self._gaps.has(reading.stamp)
        is_told = isinstance(value, Odometry) and not has_gap
        is_guessed = isinstance(value, LidarScan) and has_gap
        # The step from a guessed pose to the next pose, guessed or recorded, is the map's.
        goes_on = is_guessed or (is_told and self.is_guessed)
        before = _Place(replay.mapper) if goes_on else None
        replay.hear(reading.stamp, value)
        if not (is_told or is_guessed):
            return None
        if isinstance(value, Odometry):
            self._recorded = value.pose
        if before is None:
            self._pose = self.frame.compose(self._recorded)
        else:
            self._go_on(before, replay.mapper)
            self.frame = self._pose.compose(self._recorded.inverse())
        self.is_guessed = is_guessed
        return self._pose

    def _go_on(self, before: _Place, mapper: Mapper) -> None:
        """Move on by what the robot moved since it was at a place of the map."""
        self._pose = self._pose.compose(before.now(mapper).inverse().compose(mapper.pose))


def whole_odometry_of(drive: LoggedDrive, config: RobotConfig) -> WholeOdometry:
    """Return the odometry of a drive, and add a remark about its gaps to the drive."""
    mapping = load_config(MappingConfig, CONFIGURATION / "mapping.yaml")
    return WholeOdometry(config, mapping, gaps_of(drive))


class _Place:
    """A robot's pose relative to the newest keyframe, which may be moved afterwards."""

    def __init__(self, mapper: Mapper) -> None:
        """Note where it is."""
        self._pose, self._number = mapper.pose, -1
        self._beside: Pose | None = None
        if mapper.version:
            self._number, keyframe = mapper.newest_keyframe
            self._beside = keyframe.inverse().compose(self._pose)

    def now(self, mapper: Mapper) -> Pose:
        """Return where that place is on the map as it is now."""
        if self._beside is None:
            return self._pose
        number, keyframe = mapper.newest_keyframe
        if number != self._number:
            keyframe = Pose(*mapper.trajectory[self._number].tolist())
        return keyframe.compose(self._beside)
