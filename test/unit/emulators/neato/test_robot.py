"""A made-up Neato: its answers to commands, and its actions."""

from __future__ import annotations

import pytest

from roomba.configuration.simulation import load_simulated_config
from roomba.drivers.neato import answers
from roomba.emulators.neato.dialects import Model
from roomba.emulators.neato.robot import STEP, NeatoRobot, made_up
from roomba.files.shipped import CONFIGURATION, HOMES
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator


@pytest.fixture(params=list(Model), ids=lambda model: str(model.value))
def robot(request: pytest.FixtureRequest) -> NeatoRobot:
    robots = CONFIGURATION / "robots"
    config = load_simulated_config(robots / "neato.yaml", CONFIGURATION / "simulation.yaml")
    config = made_up(config.with_sensors("ideal"))
    simulator = Simulator(load_home("studio", HOMES, config.body), config, seed=1)
    return NeatoRobot(simulator, request.param)


def lines_of(robot: NeatoRobot, command: str) -> list[str]:
    """The lines of an answer, without echo and end."""
    answer = robot.answer(command)
    assert answer.startswith(f"{command}\r\n")
    assert answer.endswith("\x1a")
    return answer[:-1].split("\r\n")[1:-1]


def live(robot: NeatoRobot, seconds: float) -> None:
    for _ in range(round(seconds / STEP)):
        robot.advance()


def test_motors_want_the_test_mode(robot: NeatoRobot) -> None:
    assert "TestMode must be on" in lines_of(robot, "SetMotor 100 100 100")[0]
    assert lines_of(robot, "TestMode On") == []
    assert lines_of(robot, "SetMotor 100 100 100") == []


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("SetMotor VacuumSpeed 50", "No recognizable parameters"),
        ("SetMotor", "No recognizable parameters"),
        ("SetMotor LWheelDist 100 RWheelDist 100", "all required"),
        ("Dance", "Unknown Cmd: 'Dance'"),
    ],
)
def test_what_it_does_not_do_it_says(robot: NeatoRobot, command: str, said: str) -> None:
    robot.answer("TestMode On")
    assert said in lines_of(robot, command)[0]


def test_wheels_roll_their_distance_and_are_counted(robot: NeatoRobot) -> None:
    robot.answer("TestMode On")
    before = answers.wheel_positions_of(lines_of(robot, "GetMotors"))
    robot.answer("SetMotor LWheelDist 300 RWheelDist 300 Speed 200 Accel 300")
    live(robot, 3.0)
    after = answers.wheel_positions_of(lines_of(robot, "GetMotors"))
    assert after.left - before.left == pytest.approx(0.3, abs=0.005)
    assert after.right - before.right == pytest.approx(0.3, abs=0.005)
    assert robot.seen.twist.linear == 0.0


@pytest.mark.parametrize("command", ["SetMotor LWheelDisable RWheelDisable", "TestMode Off"])
def test_without_power_it_stands_at_once(robot: NeatoRobot, command: str) -> None:
    robot.answer("TestMode On")
    robot.answer("SetMotor 5000 5000 200")
    live(robot, 1.0)
    assert robot.seen.twist.linear > 0.1
    robot.answer(command)
    live(robot, 0.3)
    assert robot.seen.twist.linear == 0.0


def test_its_lidar_has_to_turn(robot: NeatoRobot) -> None:
    robot.answer("TestMode On")
    live(robot, 1.0)
    assert answers.scan_of(lines_of(robot, "GetLDSScan")).rotation == 0.0
    robot.answer("SetLDSRotation On")
    live(robot, 1.0)
    scan = answers.scan_of(lines_of(robot, "GetLDSScan"))
    assert scan.rotation == 4.0
    assert (scan.ranges < 6.0).sum() > 100


def test_it_tells_its_charge_and_what_its_sensors_feel(robot: NeatoRobot) -> None:
    charge = answers.charge_of(lines_of(robot, "GetCharger"))
    assert (charge.level, charge.has_power) == (1.0, True)
    touches = answers.touches_of(lines_of(robot, "GetDigitalSensors"))
    assert touches.has_bin
    felt = (touches.bumper_left, touches.bumper_right, touches.dropped_left)
    assert felt == (False, False, False)
    drops = answers.drops_of(lines_of(robot, "GetAnalogSensors"))
    assert drops.left < 0.06
    robot.answer("TestMode On")
    robot.answer("SetMotor 400 400 200")
    live(robot, 4.0)
    assert not answers.charge_of(lines_of(robot, "GetCharger")).has_power


def test_it_sweeps_with_the_brush_and_the_fan_that_were_switched_on(robot: NeatoRobot) -> None:
    robot.answer("TestMode On")
    assert robot.simulator.duty == (0.0, 0.0)
    robot.answer("SetMotor VacuumOn VacuumSpeed 60")
    robot.answer("SetMotor BrushEnable Brush RPM 1200")
    live(robot, STEP)
    assert robot.simulator.duty == (pytest.approx(1.0), pytest.approx(0.6))
    robot.answer("SetMotor VacuumOff BrushDisable")
    live(robot, STEP)
    assert robot.simulator.duty == (0.0, 0.0)


def test_every_command_that_it_helps_with_is_answered(robot: NeatoRobot) -> None:
    for name in lines_of(robot, "Help")[1:]:
        assert "Unknown" not in robot.answer(name)


def test_it_tells_how_it_stands_as_its_accelerometer_feels_it(robot: NeatoRobot) -> None:
    values = answers.values_of(lines_of(robot, "GetAccel"))
    assert list(values) == ["PitchInDegrees", "RollInDegrees", "XInG", "YInG", "ZInG", "SumInG"]
    assert values["ZInG"] == pytest.approx(1.0, abs=0.01)
    robot.answer("TestMode On")
    robot.answer("SetMotor 2000 2000 300 300")
    live(robot, 0.5)
    speeding = answers.values_of(lines_of(robot, "GetAccel"))
    assert speeding["XInG"] > 0.01
    assert speeding["PitchInDegrees"] < -0.5
