"""The command line, parsed and checked before anything heavy is loaded."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NoReturn

from roomba.commands.sim.trial import MOST_THINGS, RANDOM, Trial, UsageError
from roomba.commands.spelling import spelled
from roomba.configuration.sensors import lidar_models
from roomba.geometry import Pose
from roomba.mission.cleaning.request import CleanRefusedError, CleanRequest
from roomba.vocabulary import MOST_PASSES, CleanMode, FanLevel

PROGRAM: Final = spelled("sim")
MOST_HOMES: Final = 100_000
_MOST_SEED: Final = 2**63 - 1
_LONGEST_WAIT: Final = 3600.0
"""s"""


@dataclass(frozen=True, slots=True)
class SimOptions:
    """``homes`` runs (None: the trial alone), and what is told of them; ``json`` "-" is output."""

    trial: Trial
    homes: int | None
    json: str | None
    plot: Path | None
    bag: Path | None
    quiet: bool
    keep: bool = True
    """Whether one run is kept in the history."""


def options_of(arguments: list[str] | None) -> SimOptions:
    """Return what a command line asks for; raises UsageError, and SystemExit for ``--help``."""
    given = _parser().parse_args(arguments)
    _check_homes(given)
    _check_files(given)
    trial = Trial(
        home=_home_of(given),
        seed=given.seed,
        request=_request_of(given),
        sensors=given.sensors,
        lidar=given.lidar,
        wheels=given.wheels,
        no_go=tuple(_rectangle("--no-go", corners) for corners in given.no_go),
        things=given.things,
        shut_doors=given.shut_doors,
        battery=given.battery,
        station=None if given.station is None else Pose(*given.station),
        config=given.config,
        bin=given.bin,
        empties_bin_after=given.empty_after,
        turned=given.turned,
    )
    return SimOptions(
        trial, given.homes, given.json, given.plot, given.bag, given.quiet, given.keep
    )


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Say in one line what is wrong."""
        raise UsageError(f"{message}; see {PROGRAM} --help")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog=PROGRAM,
        allow_abbrev=False,
        description="Clean a home with the whole robot, without ROS, as fast as it goes.",
        epilog="Exit status: 0 completed and docked, 1 ended otherwise, 2 wrong usage. "
        "Lengths in m, angles in rad, map frame.",
    )
    # Python's own pattern knows no exponents: -1e-05 would be taken for an option.
    parser._negative_number_matcher = re.compile(r"-(\.?\d|inf|nan)")
    _add_place(parser)
    _add_request(parser)
    _add_circumstances(parser)
    _add_output(parser)
    return parser


def _add_place(parser: argparse.ArgumentParser) -> None:
    where = parser.add_argument_group("where")
    where.add_argument(
        "--home",
        metavar="NAME|PATH",
        help=f"a home that comes along or a folder like theirs (default: flat); "
        f"{RANDOM}: the one that the seed makes",
    )
    where.add_argument(
        "--map",
        metavar="FILE.yaml",
        help="any map_server map; without a layer file beside it all that is free and can be "
        "reached is floor to clean",
    )
    where.add_argument(
        "--station",
        type=_finite,
        nargs=3,
        metavar=("X", "Y", "THETA"),
        help="pose of the docked robot (default: as the layer says, else it is found)",
    )
    where.add_argument(
        "--turned",
        type=_finite,
        default=0.0,
        metavar="DEGREES",
        help="turn the home, counter-clockwise about the origin of its map, with its station; all "
        "other places are in the turned frame",
    )
    where.add_argument("--seed", type=_whole(0, _MOST_SEED), default=0, metavar="N")
    where.add_argument(
        "--homes",
        type=_whole(1, MOST_HOMES),
        metavar="N",
        help="so many random homes, of the seeds from --seed on, on all cores",
    )


