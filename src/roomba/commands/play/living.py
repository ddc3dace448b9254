"""A robot that lives in a simulated home: its command-line options, and how it is made."""

from __future__ import annotations

import argparse
import math
from typing import Final

from roomba.commands.options import MOST_SEED, number, whole
from roomba.commands.trials.homes import playable_home_of, rooms_of
from roomba.commands.trials.runs import mission_config, robot_config_of
from roomba.commands.trials.trial import Trial
from roomba.commands.trials.zones import zones_of
from roomba.configuration.docking import DockingConfig
from roomba.configuration.frozen import load_config
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.simulation import Wheels
from roomba.files.shipped import CONFIGURATION
from roomba.headless.live.client import LiveClient
from roomba.headless.live.playing import Playing
from roomba.headless.live.robot import SPEEDS
from roomba.headless.mission import HeadlessMission

_OPTIONS: Final = ("home", "seed", "speed", "map", "bin", "empties", "wheels")
"""What :func:`add_robot_options` adds."""


def wanted_robot(wanted: argparse.Namespace) -> LiveClient:
    """Return the robot that :func:`add_robot_options` asked for; raises RoombaError."""
    return live_client(
        wanted.home,
        wanted.seed,
        wanted.speed,
        knows_map=wanted.map == "home",
        bin_grams=wanted.bin,
        station_empties=wanted.empties,
        wheels=wanted.wheels,
    )


def live_client(
    name: str,
    seed: int,
    speed: float,
    *,
    knows_map: bool,
    bin_grams: float | None = None,
    station_empties: bool = False,
    wheels: Wheels | None = None,
) -> LiveClient:
    """Return a robot in a home; raises RoombaError."""
    trial = Trial(home=name, seed=seed, bin=bin_grams, wheels=wheels)
    robot = robot_config_of(trial)
    if station_empties:
        robot = robot.with_emptying_station()
    home = playable_home_of(trial, robot.body)
    docking = load_config(DockingConfig, CONFIGURATION / "docking.yaml")
    rooms = rooms_of(home) if knows_map else None
    zones = zones_of(trial) if knows_map else None
    mission = HeadlessMission(
        home,
        robot,
        mission_config(robot),
        docking,
        seed=seed,
        known=None if knows_map else load_config(MappingConfig, CONFIGURATION / "mapping.yaml"),
        rooms=rooms,
        zones=zones,
        longest_burst=int(speed) if speed >= 2.0 else 0,
        empties_bin_after=math.inf,
    )
    # The household tells when the bin is emptied.
    mission.is_emptied_at_station = False
    return LiveClient(Playing(home, mission), mission, rooms, speed, zones=zones)


def require_demo(parser: argparse.ArgumentParser, wanted: argparse.Namespace) -> None:
    """End with status 2 if options of a robot of its own are given without ``--demo``."""
    for name in _OPTIONS:
        if not wanted.demo and getattr(wanted, name) != parser.get_default(name):
            parser.error(f"--{name}: of a robot in a simulated home, so expected --demo as well")


def add_robot_options(parser: argparse._ActionsContainer) -> None:
    """Add the robot's home, and how it lives there."""
    parser.add_argument(
        "--home", default="flat", metavar="NAME|FOLDER", help="the home (default: flat)"
    )
    parser.add_argument(
        "--seed",
        type=whole(0, MOST_SEED),
        default=0,
        metavar="N",
        help="of its dirt and of its sensors' errors: the same one makes the same (default: 0)",
    )
    parser.add_argument(
        "--speed",
        type=_speed,
        default=1.0,
        metavar="N",
        help=f"the robot's seconds per second, {SPEEDS[0]:g} to {SPEEDS[1]:g} (default: 1)",
    )
    parser.add_argument(
        "--map",
        choices=("home", "none"),
        default="home",
        metavar="home|none",
        help="whether the robot knows the home, or makes a map of it (default: home)",
    )
    parser.add_argument(
        "--bin",
        type=_positive,
        metavar="GRAMS",
        help="how much its dust bin takes (default: as the configuration says)",
    )
    parser.add_argument(
        "--empties",
        action="store_true",
        help="its station empties its bin (docs/household.md)",
    )
    parser.add_argument(
        "--wheels",
        choices=("factory", "worn"),
        metavar="factory|worn",
        help="worn: wheels, gyro and lidar are off by up to 2 %% (default: as configured)",
    )


_positive = number(lambda value: 0.0 < value < math.inf, "a number above 0")
_speed = number(
    lambda value: SPEEDS[0] <= value <= SPEEDS[1],
    f"a number from {SPEEDS[0]:g} to {SPEEDS[1]:g}",
)
