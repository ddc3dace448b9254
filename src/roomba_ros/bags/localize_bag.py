"""Localizes a recorded drive on a map, offline: ``./roomba localize --map FILE --bag FILE``.

Any bag with a lidar's scans and odometry will do. The localizer gets the messages as on the robot,
but as fast as it can; the result is printed as a short table, and written to the files asked for.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import math
import re
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NoReturn

import rosbag
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn
from rich.text import Text

from roomba.commands.sim.trial import UsageError
from roomba.configuration.robot import load_robot_config
from roomba.errors import RoombaError
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose
from roomba.grid import FREE, OccupancyMap
from roomba_ros.bags.localize_files import OUTPUT_TOPICS, RowBag, RowFile, RowTable
from roomba_ros.bags.localize_recording import MessageKind, RecordedBag, RecordingError
from roomba_ros.bags.localize_replay import Replay
from roomba_ros.bags.localize_report import LocalizationSummary, Tally, lines_of
from roomba_ros.convert.mounts import Mounts, usable_transforms

_PROGRAM: Final = "./roomba localize"
_MOUNT_MESSAGES: Final = 1000
_MOVING_MESSAGES: Final = 300
"""Messages of /tf_static and /tf that are searched for the mounts of the sensors."""
_REDRAWN: Final = 0.1
_TOLD: Final = 1.0
"""s between two pictures of the progress bar, and two lines where there is none."""


class _LocalizeParser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Say in one line what is wrong."""
        self.exit(2, f"{_PROGRAM}: {message}; see {_PROGRAM} --help\n")


@dataclass(frozen=True, slots=True)
class _Topics:
    """The topics that are read, and what they tell of the robot's frames."""

    kinds: dict[str, MessageKind]
    own_poses: str | None
    start: str | None
    base: str
    odometry_frame: str

    @property
    def kinds_of_own_poses(self) -> tuple[MessageKind, ...]:
        """What the robot's own poses come as: one topic may tell the start as well."""
        if self.own_poses is not None and self.own_poses == self.start:
            return (MessageKind.TOLD,)
        return (MessageKind.OWN_POSE,)


