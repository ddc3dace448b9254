"""A robot that people own, on a line: its options, and its life from take-over to give-back."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Final

from roomba.commands.options import UsageError
from roomba.commands.trials.runs import mission_config
from roomba.configuration.docking import DockingConfig
from roomba.configuration.frozen import load_config
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.drivers.line_body import LineBody
from roomba.drivers.robots.table import ROBOTS, OwnedRobot
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose
from roomba.headless.embodied import Embodied
from roomba.headless.live.client import LiveClient
from roomba.headless.live.kept_home import KeptHome
from roomba.headless.live.live_home import RealHome
from roomba.robot.brain import Brain
from roomba.storage.map_store import MapStore, StoredMap
from roomba.storage.maps_folder import maps_folder

_SIMULATED: Final = ("home", "seed", "speed", "bin", "empties", "wheels")
"""Options that only a robot in a simulated home has."""
NOT_DOCKED: Final = (
    "it has no current from a station: where it stands now counts as its station's place"
)
ELSEWHERE: Final = "it did not begin on its station: it looks for its place when it is to drive"

Tell = Callable[[str], object]


def add_line_options(parser: argparse._ActionsContainer) -> None:
    """Add which robot is at the end of which line."""
    parser.add_argument(
        "--robot",
        choices=sorted(ROBOTS),
        help="a robot that you own, in place of a simulated one (docs/real_robots.md): "
        + ", ".join(robot.title for robot in ROBOTS.values()),
    )
    parser.add_argument(
        "--line",
        metavar="DEVICE",
        help="the line that it is on, such as /dev/ttyACM0, or the address of OpenNeato's bridge; "
        "--port is that of the page",
    )
    parser.add_argument(
        "--lidar-line",
        metavar="DEVICE",
        default="",
        help="the line of a lidar that stands on it, such as /dev/ttyUSB1: "
        + ", ".join(
            f"{robot.lidar} of a {robot.title}" for robot in ROBOTS.values() if robot.lidar
        ),
    )


def add_lidar_option(parser: argparse.ArgumentParser) -> None:
    """Add that there is no lidar."""
    parser.add_argument(
        "--lidar",
        choices=("none",),
        help="none: the robot has no lidar; it sweeps by bumps, and goes home by its station's "
        "beams: " + ", ".join(robot.title for robot in ROBOTS.values() if robot.goes_without),
    )


def require_fitting(parser: argparse.ArgumentParser, wanted: argparse.Namespace) -> None:
    """End with status 2 if options of an owned and of a simulated robot are mixed."""
    if (wanted.robot is None) is not (wanted.line is None):
        parser.error("expected --robot NAME and --line DEVICE together")
    if wanted.robot is None and wanted.lidar:
        parser.error("expected --lidar none with --robot NAME alone")
    if wanted.robot is None and wanted.lidar_line:
        parser.error("expected --lidar-line DEVICE with --robot NAME alone")
    for name in _SIMULATED:
        if wanted.robot is not None and getattr(wanted, name) != parser.get_default(name):
            parser.error(f"--{name}: of a simulated robot, so not with --robot")


class OwnedLife:
    """A robot that people own, from taking it over to giving it back.

    With ``makes_map`` the map of an earlier use is forgotten. ``tell`` is called with sentences for
    the user. ``lidar_line`` is the line of a lidar that has its own.
    """

    def __init__(
        self, kind: OwnedRobot, line: str, *, makes_map: bool, tell: Tell, lidar_line: str = ""
    ) -> None:
        """Take the robot over; raises RoombaError with what to do, after giving it back."""
        self._maps = KeptHome(MapStore(maps_folder(), tell), kind.name, tell)
        config = kind.config()
        stored = None if makes_map else self._maps.load()
        self._body: LineBody = kind.body_on(line, config, lidar_line)
        try:
            self._body.start()
            robot = Embodied(self._body, _brain(config, stored), config)
            _tell_place(robot, tell)
            home = RealHome(kind.name)
            rooms, zones = (None, None) if stored is None else (stored.rooms, stored.zones)
            if stored is not None:
                robot.mission.obstacles.low = stored.low_things
                robot.mission.carpets.recall(stored.carpets)
            self.client = LiveClient(home, robot, rooms, 1.0, zones)
            self._maps.start(self.client)
        except BaseException:
            self._body.stop()
            raise

    def end(self) -> None:
        """Let it stand, keep its map, and give it back."""
        try:
            self.client.end()
            self._maps.stop()
        finally:
            self._body.stop()


def _brain(config: RobotConfig, stored: StoredMap | None) -> Brain:
    """Return the brain of a robot with its stored map, or of one that makes a map."""
    mission = mission_config(config)
    docking = load_config(DockingConfig, CONFIGURATION / "docking.yaml")
    if stored is None:
        mapping = load_config(MappingConfig, CONFIGURATION / "mapping.yaml")
        return Brain(mapping, Pose(), config, mission, docking)
    places = stored.occupancy, stored.station
    return Brain(*places, config, mission, docking, rooms=stored.rooms, zones=stored.zones)


def _tell_place(robot: Embodied, tell: Tell) -> None:
    """Tell the user what follows when the robot does not begin on its station."""
    if robot.now.battery.is_docked:
        return
    if robot.brain.localizer is None:
        tell(NOT_DOCKED)
    else:
        robot.brain.localizer.forget("it did not begin on its station")
        tell(ELSEWHERE)


def owned_life(wanted: argparse.Namespace, tell: Tell) -> OwnedLife:
    """Return the robot that :func:`add_line_options` asked for; raises RoombaError."""
    kind, makes_map = kind_of(wanted), wanted.map == "none"
    return OwnedLife(
        kind, wanted.line, makes_map=makes_map, tell=tell, lidar_line=wanted.lidar_line
    )


def kind_of(wanted: argparse.Namespace) -> OwnedRobot:
    """Return the kind of robot that was asked for; raises UsageError where there is none such."""
    if wanted.robot not in ROBOTS:
        raise UsageError(f"--robot: expected one of {', '.join(sorted(ROBOTS))}")
    return ROBOTS[wanted.robot]
