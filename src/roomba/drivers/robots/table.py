"""One table of the robots that people own: another robot is another row.

Each has a file of its own in ``data/configuration/robots``, by its name.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.configuration.robot import RobotConfig, load_robot_config
from roomba.drivers.body_clock import BodyClock
from roomba.drivers.driver import Driver
from roomba.drivers.line import Line, SerialLine
from roomba.drivers.line_body import LineBody
from roomba.drivers.neato.body import NeatoBody
from roomba.drivers.neato.conversation import Conversation
from roomba.drivers.reopened_line import ReopenedLine
from roomba.files.shipped import CONFIGURATION

MakeDriver = Callable[[Line, Callable[[], float], RobotConfig], Driver]
"""Makes a driver on a line, with the robot's clock, s; connects nothing."""


@dataclass(frozen=True, slots=True)
class OwnedRobot:
    """A kind of robot: its ``name`` on the command line, its ``title`` for people, and its driver.

    ``baud`` is the speed of its line where that is a serial one.
    """

    name: str
    title: str
    baud: int
    make_driver: MakeDriver

    @property
    def file(self) -> Path:
        """Its numbers, as for ``--config``."""
        return CONFIGURATION / "robots" / f"{self.name}.yaml"

    def config(self) -> RobotConfig:
        """Return its numbers; raises ConfigError."""
        return load_robot_config(self.file)

    def body_on(self, port: str, config: RobotConfig) -> LineBody:
        """Return the body of the robot on a line, not started; raises LineError without a line."""
        line = ReopenedLine(lambda: SerialLine(port, self.baud))
        clock = BodyClock(time.monotonic)
        return LineBody(self.make_driver(line, clock, config), line, clock, config.timing.tick)


def _neato(line: Line, now: Callable[[], float], config: RobotConfig) -> Driver:
    return NeatoBody(Conversation(line, time.monotonic), now, config)


_ALL: Final = (OwnedRobot("neato", "Neato (XV, Botvac D3 to D7)", 115_200, _neato),)
ROBOTS: Final[Mapping[str, OwnedRobot]] = {robot.name: robot for robot in _ALL}
"""All of them by name."""