def main(arguments: list[str] | None = None) -> int:
    """Localize; returns the exit status."""
    options = _parser().parse_args(arguments)
    try:
        _check_files(options)
        occupancy = load_map(options.map)
        start = _start(options.start, occupancy)
        with RecordedBag(options.bag) as recording:
            summary = _localize(options, recording, occupancy, start)
        _tell(options, summary)
    except UsageError as error:
        print(f"{_PROGRAM}: {error}", file=sys.stderr)
        return 2
    except (RoombaError, rosbag.ROSBagException, OSError) as error:
        print(f"{_PROGRAM}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"{_PROGRAM}: stopped on the way; what was written is not complete", file=sys.stderr)
        return 130
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = _LocalizeParser(
        prog=_PROGRAM,
        description="Localize a recorded drive on a map: any bag with a lidar and odometry.",
        epilog="The start is what --start says, else the first pose that was recorded on "
        "initialpose or amcl_pose, else it is searched for in the whole map.",
    )
    # Python's own pattern knows no exponents: -1e-05 would be taken for an option.
    parser._negative_number_matcher = re.compile(r"-(\.?\d|inf|nan)")
    parser.add_argument("--map", type=Path, required=True, metavar="FILE.yaml")
    parser.add_argument("--bag", type=Path, required=True, metavar="FILE.bag")
    parser.add_argument(
        "--start",
        type=_finite,
        nargs=3,
        metavar=("X", "Y", "THETA"),
        help="where it begins, map frame, m and rad",
    )
    parser.add_argument("--scan-topic", default="/scan", metavar="TOPIC", help="default: /scan")
    parser.add_argument("--odom-topic", default="/odom", metavar="TOPIC", help="default: /odom")
    parser.add_argument(
        "--imu-topic", metavar="TOPIC", help="default: /imu, if there is one; a gyro helps"
    )
    parser.add_argument("--json", metavar="FILE|-", help="write the figures; - is standard output")
    parser.add_argument("--csv", type=Path, metavar="FILE", help="write the path, and how sure")
    parser.add_argument("--plot", type=Path, metavar="FILE.png", help="draw the path on the map")
    parser.add_argument(
        "--output",
        type=Path,
        metavar="FILE.bag",
        help="write /pose, /amcl_pose, /localization and /tf, to be played beside the bag",
    )
    return parser


def _finite(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"expected finite numbers (m, m, rad), got {text!r}")
    return number


def _check_files(options: argparse.Namespace) -> None:
    """Refuse before the work what could not be written after it; raises UsageError."""
    json_file = Path(options.json) if options.json not in (None, "-") else None
    named = (
        ("--json", json_file),
        ("--csv", options.csv),
        ("--plot", options.plot),
        ("--output", options.output),
    )
    if options.plot is not None and options.plot.suffix.lower() != ".png":
        raise UsageError(f"--plot: expected a name that ends with .png, got {options.plot}")
    used = {options.map.resolve(): "--map", options.bag.resolve(): "--bag"}
    for option, path in named:
        if path is None:
            continue
        if path.is_dir() or not path.absolute().parent.is_dir():
            raise UsageError(f"{option}: expected a file in a folder that is there, got {path}")
        other = used.setdefault(path.resolve(), option)
        if other != option:
            raise UsageError(f"{option}: {path} is the file of {other} already; choose another one")


def _start(numbers: list[float] | None, occupancy: OccupancyMap) -> Pose | None:
    """Return the start that was given; raises UsageError for one that is off the map."""
    if numbers is None:
        return None
    x, y, theta = numbers
    if not occupancy.frame.contains(x, y):
        x_min, x_max, y_min, y_max = occupancy.frame.extent
        raise UsageError(
            f"--start: expected a place on the map, x {x_min:g} to {x_max:g}, "
            f"y {y_min:g} to {y_max:g}, got ({x:g}, {y:g})"
        )
    return Pose(x, y, theta)


# ---------------------------------------------------------------- the work


def _localize(
    options: argparse.Namespace, recording: RecordedBag, occupancy: OccupancyMap, start: Pose | None
) -> LocalizationSummary:
    """Go through the recording, and write down what was found."""
    topics = _topics(options, recording, start)
    mounts, has_map_transform = _mounts(recording, topics)
    config = load_robot_config(CONFIGURATION / "robot.yaml")
    replay = Replay(occupancy, config, mounts, topics.base, start)
    tally = Tally(topics.own_poses)
    began, is_placed = time.perf_counter(), False
    with contextlib.ExitStack() as stack:
        files = [stack.enter_context(file) for file in _files(options, topics)]
        show = stack.enter_context(_progress())
        for heard in recording.messages(topics.kinds):
            show(heard.share)
            if heard.kind in topics.kinds_of_own_poses:
                tally.hear_own_pose(heard)
            row = replay.hear(heard)
            if row is None:
                continue
            tally.take(row)
            # What comes before the place is first known is no pose that a file should hold.
            is_placed = is_placed or row.estimate.knowledge.is_usable
            for file in files if is_placed else ():
                file.write(row)
        show(1.0)
    processing = time.perf_counter() - began
    if tally.last is None:
        raise RecordingError(f"{options.bag}: no message of odometry could be read")
    began_at = f"{replay.start} on {topics.start}" if replay.was_told else replay.start
    summary = tally.summary(str(options.bag), str(options.map), began_at, replay.scans, processing)
    summary.notes += recording.notes + replay.notes + _remarks(options, occupancy, start)
    if options.output is not None:
        summary.notes += _how_to_play(recording, topics, has_map_transform=has_map_transform)
    if options.plot is not None:
        _plot(options, occupancy, tally)
    return summary


def _topics(options: argparse.Namespace, recording: RecordedBag, start: Pose | None) -> _Topics:
    """Return what is read of the recording; raises RecordingError if too little is there."""
    scan = recording.require(options.scan_topic, MessageKind.SCAN, "--scan-topic")
    odometry = recording.require(options.odom_topic, MessageKind.ODOMETRY, "--odom-topic")
    gyro: str | None
    if options.imu_topic is not None:
        gyro = recording.require(options.imu_topic, MessageKind.GYRO, "--imu-topic")
    else:
        gyro = recording.beside(odometry, "imu", MessageKind.GYRO)
    own_poses = (
        recording.beside(odometry, "pose", MessageKind.OWN_POSE)
        or recording.beside(odometry, "position", MessageKind.OWN_POSE)
        or recording.beside(odometry, "amcl_pose", MessageKind.OWN_POSE)
    )
    told = None
    if start is None:
        told = recording.beside(odometry, "initialpose", MessageKind.TOLD) or recording.beside(
            odometry, "amcl_pose", MessageKind.TOLD
        )
    kinds = {scan: MessageKind.SCAN, odometry: MessageKind.ODOMETRY}
    lifted = recording.beside(odometry, "wheel_drop", MessageKind.LIFTED)
    for topic, kind in (
        (gyro, MessageKind.GYRO),
        (lifted, MessageKind.LIFTED),
        (own_poses, MessageKind.OWN_POSE),
        (told, MessageKind.TOLD),
    ):
        if topic is not None:
            kinds[topic] = kind
    first = recording.first([odometry], 1)
    base = first[0].child_frame_id if first else ""
    frame = first[0].header.frame_id.lstrip("/") if first else ""
    return _Topics(kinds, own_poses, told, base or "base_link", frame or "odom")


def _mounts(recording: RecordedBag, topics: _Topics) -> tuple[Mounts, bool]:
    """Return where the sensors are, and whether the map -> odometry transform was recorded."""
    mounts = Mounts()
    for message in recording.first(["/tf_static"], _MOUNT_MESSAGES):
        mounts.add(usable_transforms(message.transforms))
    moving = [
        transform
        for message in recording.first(["/tf"], _MOVING_MESSAGES)
        for transform in message.transforms
    ]
    # Some robots tell again and again on /tf what never changes.
    parents_that_move = ("map", topics.odometry_frame)
    fixed = (
        each
        for each in moving
        if each.header.frame_id.lstrip("/") not in parents_that_move
        and not mounts.knows(each.child_frame_id)
    )
    mounts.add(usable_transforms(fixed))
    children = {each.child_frame_id.lstrip("/") for each in moving}
    return mounts, topics.odometry_frame in children


def _files(options: argparse.Namespace, topics: _Topics) -> Iterator[RowFile]:
    if options.csv is not None:
        yield RowTable(options.csv)
    if options.output is not None:
        yield RowBag(options.output, topics.odometry_frame)


def _remarks(options: argparse.Namespace, occupancy: OccupancyMap, start: Pose | None) -> list[str]:
    if start is None:
        return []
    value = occupancy.values[occupancy.frame.cell_of(start.x, start.y)]
    if value == FREE:
        return []
    x, y = start.x, start.y
    return [f"the start ({x:g}, {y:g}) is not on free floor of {options.map}"]


def _how_to_play(recording: RecordedBag, topics: _Topics, *, has_map_transform: bool) -> list[str]:
    """Return what to leave out of the recording to play it beside what was written."""
    if not has_map_transform and not recording.types.keys() & set(OUTPUT_TOPICS):
        return []
    return [
        "the bag has such topics of its own; to play both, leave those out: ./roomba exec rosbag "
        f"filter {recording.path} NEW.bag \"topic not in {OUTPUT_TOPICS} and not (topic == '/tf' "
        f"and any(x.child_frame_id == '{topics.odometry_frame}' for x in m.transforms))\""
    ]


def _plot(options: argparse.Namespace, occupancy: OccupancyMap, tally: Tally) -> None:
    # Imported here: it takes a second, which only a picture needs.
    from roomba_ros.bags.localize_plot import write_plot

    rows = [*tally.rows.rows, tally.last]
    placed = itertools.dropwhile(lambda row: not row.estimate.knowledge.is_usable, rows)
    rows = list(placed) or rows
    title = f"{options.bag.name} on {options.map.name}"
    write_plot(options.plot, occupancy, rows, tally.losses, title)


# ---------------------------------------------------------------- telling


@contextlib.contextmanager
def _progress() -> Iterator[Callable[[float], None]]:
    """Give a function that shows the share of the work that is done, 0..1, on standard error."""
    console = Console(stderr=True)
    told = time.monotonic()
    if not console.is_interactive:

        def tell(share: float) -> None:
            nonlocal told
            if time.monotonic() - told >= _TOLD:
                told = time.monotonic()
                print(f"{100.0 * share:.0f} %", file=sys.stderr, flush=True)

        yield tell
        return
    columns = (TextColumn("Localizing"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    # without a refresh thread, which would take its time from the work
    with Progress(*columns, console=console, auto_refresh=False, transient=True) as progress:
        task = progress.add_task("", total=1.0)

        def draw(share: float) -> None:
            nonlocal told
            if time.monotonic() - told >= _REDRAWN:
                told = time.monotonic()
                progress.update(task, completed=share, refresh=True)

        yield draw


def _tell(options: argparse.Namespace, summary: LocalizationSummary) -> None:
    """Print the table; with figures on standard output it goes to standard error."""
    console = Console(stderr=options.json == "-")
    lines = lines_of(summary)
    width = max(len(name) for name, _ in lines)
    for name, text in lines:
        line = Text.assemble((name.ljust(width), "bold"), f"  {text}")
        console.print(line, highlight=False, soft_wrap=True)
    if options.json is None:
        return
    text = json.dumps(summary.as_json(), indent=2, allow_nan=False)
    if options.json == "-":
        print(text)
    else:
        Path(options.json).write_text(f"{text}\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
