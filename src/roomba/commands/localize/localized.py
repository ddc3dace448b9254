"""Localizes a recorded drive: its readings, and the result."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.commands.localize.files import OUTPUT_TOPICS, RowBag, RowFile, RowTable, RowTrajectory
from roomba.commands.localize.options import LocalizeOptions
from roomba.commands.localize.replay import Replay, Row
from roomba.commands.localize.scan_spacing import with_patience
from roomba.commands.localize.tally import Tally
from roomba.commands.map.drive.looking import look_at_drive
from roomba.commands.map.drive.whole_odometry import whole_odometry_of
from roomba.commands.progress import Show
from roomba.configuration.robot import load_robot_config
from roomba.files.shipped import CONFIGURATION
from roomba.grid import FREE, OccupancyMap
from roomba.perception.localization.estimate import Knowledge
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import Kind, LogError, OwnPose
from roomba.recordings.times.stamps import StampCounts

_SHOWN: Final = 64
"""Readings between two updates of the progress."""

_LEAST_KNOWN: Final = 0.5
"""Share of the time in which the place is known; below it the map is hardly one of the drive."""


@dataclass(frozen=True, slots=True, eq=False)
class LocalizedDrive:
    """The result for some logs. ``start`` says in words where the drive began.

    ``own_poses`` is the channel with the robot's own poses. ``stamps`` counts messages with faulty
    times.
    """

    logs: tuple[Path, ...]
    map: Path
    start: str
    own_poses: str | None
    tally: Tally
    scans: int
    stamps: StampCounts
    notes: tuple[str, ...]

    @property
    def name(self) -> str:
        """The names of the logs."""
        return " + ".join(path.name for path in self.logs)

    @property
    def placed_rows(self) -> list[Row]:
        """Rows from the first known place on; all rows if the place was never known."""
        rows = self.tally.shown_rows
        placed = itertools.dropwhile(lambda row: not row.estimate.knowledge.is_usable, rows)
        return list(placed) or rows


def localized_drive(
    options: LocalizeOptions, occupancy: OccupancyMap, show: Show
) -> LocalizedDrive:
    """Go through a drive, write down where it was, and ``show`` how far it is.

    Raises LogError for logs that cannot be read, and OSError for files that cannot be written.
    """
    with LoggedDrive(options.logs, options.wanted) as drive:
        look_at_drive(drive)
        config = with_patience(load_robot_config(CONFIGURATION / "robot.yaml"), drive)
        odometry = whole_odometry_of(drive, config)
        replay, tally = Replay(occupancy, config, odometry, options.start), Tally()
        _replay(drive, replay, tally, options, show)
        if tally.last is None:
            raise LogError(f"{_names(options.logs)}: no message of odometry could be read")
        told = drive.chosen.name(Kind.TOLD)
        return LocalizedDrive(
            options.logs,
            options.map,
            f"as recorded on {told}" if replay.was_told else _words_of_start(options),
            drive.chosen.name(Kind.OWN_POSE),
            tally,
            replay.scans,
            drive.counts,
            (
                *drive.notes,
                *replay.notes,
                *_remarks(options, occupancy),
                *_doubts(tally),
                *_how_to_play(options, drive),
            ),
        )


def _replay(
    drive: LoggedDrive, replay: Replay, tally: Tally, options: LocalizeOptions, show: Show
) -> None:
    is_placed = False
    with contextlib.ExitStack() as stack:
        files = [stack.enter_context(file) for file in _files(options, drive)]
        for number, reading in enumerate(drive.readings()):
            if number % _SHOWN == 0:
                show(min(1.0, number / len(drive)), f"{tally.seconds:.0f} s, {replay.scans} scans")
            if isinstance(reading.value, OwnPose):
                tally.hear_own_pose(reading.stamp, reading.value.pose)
            row = replay.hear(reading)
            if row is None:
                continue
            tally.take(row)
            # Poses from before the place is first known do not belong in a file.
            is_placed = is_placed or row.estimate.knowledge.is_usable
            for file in files if is_placed else ():
                file.write(row)


def _files(options: LocalizeOptions, drive: LoggedDrive) -> Iterator[RowFile]:
    if options.csv is not None:
        yield RowTable(options.csv)
    if options.trajectory is not None:
        yield RowTrajectory(options.trajectory)
    if options.output is not None:
        yield RowBag(options.output, _moved_frame(drive))


def _moved_frame(drive: LoggedDrive) -> str:
    """Return the frame that rows place on the map: odometry's, or without it the body's."""
    return drive.odometry_frame if drive.chosen.has_odometry else drive.body_frame


def _words_of_start(options: LocalizeOptions) -> str:
    return "searched for in the whole map" if options.start is None else "given"


def _remarks(options: LocalizeOptions, occupancy: OccupancyMap) -> list[str]:
    start = options.start
    if start is None or occupancy.values[occupancy.frame.cell_of(start.x, start.y)] == FREE:
        return []
    return [f"the start ({start.x:g}, {start.y:g}) is not on free floor of {options.map}"]


def _doubts(tally: Tally) -> list[str]:
    """Return a doubt about a map on which the place was found, but seldom known."""
    known = tally.shares[Knowledge.KNOWN.value]
    if tally.found is None or known >= _LEAST_KNOWN or not tally.loss_count:
        return []
    return [
        f"the place was known {100.0 * known:.0f} % of the time, and lost on the way: is this the "
        "map of the drive, and not of another floor, or mirrored?"
    ]


def _how_to_play(options: LocalizeOptions, drive: LoggedDrive) -> list[str]:
    """Return how to play the recorded bag of ROS 1 beside the written one.

    What both bags have is left out of the recorded one.
    """
    bags = [path for path in options.logs if path.suffix == ".bag"]
    if options.output is None or not bags or not drive.names & {*OUTPUT_TOPICS, "/tf"}:
        return []
    return [
        "the bag may have such topics of its own; to play both, leave those out: ./roomba exec "
        f"rosbag filter {bags[0]} NEW.bag \"topic not in {OUTPUT_TOPICS} and not (topic == '/tf' "
        f"and any(x.child_frame_id == '{_moved_frame(drive)}' for x in m.transforms))\""
    ]


def _names(logs: tuple[Path, ...]) -> str:
    return ", ".join(map(str, logs))
