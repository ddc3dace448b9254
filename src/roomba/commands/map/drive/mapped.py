"""Maps a recorded drive: its logs, and the result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.commands.map.drive.disagreement import disagreements, told_disagreements
from roomba.commands.map.drive.looking import look_at_drive
from roomba.commands.map.drive.odometry_gaps import OdometryGap, gaps_of
from roomba.commands.map.drive.replay import MapReplay
from roomba.commands.progress import Show
from roomba.configuration.frozen import load_config
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import load_robot_config
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import Kind, LogError, TruePose
from roomba.recordings.times.stamps import StampCounts

_SHOWN: Final = 64
"""Readings between two updates of the progress."""


@dataclass(frozen=True, slots=True, eq=False)
class MappedDrive:
    """A map that was made of logs, and the replay that made it.

    ``true`` is float64 [n, 3] of t (s), x, y (m), empty if unknown; ``begin`` is the drive's first
    pose on the map. ``stamps`` counts messages with faulty times, ``refused_scans`` unused scans by
    reason.
    """

    logs: tuple[Path, ...]
    occupancy: OccupancyMap
    replay: MapReplay
    true: Floats
    begin: Pose
    stamps: StampCounts
    refused_scans: dict[str, int]
    notes: tuple[str, ...]

    @property
    def trajectory(self) -> Floats:
        """Rows of t (s), x, y (m), theta (rad) at each scan, as known at the end."""
        return self.replay.trajectory.at_the_end(self.replay.mapper)

    @property
    def online(self) -> Floats:
        """The same rows, as the pose was known at the time."""
        return self.replay.trajectory.online

    @property
    def name(self) -> str:
        """The names of the logs."""
        return " + ".join(path.name for path in self.logs)


def mapped_drive(logs: Sequence[Path], wanted: Wanted, show: Show) -> MappedDrive:
    """Make the map of a drive, and ``show`` how far it is.

    Raises LogError for logs that cannot be read, or that show too little.
    """
    with LoggedDrive(logs, wanted) as drive:
        look_at_drive(drive)
        start = _first_truth(drive)
        replay, true = _replayed(drive, start or Pose(), gaps_of(drive), show)
        notes = [*drive.notes, *replay.notes]
        if not replay.scans:
            reasons = "; ".join(notes) or "it has none beside odometry"
            raise LogError(f"{_names(logs)}: no scan could be used: {reasons}")
        if not replay.mapper.version:
            told = (
                f"{_names(logs)}: expected scans that show walls, got {replay.scans} with hardly "
                "anything in sight; look at them, or record near walls"
            )
            raise LogError("; ".join((told, *notes)))
        show(1.0, "finishing the map")
        occupancy = replay.finish()
        begin = Pose(*replay.mapper.trajectory[0].tolist())
        refused = {**drive.refused_scans, **replay.left_out}
        return MappedDrive(
            tuple(logs),
            occupancy,
            replay,
            true,
            begin,
            drive.counts,
            refused,
            (*drive.notes, *replay.notes, *_doubts(replay)),
        )


def _doubts(replay: MapReplay) -> list[str]:
    """Return doubts about the finished map of a drive, where its odometry contradicts the map."""
    if not replay.has_odometry:
        return []
    on_map = replay.trajectory.at_the_end(replay.mapper)
    return told_disagreements(disagreements(on_map, replay.by_odometry))


def _replayed(
    drive: LoggedDrive, start: Pose, gaps: Sequence[OdometryGap], show: Show
) -> tuple[MapReplay, Floats]:
    """Return the replay of a drive from a start, map frame, and its true poses, [n, 3]."""
    config = load_robot_config(CONFIGURATION / "robot.yaml")
    mapping = load_config(MappingConfig, CONFIGURATION / "mapping.yaml")
    replay = MapReplay(config, mapping, start, gaps)
    true = []
    for number, (stamp, value, _) in enumerate(drive.readings()):
        if isinstance(value, TruePose):
            true.append((stamp, value.pose.x, value.pose.y))
        else:
            replay.hear(stamp, value)
        if number % _SHOWN == 0:
            show(min(1.0, number / len(drive)), f"{replay.elapsed:.0f} s, {replay.scans} scans")
    replay.end()
    return replay, np.array(true).reshape(-1, 3)


def _first_truth(drive: LoggedDrive) -> Pose | None:
    """Return the first true pose, so that the map gets the frame of the truth."""
    if all(channel.kind is not Kind.TRUTH for channel in drive.chosen.channels):
        return None
    values = (reading.value for reading in drive.readings())
    return next((value.pose for value in values if isinstance(value, TruePose)), None)


def _names(logs: Sequence[Path]) -> str:
    return ", ".join(map(str, logs))
