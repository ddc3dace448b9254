"""The command line of a recorded drive, parsed before anything heavy is loaded."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.commands.map.options import PROGRAM, Output, add_output, output_of
from roomba.commands.options import Parser
from roomba.geometry import Pose
from roomba.recordings.drives.choice import Wanted

DRIVES: Final = (
    "a planar lidar and odometry: bags of ROS 1 (.bag), bags of ROS 2 (a folder with "
    "metadata.yaml, .db3, .mcap), CARMEN logs (.log, .clf); each also packed by gzip or xz. Needs "
    "no ROS."
)
"""What can be read."""
_FARTHEST_MOUNT: Final = 10.0
"""m; no robot is larger."""
_MOUNT: Final = 3
"""Numbers of --laser."""
_HANGS: Final = {"upside-down": True, "upright": False}
"""Words that may follow them."""


@dataclass(frozen=True, slots=True)
class DriveOptions:
    """Logs that are one drive, what is read of them, and what is told."""

    logs: tuple[Path, ...]
    wanted: Wanted
    trajectory: Path | None
    online: Path | None
    output: Output


def options_of(arguments: list[str] | None) -> DriveOptions:
    """Return what a command line asks for; raises UsageError, and SystemExit for ``--help``."""
    given = _parser().parse_args(arguments)
    written = [("--trajectory", given.trajectory), ("--online", given.online)]
    output = output_of(given, [("--bag", path) for path in given.bag], written)
    return DriveOptions(tuple(given.bag), wanted_of(given), given.trajectory, given.online, output)


def add_read(parser: argparse.ArgumentParser) -> None:
    """Add the options of what is read of a drive: ``--bag``, ``--scan`` and the like."""
    what = parser.add_argument_group("what is read")
    what.add_argument(
        "--bag",
        type=Path,
        nargs="+",
        action="extend",
        required=True,
        metavar="FILE",
        help="one or more that are one drive",
    )
    for name, meaning in (
        ("scan", "the lidar's scans; a topic of a bag, FLASER or the like of a log"),
        ("odom", "the odometry; /tf if it is only told there"),
        ("imu", "the gyro; without it the wheels' turns count alone"),
    ):
        what.add_argument(
            f"--{name}",
            f"--{name}-topic",
            metavar="NAME",
            help=f"{meaning} (default: /{name}, or what there is)",
        )
    what.add_argument(
        "--laser",
        type=_mount,
        metavar="X,Y,YAW[,upside-down]",
        help="where the lidar is on the robot, and whether it hangs upside down; upright: it does "
        "not (default: as the transforms or the log tell, else as the drive shows)",
    )


def wanted_of(given: argparse.Namespace) -> Wanted:
    """Return what is to be read of the logs."""
    laser, is_upside_down = given.laser or (None, None)
    return Wanted(given.scan, given.odom, given.imu, laser, is_upside_down)


def _parser() -> Parser:
    parser = Parser(
        PROGRAM,
        f"Make a map of a recorded drive of any robot with {DRIVES}",
        "A home without a recording: see ./roomba map --help. Lengths in m, angles in rad.",
    )
    add_read(parser)
    add_output(parser)
    parser.add_argument(
        "--trajectory",
        type=Path,
        metavar="FILE",
        help="write where the robot was at each scan, as known at the end: lines 't x y theta'",
    )
    parser.add_argument(
        "--online", type=Path, metavar="FILE", help="the same, as known when it drove there"
    )
    return parser


def _mount(text: str) -> tuple[Pose, bool | None]:
    """Return where the lidar is, and whether it hangs upside down; None: not said."""
    words = text.split(",")
    is_upside_down = _HANGS.get(words[-1].strip())
    try:
        numbers = [float(word) for word in (words if is_upside_down is None else words[:-1])]
    except ValueError:
        numbers = []
    # Comparisons with NaN are false.
    is_mount = len(numbers) == _MOUNT and (
        math.hypot(*numbers[:2]) <= _FARTHEST_MOUNT and abs(numbers[2]) <= math.tau
    )
    if not is_mount:
        raise argparse.ArgumentTypeError(
            f"expected three numbers X,Y,YAW: at most {_FARTHEST_MOUNT:g} m from the robot's "
            "middle, and at most 6.29 rad; and at most one of "
            f"{' or '.join(_HANGS)} after them; got {text!r}"
        )
    return Pose(*numbers), is_upside_down