def _add_request(parser: argparse.ArgumentParser) -> None:
    what = parser.add_argument_group("what")
    modes = tuple(mode.value for mode in CleanMode)
    what.add_argument("--mode", type=_choice(*modes), metavar="|".join(modes))
    what.add_argument(
        "--room", action="append", default=[], metavar="NAME", help="repeated: in this order"
    )
    what.add_argument(
        "--zone",
        action="append",
        default=[],
        type=_finite,
        nargs=4,
        metavar=("X0", "Y0", "X1", "Y1"),
        help="may be repeated",
    )
    what.add_argument("--spot", type=_finite, nargs=2, metavar=("X", "Y"))
    what.add_argument("--passes", type=_whole(1, MOST_PASSES), default=1, metavar="N")
    levels = tuple(level.name.lower() for level in FanLevel)
    what.add_argument("--fan", type=_choice(*levels), default="standard", metavar="|".join(levels))
    what.add_argument(
        "--no-go",
        action="append",
        default=[],
        type=_finite,
        nargs=4,
        metavar=("X0", "Y0", "X1", "Y1"),
        help="where it must not go; may be repeated",
    )


def _add_circumstances(parser: argparse.ArgumentParser) -> None:
    how = parser.add_argument_group("circumstances")
    how.add_argument(
        "--sensors",
        type=_choice("noisy", "ideal"),
        metavar="noisy|ideal",
        help="default: as the configuration says",
    )
    models = lidar_models()
    how.add_argument(
        "--lidar",
        type=_choice(*models),
        metavar="NAME",
        help=f"a lidar as sold: {', '.join(models)} (default: as the configuration says)",
    )
    how.add_argument(
        "--wheels",
        type=_choice("factory", "worn"),
        metavar="factory|worn",
        help="worn: wheels, gyro and lidar are off by up to 2 %%, and carpets pull aside (default: "
        "as the configuration says)",
    )
    how.add_argument(
        "--things",
        type=_whole(0, MOST_THINGS),
        default=0,
        metavar="N",
        help="round things on the floor that the map does not show, where the seed puts them",
    )
    how.add_argument("--shut-doors", action="store_true", help="all doors of the home are shut")
    how.add_argument(
        "--battery", type=_share, default=1.0, metavar="SHARE", help="charge at the start, 0..1"
    )
    how.add_argument(
        "--bin",
        type=_amount,
        metavar="GRAMS",
        help="what the dust bin takes (default: as the configuration says)",
    )
    how.add_argument(
        "--empty-after",
        type=_time,
        default=120.0,
        metavar="S",
        help="how long a full dust bin waits on the station to be emptied (default: 120 s)",
    )
    how.add_argument("--config", type=Path, metavar="FILE", help="default: the shipped robot.yaml")


def _add_output(parser: argparse.ArgumentParser) -> None:
    told = parser.add_argument_group("what is told")
    told.add_argument(
        "--json",
        nargs="?",
        const="-",
        metavar="FILE|-",
        help="all figures and the path, for programs; -, or nothing: standard output",
    )
    told.add_argument("--plot", type=Path, metavar="FILE.png", help="a picture of the run")
    told.add_argument("--bag", type=Path, metavar="FILE.bag", help="a bag of the run, for ROS")
    told.add_argument(
        "--no-history",
        dest="keep",
        action="store_false",
        help="do not keep the run for `report` and `replay`; many runs are never kept",
    )
    told.add_argument("--quiet", action="store_true", help="no progress and no table")


# ---------------------------------------------------------------- values


def _whole(least: int, most: int) -> Callable[[str], int]:
    def whole(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            number = least - 1
        if not least <= number <= most:
            raise argparse.ArgumentTypeError(
                f"expected a whole number from {least} to {most}, got {text!r}"
            )
        return number

    return whole


def _choice(*choices: str) -> Callable[[str], str]:
    def choice(text: str) -> str:
        if text not in choices:
            raise argparse.ArgumentTypeError(f"expected {', '.join(choices)}, got {text!r}")
        return text

    return choice


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _finite(text: str) -> float:
    number = _number(text)
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"expected finite numbers (m, rad), got {text!r}")
    return number


def _share(text: str) -> float:
    number = _number(text)
    if not 0.0 <= number <= 1.0:
        raise argparse.ArgumentTypeError(f"expected a share from 0 to 1, got {text!r}")
    return number


def _amount(text: str) -> float:
    number = _number(text)
    if not 0.0 < number < math.inf:
        raise argparse.ArgumentTypeError(f"expected more than 0 g, got {text!r}")
    return number


def _time(text: str) -> float:
    number = _number(text)
    if not 0.0 <= number <= _LONGEST_WAIT:
        raise argparse.ArgumentTypeError(
            f"expected a time from 0 to {_LONGEST_WAIT:g} s, got {text!r}"
        )
    return number


