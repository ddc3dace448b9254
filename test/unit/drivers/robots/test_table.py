"""The table of robots that people own: each row is whole."""

from __future__ import annotations

from pathlib import Path

import pytest

from roomba.commands.trials.runs import mission_config
from roomba.drivers.line import LineError
from roomba.drivers.robots.table import ROBOTS, LidarLineError, OwnedRobot
from roomba.emulators.pseudo_terminal import PseudoTerminal

ON_WIRES = [robot for robot in ROBOTS.values() if robot.name != "openneato"]
"""Those on a line that may be there and silent."""


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_each_has_numbers_that_the_mission_can_go_by(robot: OwnedRobot) -> None:
    config = robot.config()
    mission_config(config).require_possible(config.body)
    assert config != type(config)()


def test_each_has_a_launch_file_and_there_is_none_without_a_robot() -> None:
    bodies = Path(__file__).parents[4] / "launch" / "bodies"
    assert {file.stem for file in bodies.glob("*.launch")} == {"simulated", *ROBOTS}


@pytest.mark.parametrize("robot", ON_WIRES, ids=[robot.name for robot in ON_WIRES])
def test_a_silent_line_is_told_by_each_driver(robot: OwnedRobot) -> None:
    terminal, lidar = PseudoTerminal(), PseudoTerminal()
    body = robot.body_on(terminal.name, robot.config(), lidar.name if robot.lidar else "")
    with pytest.raises(LineError):
        body.start()
    body.stop()
    terminal.close()
    lidar.close()


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_a_port_that_is_not_there_is_told_with_what_helps(
    robot: OwnedRobot, tmp_path: Path
) -> None:
    none = str(tmp_path / "ttyNone")
    with pytest.raises(LineError, match=r"Is it plugged in|such as neato\.local"):
        robot.body_on(none, robot.config(), none if robot.lidar else "").start()


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_the_line_of_a_lidar_is_asked_for_where_it_has_one_and_refused_else(
    robot: OwnedRobot,
) -> None:
    given, said = ("", "such as /dev/ttyUSB1") if robot.lidar else ("/dev/x", "got /dev/x")
    with pytest.raises(LidarLineError, match=said):
        robot.body_on("/dev/null", robot.config(), given)


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_without_a_lidar_goes_what_can_and_others_say_that_they_do_not(robot: OwnedRobot) -> None:
    if robot.goes_without:
        body = robot.body_on("/dev/null", robot.config(), has_lidar=False)
        assert body.newest_scan() is None
        with pytest.raises(LidarLineError, match="got /dev/x"):
            robot.body_on("/dev/null", robot.config(), "/dev/x", has_lidar=False)
    else:
        with pytest.raises(LidarLineError, match="does not go without"):
            robot.body_on("/dev/null", robot.config(), has_lidar=False)
