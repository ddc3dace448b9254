"""Options of a trial that several commands share: the place, and the robot's body."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from roomba.commands.options import MOST_SEED, UsageError, choice, finite, number, whole
from roomba.commands.trials.trial import RANDOM
from roomba.configuration.sensors import lidar_models
from roomba.geometry import Pose

DEFAULT_HOME = "flat"


def add_place(parser: argparse.ArgumentParser) -> argparse._ArgumentGroup:
    """Add ``--home``, ``--map``, ``--station``, ``--turned`` and ``--seed``; return their group."""
    where = parser.add_argument_group("where")
    where.add_argument(
        "--home",
        metavar="NAME|FOLDER",
        help=f"a home that comes along or a folder like theirs (default: {DEFAULT_HOME}); "
        f"{RANDOM}: the one that the seed makes",
    )
    where.add_argument(
        "--map",
        type=Path,
        metavar="FILE.yaml",
        help="any map_server map; without a layer file beside it all that is free and can be "
        "reached is floor to clean",
    )
    where.add_argument(
        "--station",
        type=finite,
        nargs=3,
        metavar=("X", "Y", "THETA"),
        help="pose of the docked robot (default: as the layer says, else it is found)",
    )
    where.add_argument(
        "--turned",
        type=number(math.isfinite, "a finite number (degrees)"),
        default=0.0,
        metavar="DEGREES",
        help="turn the home, counter-clockwise about the origin of its map, with its station; all "
        "other places are in the turned frame",
    )
    where.add_argument("--seed", type=whole(0, MOST_SEED), default=0, metavar="N")
    return where


def add_circumstances(parser: argparse.ArgumentParser) -> argparse._ArgumentGroup:
    """Add ``--sensors``, ``--lidar``, ``--wheels`` and ``--config``; return their group."""
    models = lidar_models()
    how = parser.add_argument_group("circumstances")
    how.add_argument(
        "--sensors",
        type=choice("noisy", "ideal"),
        metavar="noisy|ideal",
        help="default: as the configuration says",
    )
    how.add_argument(
        "--lidar",
        type=choice(*models),
        metavar="NAME",
        help=f"a lidar as sold: {', '.join(models)} (default: as the configuration says)",
    )
    how.add_argument(
        "--wheels",
        type=choice("factory", "worn"),
        metavar="factory|worn",
        help="worn: wheels, gyro and lidar are off by up to 2 %%, and carpets pull aside (default: "
        "as the configuration says)",
    )
    how.add_argument("--config", type=Path, metavar="FILE", help="default: the shipped robot.yaml")
    return how


def check_place(given: argparse.Namespace) -> None:
    """Refuse two homes at once, and a missing map; raises UsageError."""
    if given.map is not None and given.home is not None:
        raise UsageError("expected --home or --map, got both; leave one out")
    if given.map is not None and not given.map.expanduser().is_file():
        raise UsageError(f"--map: expected a file of a map_server map, got {str(given.map)!r}")


def home_name(given: argparse.Namespace) -> str:
    """Return the name or path of the home that is meant."""
    return str(given.map or given.home or DEFAULT_HOME)


def station_of(given: argparse.Namespace) -> Pose | None:
    """Return the pose of the docked robot; None: the home's own station counts."""
    return None if given.station is None else Pose(*given.station)
