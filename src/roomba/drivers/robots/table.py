"""One table of the robots that people own: another robot is another row.

Each row's numbers are in a file of ``data/configuration/robots``: ``numbers`` names it, or
``name``.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.configuration.robot import RobotConfig, load_robot_config
from roomba.drivers.body_clock import BodyClock
from roomba.drivers.create2.body import Create2Body
from roomba.drivers.lidars.ld19 import Ld19Frames
from roomba.drivers.lidars.reader import LidarReader
from roomba.drivers.line import SerialLine
from roomba.drivers.line_body import LineBody
from roomba.drivers.neato.body import NeatoBody
from roomba.drivers.neato.bridge_line import PATIENCE, PER_BYTE, BridgeLine
from roomba.drivers.neato.bridge_remote import BridgeRemote, hands_on_commands
from roomba.drivers.neato.bridge_requests import BridgeAddress
from roomba.drivers.neato.conversation import Conversation
from roomba.drivers.reopened_line import ReopenedLine
from roomba.errors import RoombaError
from roomba.files.shipped import CONFIGURATION
from roomba.robot.remote import RemoteRobot

_NEATO_BAUD: Final = 115_200
_LD19_BAUD: Final = 230_400

MakeBody = Callable[[str, str, RobotConfig], LineBody]
"""Makes the body of a robot on a line, whose lidar may be on another one; raises LineError."""
FindRemote = Callable[[str, RobotConfig], RemoteRobot | None]
"""Returns the robot on a line that can only clean by its own brain; None if it can be driven.

Raises LineError where it is not reached.
"""


class LidarLineError(RoombaError):
    """The lidar's line is missing or of no use, or the robot does not go without its lidar."""


@dataclass(frozen=True, slots=True)
class OwnedRobot:
    """A kind of robot: its ``name`` on the command line, its ``title`` for people, and its body.

    ``lidar`` names a lidar that is mounted on it and has a line of its own; empty: the robot's own
    lidar uses the robot's line. ``goes_without``: it can also do without a lidar, by bumps and
    beams. ``numbers`` names its configuration file, where that is not ``name``. ``find_remote`` is
    set where a line may lead to a robot that can be told what to do but cannot be driven.
    """

    name: str
    title: str
    make_body: MakeBody
    lidar: str = ""
    numbers: str = ""
    goes_without: bool = False
    find_remote: FindRemote | None = None

    @property
    def file(self) -> Path:
        """Its numbers, as for ``--config``."""
        return CONFIGURATION / "robots" / f"{self.numbers or self.name}.yaml"

    def config(self) -> RobotConfig:
        """Return its numbers; raises ConfigError."""
        return load_robot_config(self.file)

    def remote_on(self, line: str, config: RobotConfig) -> RemoteRobot | None:
        """Return the robot on a line that cannot be driven, only told; None where it can be.

        Raises LineError where it is not reached.
        """
        return None if self.find_remote is None else self.find_remote(line, config)

    def body_on(
        self, line: str, config: RobotConfig, lidar_line: str = "", *, has_lidar: bool = True
    ) -> LineBody:
        """Return the body of the robot on a line, not started.

        Raises LidarLineError where the lidar's line is missing or too much, and LineError without a
        line; a body may also raise that when it is started.
        """
        if not has_lidar and (lidar_line or not self.goes_without):
            raise LidarLineError(
                f"expected no line of a lidar, got {lidar_line}"
                if lidar_line
                else f"a {self.title} does not go without its lidar"
            )
        if has_lidar and self.lidar and not lidar_line:
            raise LidarLineError(
                f"expected the line of the {self.lidar} on the {self.title}, such as /dev/ttyUSB1"
            )
        if lidar_line and not self.lidar:
            raise LidarLineError(
                f"the lidar of a {self.title} tells by the robot's line: expected no line for it, "
                f"got {lidar_line}"
            )
        return self.make_body(line, lidar_line, config)


def _neato(port: str, _: str, config: RobotConfig) -> LineBody:
    return _neato_on(ReopenedLine(lambda: SerialLine(port, _NEATO_BAUD)), config)


def _openneato(address: str, _: str, config: RobotConfig) -> LineBody:
    return _neato_on(ReopenedLine(lambda: BridgeLine(address)), config, PATIENCE, PER_BYTE)


def _openneato_remote(address: str, config: RobotConfig) -> RemoteRobot | None:
    place = BridgeAddress.of(address)
    return None if hands_on_commands(place) else BridgeRemote(place, config.lidar)


def _neato_on(
    line: ReopenedLine, config: RobotConfig, patience: float = 0.0, per_byte: float = 0.0
) -> LineBody:
    clock = BodyClock(time.monotonic)
    conversation = Conversation(line, time.monotonic, patience, per_byte)
    return LineBody(NeatoBody(conversation, clock, config), line, clock, config.timing.tick)


class _OpenedByDriver:
    """A line that the driver opens, at the rate that the robot answers to."""

    def reopen(self) -> None:
        """Leave it to the driver's ``begin``."""

    def close(self) -> None:
        """Leave it to the driver's ``end``."""


def _create2(port: str, lidar_port: str, config: RobotConfig) -> LineBody:
    clock = BodyClock(time.monotonic)
    lidar = None
    if lidar_port:
        frames = Ld19Frames(config.lidar)
        lidar = LidarReader(lambda: SerialLine(lidar_port, _LD19_BAUD), frames, clock)
    driver = Create2Body(port, clock, config, lidar=lidar)
    return LineBody(driver, _OpenedByDriver(), clock, config.timing.tick)


_ALL: Final = (
    OwnedRobot("neato", "Neato (XV, Botvac D3 to D7)", _neato),
    OwnedRobot(
        "openneato",
        "Neato behind OpenNeato's bridge",
        _openneato,
        numbers="neato",
        find_remote=_openneato_remote,
    ),
    OwnedRobot(
        "create2", "Create 2 or Roomba 500 to 900", _create2, lidar="LD19", goes_without=True
    ),
)
ROBOTS: Final[Mapping[str, OwnedRobot]] = {robot.name: robot for robot in _ALL}
"""All of them by name."""
