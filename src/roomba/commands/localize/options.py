"""The command line, parsed and checked before anything heavy is loaded."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from roomba.commands.map.drive.options import DRIVES, add_read, wanted_of
from roomba.commands.options import Parser, check_written, file_of, finite
from roomba.commands.program_name import spelled
from roomba.geometry import Pose
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.readings import Kind

PROGRAM: Final = spelled("localize")
_BESIDE: Final = frozenset({Kind.LIFTED, Kind.OWN_POSE})


@dataclass(frozen=True, slots=True)
class LocalizeOptions:
    """A map, logs that are one drive, what is read of them, and what is told.

    ``start`` is where it begins, map frame; ``json`` "-" is standard output.
    """

    map: Path
    logs: tuple[Path, ...]
    start: Pose | None
    wanted: Wanted
    json: str | None
    csv: Path | None
    trajectory: Path | None
    plot: Path | None
    output: Path | None
    quiet: bool


def options_of(arguments: list[str] | None) -> LocalizeOptions:
    """Return what a command line asks for; raises UsageError, and SystemExit for ``--help``."""
    given = _parser().parse_args(arguments)
    check_written(
        [
            ("--json", file_of(given.json)),
            ("--csv", given.csv),
            ("--trajectory", given.trajectory),
            ("--plot", given.plot),
            ("--out", given.output),
        ],
        [("--map", given.map), *(("--bag", path) for path in given.bag)],
    )
    start = None if given.start is None else Pose(*given.start)
    beside = _BESIDE | {Kind.TOLD} if start is None else _BESIDE
    return LocalizeOptions(
        given.map,
        tuple(given.bag),
        start,
        replace(wanted_of(given), beside=beside),
        given.json,
        given.csv,
        given.trajectory,
        given.plot,
        given.output,
        given.quiet,
    )


def _parser() -> Parser:
    parser = Parser(
        PROGRAM,
        f"Localize a recorded drive on a map, of any robot with {DRIVES}",
        "The start is what --start says, else the first pose that was recorded on initialpose or "
        "amcl_pose, else it is searched for in the whole map. Lengths in m, angles in rad, map "
        "frame. Exit status: 0 when it was done, 1 when the drive cannot be used, 2 for wrong "
        "usage.",
    )
    parser.add_argument("--map", type=Path, required=True, metavar="FILE.yaml")
    parser.add_argument(
        "--start", type=finite, nargs=3, metavar=("X", "Y", "THETA"), help="where it begins"
    )
    add_read(parser)
    told = parser.add_told("all figures", "the path on the map")
    told.add_argument("--csv", type=Path, metavar="FILE", help="the path, and how sure it is")
    told.add_argument(
        "--trajectory", type=Path, metavar="FILE", help="the path alone: lines 't x y theta'"
    )
    told.add_argument(
        "--out",
        dest="output",
        type=Path,
        metavar="FILE.bag",
        help="/pose, /amcl_pose, /localization and /tf as a bag of ROS 1, to be played beside the "
        "recorded one",
    )
    # how it was spelled once
    told.add_argument("--output", type=Path, help=argparse.SUPPRESS)
    return parser
