"""The command line, parsed and checked before anything heavy is loaded."""

from __future__ import annotations

import argparse
import math
import re
import shlex
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.commands.options import (
    Parser,
    UsageError,
    check_config,
    check_written,
    choice,
    file_of,
    finite,
    number,
    whole,
)
from roomba.commands.program_name import spelled
from roomba.commands.trials.options import (
    add_circumstances,
    add_place,
    check_place,
    home_name,
    station_of,
)
from roomba.commands.trials.trial import MOST_THINGS, RANDOM, Trial
from roomba.vocabulary import MOST_PASSES, CarpetWay, CleanMode, EdgeOrder, FanLevel

PROGRAM: Final = spelled("sim")
MOST_HOMES: Final = 100_000
_LONGEST_WAIT: Final = 3600.0
"""s"""
_CAN_KEEP: Final = find_spec("fcntl") is not None
"""Whether kept files can be locked, which needs fcntl of Linux and macOS."""


@dataclass(frozen=True, slots=True)
class SimOptions:
    """What is run and what is told: ``homes`` runs, None: one trial; ``json`` "-" is stdout."""

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
    check_place(given)
    _check_homes(given)
    check_config(given.config)
    check_written(
        [("--json", file_of(given.json)), ("--plot", given.plot), ("--bag", given.bag)],
        [("--map", given.map), ("--config", given.config)],
    )
    trial = Trial(
        home=home_name(given) if given.homes is None else RANDOM,
        seed=given.seed,
        request=_request_of(given),
        sensors=given.sensors,
        lidar=given.lidar,
        wheels=given.wheels,
        no_go=tuple(_rectangle("--no-go", corners) for corners in given.no_go),
        things=given.things,
        shut_doors=given.shut_doors,
        battery=given.battery,
        station=station_of(given),
        config=given.config,
        bin=given.bin,
        empties_bin_after=given.empty_after,
        turned=given.turned,
        stages=_stages_of(given.plan),
        code=Path.cwd() if given.plan else None,
    )
    return SimOptions(
        trial, given.homes, given.json, given.plot, given.bag, given.quiet, given.keep and _CAN_KEEP
    )


def repeating(words: list[str]) -> str:
    """Return the command that repeats one of many runs, without its seed, from these ``words``."""
    of_many = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    for option in ("--homes", "--seed"):
        of_many.add_argument(option)
    of_many.add_argument("--json", nargs="?")
    for option in ("--quiet", "--no-history"):
        of_many.add_argument(option, action="store_true")
    _, of_each = of_many.parse_known_args(words)
    return shlex.join([*PROGRAM.split(), "--home", RANDOM, *of_each])


def _parser() -> Parser:
    parser = Parser(
        PROGRAM,
        "Clean a home with the whole robot, without ROS, as fast as it goes.",
        "Exit status: 0 completed and docked, 1 ended otherwise, 2 wrong usage. "
        "Lengths in m, angles in rad, map frame.",
    )
    add_place(parser).add_argument(
        "--homes",
        type=whole(1, MOST_HOMES),
        metavar="N",
        help="so many random homes, of the seeds from --seed on, on all cores",
    )
    _add_request(parser)
    _add_circumstances(parser)
    told = parser.add_told("all figures and the path", "a picture of the run")
    told.add_argument("--bag", type=Path, metavar="FILE.bag", help="a bag of the run, for ROS")
    told.add_argument(
        "--no-history",
        dest="keep",
        action="store_false",
        help="do not keep the run for `report` and `replay`; many runs are never kept, and none in "
        "Windows",
    )
    return parser


def _add_request(parser: argparse.ArgumentParser) -> None:
    what = parser.add_argument_group("what")
    modes = tuple(mode.value for mode in CleanMode)
    what.add_argument("--mode", type=choice(*modes), metavar="|".join(modes))
    what.add_argument(
        "--room", action="append", default=[], metavar="NAME", help="repeated: in this order"
    )
    what.add_argument(
        "--zone",
        action="append",
        default=[],
        type=finite,
        nargs=4,
        metavar=("X0", "Y0", "X1", "Y1"),
        help="may be repeated",
    )
    what.add_argument("--spot", type=finite, nargs=2, metavar=("X", "Y"))
    what.add_argument("--passes", type=whole(1, MOST_PASSES), default=1, metavar="N")
    levels = tuple(level.name.lower() for level in FanLevel)
    what.add_argument("--fan", type=choice(*levels), default="standard", metavar="|".join(levels))
    ways = tuple(way.value.replace(" ", "-") for way in CarpetWay)
    what.add_argument("--carpets", type=choice(*ways), default="boost", metavar="|".join(ways))
    orders = tuple(order.value for order in EdgeOrder)
    what.add_argument("--edges", type=choice(*orders), default="any", metavar="|".join(orders))
    what.add_argument(
        "--no-go",
        action="append",
        default=[],
        type=finite,
        nargs=4,
        metavar=("X0", "Y0", "X1", "Y1"),
        help="where it must not go; may be repeated",
    )


def _add_circumstances(parser: argparse.ArgumentParser) -> None:
    how = add_circumstances(parser)
    how.add_argument(
        "--things",
        type=whole(0, MOST_THINGS),
        default=0,
        metavar="N",
        help="round things on the floor that the map does not show, where the seed puts them",
    )
    how.add_argument(
        "--plan",
        type=_stage,
        action="append",
        default=[],
        metavar="STAGE=MODULE:FUNCTION",
        help="a stage of coverage planning of your own, of a module in this folder or installed; "
        "may be repeated (docs/tutorials/a_coverage_stage.md)",
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


def _stage(text: str) -> tuple[str, str]:
    """Return a stage's name and the import path of its replacement."""
    parts = re.fullmatch(r"(\w+)=([\w.]+:[\w.]+)", text)
    if parts is None:
        raise argparse.ArgumentTypeError(f"expected STAGE=MODULE:FUNCTION, got {text!r}")
    return parts[1], parts[2]


def _stages_of(given: list[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    names = [name for name, _ in given]
    for name in names:
        if names.count(name) > 1:
            raise UsageError(f"--plan: expected each stage once, got {name} twice; leave one out")
    return tuple(sorted(given))


_share = number(lambda value: 0.0 <= value <= 1.0, "a share from 0 to 1")
_amount = number(lambda value: 0.0 < value < math.inf, "more than 0 g")
_time = number(lambda value: 0.0 <= value <= _LONGEST_WAIT, f"a time from 0 to {_LONGEST_WAIT:g} s")


def _rectangle(option: str, corners: list[float]) -> tuple[float, float, float, float]:
    left, bottom, right, top = corners
    if not (left < right and bottom < top):
        raise UsageError(
            f"{option}: expected lowest x, lowest y, highest x, highest y, got "
            f"{' '.join(f'{value:g}' for value in corners)}; put the smaller numbers first"
        )
    return left, bottom, right, top


def _check_homes(given: argparse.Namespace) -> None:
    """Refuse what makes sense for one home alone."""
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
"""The mode that an option implies, so that the mode need not be given."""


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
            fan=FanLevel(given.fan),
            in_order=True,
            carpets=CarpetWay(given.carpets.replace("-", " ")),
            edges=EdgeOrder(given.edges),
        )
    except CleanRefusedError as error:
        raise UsageError(str(error)) from error
