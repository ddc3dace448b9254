"""The table of robots that people own: each row is whole."""

from __future__ import annotations

from pathlib import Path

import pytest

from roomba.commands.trials.runs import mission_config
from roomba.drivers.line import LineError
from roomba.drivers.robots.table import ROBOTS, OwnedRobot
from roomba.emulators.pseudo_terminal import PseudoTerminal


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_each_has_numbers_that_the_mission_can_go_by(robot: OwnedRobot) -> None:
    config = robot.config()
    mission_config(config).require_possible(config.body)
    assert config != type(config)()


def test_each_has_a_launch_file_and_there_is_none_without_a_robot() -> None:
    bodies = Path(__file__).parents[4] / "launch" / "bodies"
    assert {file.stem for file in bodies.glob("*.launch")} == {"simulated", *ROBOTS}


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_a_silent_line_is_told_by_each_driver(robot: OwnedRobot) -> None:
    terminal = PseudoTerminal()
    body = robot.body_on(terminal.name, robot.config())
    with pytest.raises(LineError):
        body.start()
    body.stop()
    terminal.close()


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_a_port_that_is_not_there_is_told_with_what_helps(
    robot: OwnedRobot, tmp_path: Path
) -> None:
    with pytest.raises(LineError, match="Is it plugged in"):
        robot.body_on(str(tmp_path / "ttyNone"), robot.config())