def _rectangle(option: str, corners: list[float]) -> tuple[float, float, float, float]:
    left, bottom, right, top = corners
    if not (left < right and bottom < top):
        raise UsageError(
            f"{option}: expected lowest x, lowest y, highest x, highest y, got "
            f"{' '.join(f'{value:g}' for value in corners)}; put the smaller numbers first"
        )
    return left, bottom, right, top


# ---------------------------------------------------------------- what belongs together


def _home_of(given: argparse.Namespace) -> str:
    if given.homes is not None:
        return RANDOM
    return str(given.map or given.home or "flat")


def _check_homes(given: argparse.Namespace) -> None:
    """Refuse two homes at once, and what makes sense for one home alone."""
    if given.map is not None and given.home is not None:
        raise UsageError("expected --home or --map, got both; leave one out")
    if given.map is not None and not Path(given.map).expanduser().is_file():
        raise UsageError(f"--map: expected a file of a map_server map, got {given.map!r}")
    if given.homes is None:
        return
    alone: dict[str, Any] = {
        "--home": given.home,
        "--map": given.map,
        "--station": given.station,
        "--room": given.room,
        "--zone": given.zone,
        "--spot": given.spot,
        "--no-go": given.no_go,
        "--plot": given.plot,
        "--bag": given.bag,
    }
    for option, value in alone.items():
        if value:
            raise UsageError(
                f"{option}: expected one home, got --homes {given.homes}; "
                f"for one of them: --home {RANDOM} --seed N"
            )


_NEEDED: Final = {
    "room": CleanMode.ROOMS,
    "zone": CleanMode.ZONES,
    "spot": CleanMode.SPOT,
}
"""What an option means; the mode need not be said then."""


def _request_of(given: argparse.Namespace) -> CleanRequest:
    meant = [name for name in _NEEDED if getattr(given, name)]
    if len(meant) > 1:
        raise UsageError(
            f"expected one of --room, --zone and --spot, got --{meant[0]} and --{meant[1]}; "
            "clean one after the other"
        )
    mode = CleanMode(given.mode) if given.mode else _NEEDED[meant[0]] if meant else CleanMode.WHOLE
    for name in meant:
        if _NEEDED[name] is not mode:
            raise UsageError(
                f"--{name}: expected --mode {_NEEDED[name].value}, or none, got {mode.value}; "
                "leave one of them out"
            )
    if mode is CleanMode.ROOMS and not given.room:
        raise UsageError("--mode rooms: expected --room NAME, got none; name one or more")
    if mode is CleanMode.ZONES and not given.zone:
        raise UsageError("--mode zones: expected --zone X0 Y0 X1 Y1, got none; give one or more")
    try:
        return CleanRequest(
            mode,
            rooms=tuple(given.room),
            zones=tuple(_rectangle("--zone", corners) for corners in given.zone),
            spot=None if given.spot is None else (given.spot[0], given.spot[1]),
            passes=given.passes,
            fan=FanLevel[given.fan.upper()],
            in_order=True,
        )
    except CleanRefusedError as error:
        raise UsageError(str(error)) from error


def _check_files(given: argparse.Namespace) -> None:
    """Refuse, before the run, output that could not be written after it."""
    if given.plot is not None and given.plot.suffix.lower() != ".png":
        raise UsageError(f"--plot: expected a name that ends with .png, got {given.plot}")
    if given.config is not None and not given.config.is_file():
        raise UsageError(f"--config: expected a file like robot.yaml, got {given.config}")
    json_file = Path(given.json) if given.json not in (None, "-") else None
    used: dict[Path, str] = {}
    if given.map is not None:
        used[Path(given.map).expanduser().resolve()] = "--map"
    if given.config is not None:
        used[given.config.resolve()] = "--config"
    for option, path in (("--json", json_file), ("--plot", given.plot), ("--bag", given.bag)):
        if path is None:
            continue
        if path.is_dir() or not path.absolute().parent.is_dir():
            raise UsageError(f"{option}: expected a file in a folder that is there, got {path}")
        other = used.setdefault(path.resolve(), option)
        if other != option:
            raise UsageError(f"{option}: {path} is the file of {other} already; choose another one")
