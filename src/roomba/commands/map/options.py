"""The command line, parsed and checked before anything heavy is loaded."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NoReturn, TypeAlias

from roomba.commands.sim.trial import RANDOM, Trial, UsageError
from roomba.commands.spelling import spelled
from roomba.geometry import Pose

PROGRAM: Final = spelled("map")
_MOST_SEED: Final = 2**63 - 1
Named: TypeAlias = tuple[str, Path | None]
"""An option, and the file that it names."""


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


class Parser(argparse.ArgumentParser):
    """Says in one line what is wrong."""

    def __init__(self, description: str, epilog: str, program: str = PROGRAM) -> None:
        """Expect options of a command."""
        super().__init__(prog=program, allow_abbrev=False, description=description, epilog=epilog)
        # Python's own pattern knows no exponents: -1e-05 would be taken for an option.
        self._negative_number_matcher = re.compile(r"-(\.?\d|inf|nan)")

    def error(self, message: str) -> NoReturn:
        """Raise UsageError."""
        raise UsageError(f"{message}; see {self.prog} --help")

    def add_output(self) -> None:
        """Add the options of what is told."""
        told = self.add_argument_group("what is told")
        told.add_argument(
            "--out",
            type=Path,
            metavar="FOLDER",
            help="write the map there: map.yaml and map.pgm for map_server, home.yaml with station "
            "and rooms; the folder can be given to --home afterwards",
        )
        told.add_argument(
            "--json",
            nargs="?",
            const="-",
            metavar="FILE|-",
            help="all figures and the way, for programs; -, or nothing: standard output",
        )
        told.add_argument("--plot", type=Path, metavar="FILE.png", help="a picture of the map")
        told.add_argument("--quiet", action="store_true", help="no progress and no table")


def finite(text: str) -> float:
    """Return a number of an option; raises ArgumentTypeError."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"expected finite numbers (m, rad), got {text!r}")
    return number


def options_of(arguments: list[str] | None) -> MapOptions:
    """Return what a command line asks for; raises UsageError, and SystemExit for ``--help``."""
    given = _parser().parse_args(arguments)
    if given.home is not None and given.map is not None:
        raise UsageError("expected --home or --map, got both; leave one of them out")
    trial = Trial(
        home=str(given.map or given.home or "flat"),
        seed=given.seed,
        sensors=given.sensors,
        wheels=given.wheels,
        station=None if given.station is None else Pose(*given.station),
        config=given.config,
        turned=given.turned,
    )
    if given.config is not None and not given.config.is_file():
        raise UsageError(f"--config: expected a file like robot.yaml, got {given.config}")
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


def file_of(name: str | None) -> Path | None:
    """Return the file that figures are written to; None for standard output."""
    return None if name in (None, "-") else Path(str(name))


def check_written(written: Sequence[Named], read: Sequence[Named]) -> None:
    """Refuse before the work what could not be written after it; raises UsageError.

    ``read`` are options with files that must not be overwritten.
    """
    used = {path.expanduser().resolve(): option for option, path in read if path is not None}
    for option, path in written:
        if path is None:
            continue
        if option == "--plot" and path.suffix.lower() != ".png":
            raise UsageError(f"--plot: expected a name that ends with .png, got {path}")
        if path.is_dir() or not path.absolute().parent.is_dir():
            raise UsageError(f"{option}: expected a file in a folder that is there, got {path}")
        other = used.setdefault(path.resolve(), option)
        if other != option:
            raise UsageError(f"{option}: {path} is the file of {other} already; choose another one")


def _parser() -> Parser:
    parser = Parser(
        "Let a robot without a map explore a home, without ROS, as fast as it goes, and tell how "
        "far its map is off the truth.",
        "A recorded drive is mapped with --bag FILE: see ./roomba map --bag --help. Exit "
        "status: 0 all was seen and it docked, 1 ended otherwise, 2 wrong usage. Lengths in m, "
        "angles in rad, map frame.",
    )
    where = parser.add_argument_group("where")
    where.add_argument(
        "--home",
        metavar="NAME|PATH",
        help=f"a home that comes along or a folder like theirs (default: flat); "
        f"{RANDOM}: the one that the seed makes",
    )
    where.add_argument("--map", type=Path, metavar="FILE.yaml", help="any map_server map")
    where.add_argument(
        "--station",
        type=finite,
        nargs=3,
        metavar=("X", "Y", "THETA"),
        help="pose of the docked robot (default: as the layer says, else it is found)",
    )
    where.add_argument(
        "--turned",
        type=finite,
        default=0.0,
        metavar="DEGREES",
        help="turn the home, counter-clockwise about the origin of its map, with its station",
    )
    where.add_argument("--seed", type=_seed, default=0, metavar="N")
    how = parser.add_argument_group("circumstances")
    how.add_argument("--sensors", choices=("noisy", "ideal"), help="default: as configured")
    how.add_argument(
        "--wheels",
        choices=("factory", "worn"),
        help="worn: wheels, gyro and lidar are off by up to 2 %% (default: as configured)",
    )
    how.add_argument("--config", type=Path, metavar="FILE", help="default: the shipped robot.yaml")
    parser.add_output()
    return parser


def _seed(text: str) -> int:
    number = int(text) if re.fullmatch(r"\d{1,20}", text) else -1
    if not 0 <= number <= _MOST_SEED:
        raise argparse.ArgumentTypeError(
            f"expected a whole number from 0 to {_MOST_SEED}, got {text!r}"
        )
    return number
