"""Makes a map of a recorded drive, offline: ``./roomba map --bag FILE``.

Any bag with a lidar's scans and odometry will do; a gyro helps. Only bags of ``./roomba sim --bag``
have the truth to compare with. The report is the length of the drive, whether it closes, and how
much was corrected.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import rosbag
from geometry_msgs.msg import PoseStamped

from roomba.commands.map.command import COMPLETED, guarded
from roomba.commands.map.drive_log import write_trajectory
from roomba.commands.map.files import write_files
from roomba.commands.map.options import Output, Parser, output_of
from roomba.commands.progress import progress
from roomba.commands.telling import tell_tables, write_json
from roomba.configuration.mapping import load_mapping_config
from roomba.configuration.robot import load_robot_config
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose
from roomba_ros.bags.localize_recording import Heard, MessageKind, Recording, RecordingError
from roomba_ros.bags.map_bag_report import BagMap, summary_of, table_of
from roomba_ros.bags.map_replay import MapReplay
from roomba_ros.convert.common import pose_of
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.mounts import Mounts, usable_transforms

_MOUNT_MESSAGES: Final = 1000
_MOVING_MESSAGES: Final = 300
"""Messages of /tf_static and /tf that are searched for the mounts of the sensors."""


@dataclass(frozen=True, slots=True)
class _Options:
    bag: Path
    scan: str
    odometry: str
    gyro: str | None
    trajectory: Path | None
    online: Path | None
    output: Output


def main(arguments: list[str] | None = None) -> int:
    """Map; returns the exit status."""
    return guarded(lambda: _run(arguments))


def _run(arguments: list[str] | None) -> int:
    options = _options_of(arguments)
    try:
        with Recording(options.bag) as recording:
            done = _map(options, recording)
    except rosbag.ROSBagException as error:
        raise RecordingError(f"{options.bag}: {error}") from error
    output = options.output
    if output.out is not None:
        write_files(output.out, done.occupancy, done.begin)
    log, mapper = done.replay.log, done.replay.mapper
    if options.trajectory is not None:
        write_trajectory(options.trajectory, log.at_the_end(mapper))
    if options.online is not None:
        write_trajectory(options.online, log.online)
    if output.plot is not None:
        # Imported here: it takes a second, which only a picture needs.
        from roomba_ros.bags.map_bag_plot import write_plot

        write_plot(output.plot, done)
    summary = summary_of(done)
    tell_tables([table_of(summary)], output.json, quiet=output.quiet)
    if output.json is not None:
        write_json(output.json, summary.as_json())
    return COMPLETED


def _options_of(arguments: list[str] | None) -> _Options:
    parser = Parser(
        "Make a map of a recorded drive: any bag with a lidar and odometry.",
        "A home without a bag: see ./roomba map --help.",
    )
    parser.add_argument("--bag", type=Path, required=True, metavar="FILE.bag")
    parser.add_argument(
        "--scan", "--scan-topic", default="/scan", metavar="TOPIC", help="default: /scan"
    )
    parser.add_argument(
        "--odom", "--odom-topic", default="/odom", metavar="TOPIC", help="default: /odom"
    )
    parser.add_argument(
        "--imu", "--imu-topic", metavar="TOPIC", help="default: /imu, if there is one; a gyro helps"
    )
    parser.add_argument(
        "--trajectory",
        type=Path,
        metavar="FILE",
        help="write where the robot was at each scan, as known at the end: lines 't x y theta'",
    )
    parser.add_argument(
        "--online", type=Path, metavar="FILE", help="the same, as known when it drove there"
    )
    parser.add_output()
    given = parser.parse_args(arguments)
    output = output_of(given, [("--bag", given.bag)])
    return _Options(
        given.bag, given.scan, given.odom, given.imu, given.trajectory, given.online, output
    )


def _map(options: _Options, recording: Recording) -> BagMap:
    """Go through the recording, and make the map; raises RecordingError if too little is there."""
    kinds, truth = _topics(options, recording)
    odometry = next(topic for topic, kind in kinds.items() if kind is MessageKind.ODOMETRY)
    first = recording.first([odometry], 1)
    base = (first[0].child_frame_id if first else "") or "base_link"
    frame = (first[0].header.frame_id.lstrip("/") if first else "") or "odom"
    start = _first_truth(recording, truth)
    folder = CONFIGURATION
    config = load_robot_config(folder / "robot.yaml")
    mapping = load_mapping_config(folder / "mapping.yaml")
    replay = MapReplay(config, mapping, _mounts(recording, frame), base, start or Pose())
    true: list[tuple[float, float, float]] = []
    began = time.perf_counter()
    with progress("Mapping", options.output.quiet) as show:
        for heard in recording.messages(kinds):
            show(heard.share, f"{replay.elapsed:.0f} s, {replay.scans} scans")
            if heard.kind is MessageKind.OWN_POSE:
                _add_truth(true, heard)
            else:
                replay.hear(heard)
        replay.end()
        if not replay.scans:
            reasons = "; ".join([*recording.notes, *replay.notes]) or "it has none beside odometry"
            raise RecordingError(f"{options.bag}: no scan could be used: {reasons}")
        if not replay.mapper.version:
            raise RecordingError(
                f"{options.bag}: expected scans that show walls, got {replay.scans} with hardly "
                "anything in sight; look at them, or record near walls"
            )
        occupancy = replay.mapper.finish()
    return BagMap(
        str(options.bag),
        occupancy,
        replay,
        true,
        Pose(*replay.mapper.trajectory[0].tolist()),
        time.perf_counter() - began,
        [*recording.notes, *replay.notes],
    )


def _topics(options: _Options, recording: Recording) -> tuple[dict[str, MessageKind], str | None]:
    """Return what is read, and the topic of true poses if there is one."""
    scan = recording.require(options.scan, MessageKind.SCAN, "--scan")
    odometry = recording.require(options.odometry, MessageKind.ODOMETRY, "--odom")
    if options.gyro is not None:
        gyro: str | None = recording.require(options.gyro, MessageKind.GYRO, "--imu")
    else:
        gyro = recording.beside(odometry, "imu", MessageKind.GYRO)
    truth = recording.beside(odometry, "ground_truth/pose", MessageKind.OWN_POSE)
    kinds = {scan: MessageKind.SCAN, odometry: MessageKind.ODOMETRY}
    if gyro is not None:
        kinds[gyro] = MessageKind.GYRO
    if truth is not None:
        kinds[truth] = MessageKind.OWN_POSE
    return kinds, truth


def _mounts(recording: Recording, odometry_frame: str) -> Mounts:
    """Return where the sensors are."""
    mounts = Mounts()
    for message in recording.first(["/tf_static"], _MOUNT_MESSAGES):
        mounts.add(usable_transforms(message.transforms))
    # Some robots tell again and again on /tf what never changes.
    fixed = (
        each
        for message in recording.first(["/tf"], _MOVING_MESSAGES)
        for each in message.transforms
        if each.header.frame_id.lstrip("/") not in ("map", odometry_frame)
        and not mounts.knows(each.child_frame_id)
    )
    mounts.add(usable_transforms(fixed))
    return mounts


def _first_truth(recording: Recording, topic: str | None) -> Pose | None:
    """Return where the drive truly began, so that the map lies as the true one does."""
    found = recording.first([topic], 1) if topic is not None else []
    return _usable_pose(found[0]) if found else None


def _add_truth(true: list[tuple[float, float, float]], heard: Heard) -> None:
    pose = _usable_pose(heard.message)
    if pose is not None:
        true.append((heard.stamp, pose.x, pose.y))


def _usable_pose(message: PoseStamped) -> Pose | None:
    try:
        return pose_of(message)
    except MessageError:
        return None


if __name__ == "__main__":
    sys.exit(main())
