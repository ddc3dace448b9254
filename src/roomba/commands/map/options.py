"""The command line, parsed and checked before anything heavy is loaded."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.commands.options import (
    Named,
    Parser,
    UsageError,
    check_config,
    check_written,
    file_of,
)
from roomba.commands.program_name import spelled
from roomba.commands.trials.options import (
    add_circumstances,
    add_place,
    check_place,
    home_name,
    station_of,
)
from roomba.commands.trials.trial import Trial

PROGRAM: Final = spelled("map")


@dataclass(frozen=True, slots=True)
class Output:
    """What is told; ``json`` "-" is standard output, ``out`` a folder for the map's files."""

    json: str | None
    plot: Path | None
    out: Path | None
    quiet: bool


@dataclass(frozen=True, slots=True)
class MapOptions:
    """A home that is explored."""

    trial: Trial
    output: Output


def add_output(parser: Parser) -> None:
    """Add the options of what is told of a map."""
    told = parser.add_told("all figures and the way", "a picture of the map")
    told.add_argument(
        "--out",
        type=Path,
        metavar="FOLDER",
        help="write the map there: map.yaml and map.pgm for map_server, home.yaml with station "
        "and rooms; the folder can be given to --home afterwards",
    )


def options_of(arguments: list[str] | None) -> MapOptions:
    """Return what a command line asks for; raises UsageError, and SystemExit for ``--help``."""
    given = _parser().parse_args(arguments)
    check_place(given)
    check_config(given.config)
    trial = Trial(
        home=home_name(given),
        seed=given.seed,
        sensors=given.sensors,
        lidar=given.lidar,
        wheels=given.wheels,
        station=station_of(given),
        config=given.config,
        turned=given.turned,
    )
    read = [("--map", given.map), ("--config", given.config)]
    return MapOptions(trial, output_of(given, read))


def output_of(
    given: argparse.Namespace, read: Sequence[Named], written: Sequence[Named] = ()
) -> Output:
    """Return what is to be told; raises UsageError, before the work, for what cannot be written.

    ``read`` are options with files that must not be overwritten, ``written`` more of what is told.
    """
    if given.out is not None:
        parent = given.out.expanduser().absolute().parent
        if given.out.is_file() or not parent.is_dir():
            raise UsageError(
                f"--out: expected a folder, or a new one in a folder that is there, got {given.out}"
            )
    check_written([("--json", file_of(given.json)), ("--plot", given.plot), *written], read)
    return Output(given.json, given.plot, given.out, given.quiet)


def _parser() -> Parser:
    parser = Parser(
        PROGRAM,
        "Let a robot without a map explore a home, without ROS, as fast as it goes, and tell how "
        "far its map is off the truth.",
        "A recorded drive is mapped with --bag FILE: see ./roomba map --bag --help. Exit "
        "status: 0 all was seen and it docked, 1 ended otherwise, 2 wrong usage. Lengths in m, "
        "angles in rad, map frame.",
    )
    add_place(parser)
    add_circumstances(parser)
    add_output(parser)
    return parser
