"""A made-up Neato that cleans by itself: what starts it, what stops it, and where it drives."""

from __future__ import annotations

import pytest
from fixtures.robots.neato_rig import neato_world

from roomba.emulators.neato.cleaning import OwnCleaning, OwnState
from roomba.emulators.neato.drive import WheelDrive
from roomba.emulators.neato.robot import STEP, NeatoRobot
from roomba.world.engine.state.arrays import Fault


@pytest.fixture
def robot() -> NeatoRobot:
    return NeatoRobot(neato_world())


def live(robot: NeatoRobot, seconds: float) -> None:
    for _ in range(round(seconds / STEP)):
        robot.advance()


def phase(robot: NeatoRobot) -> OwnState:
    return robot.cleaning.phase


@pytest.mark.parametrize("command", ["Clean", "Clean House", "clean ho"])
def test_it_leaves_its_station_sweeps_and_turns_at_walls(robot: NeatoRobot, command: str) -> None:
    assert robot.answer(command) == f"{command}\r\n\x1a"
    assert "UIMGR_STATE_HOUSECLEANINGRUNNING" in robot.answer("GetState")
    headings = set()
    for _ in range(60):
        live(robot, 1.0)
        headings.add(round(robot.seen.pose.theta, 1))
    assert len(headings) > 3
    assert not robot.seen.battery.is_docked
    assert robot.simulator.duty == (pytest.approx(1.0), pytest.approx(0.7))
    assert "Vacuum_RPM,2100" in robot.answer("GetMotors")
    assert "ROTATION_SPEED,4.00" in robot.answer("GetLDSScan")
    assert "CumulativeCleaningTimeInSecs,0000003c" in robot.answer("GetWarranty")


def test_it_backs_off_where_the_floor_ends() -> None:
    robot = NeatoRobot(neato_world("family"))
    robot.answer("Clean House")
    live(robot, 120.0)
    assert phase(robot) is OwnState.HOUSE


def test_a_spot_is_a_spiral_around_where_it_was_put_and_ends(robot: NeatoRobot) -> None:
    robot.answer("Clean House")
    live(robot, 7.0)  # it has room around it then
    robot.answer("Clean Stop")
    middle = robot.seen.pose
    robot.answer("Clean Spot")
    assert "UIMGR_STATE_SPOTCLEANINGRUNNING" in robot.answer("GetState")
    farthest = 0.0
    while phase(robot) is OwnState.SPOT:
        live(robot, 1.0)
        farthest = max(farthest, robot.seen.pose.distance_to(middle.x, middle.y))
        assert robot.cleaning.seconds < 600.0
    assert 0.4 < farthest < 1.6
    assert phase(robot) is OwnState.STANDBY
    assert robot.seen.twist.linear == 0.0


@pytest.mark.parametrize(
    ("start", "running", "paused"),
    [
        ("Clean House", OwnState.HOUSE, OwnState.HOUSE_PAUSED),
        ("Clean Spot", OwnState.SPOT, OwnState.SPOT_PAUSED),
    ],
)
def test_stop_pauses_first_and_ends_then(
    robot: NeatoRobot, start: str, running: OwnState, paused: OwnState
) -> None:
    robot.answer(start)
    live(robot, 3.0)
    robot.answer("Clean Stop")
    live(robot, 0.3)
    assert phase(robot) is paused
    assert robot.seen.twist.linear == 0.0
    assert robot.simulator.duty == (0.0, 0.0)
    robot.answer("Clean")
    assert phase(robot) is running
    robot.answer("Clean Stop")
    robot.answer("Clean Stop")
    assert phase(robot) is OwnState.STANDBY
    robot.answer("Clean Stop")
    assert phase(robot) is OwnState.STANDBY


def test_one_kind_at_a_time(robot: NeatoRobot) -> None:
    assert "only 1 of House,Spot,Stop" in robot.answer("Clean House Spot")
    assert phase(robot) is OwnState.STANDBY


def test_in_the_test_mode_its_buttons_do_nothing(robot: NeatoRobot) -> None:
    robot.answer("Clean House")
    robot.answer("TestMode On")
    assert phase(robot) is OwnState.STANDBY
    robot.answer("Clean House")
    assert phase(robot) is OwnState.STANDBY
    robot.answer("SetMotor LWheelDisable RWheelDisable")
    robot.answer("TestMode Off")
    robot.answer("Clean House")
    live(robot, 3.0)
    assert robot.seen.twist.linear > 0.1


def test_a_hand_that_lifts_it_pauses_it(robot: NeatoRobot) -> None:
    robot.answer("Clean House")
    live(robot, 3.0)
    robot.simulator.inject(Fault.LIFTED, 1.0)
    live(robot, 0.5)
    assert phase(robot) is OwnState.HOUSE_PAUSED


def test_a_low_battery_ends_it(robot: NeatoRobot) -> None:
    robot.answer("Clean House")
    live(robot, 3.0)
    robot.simulator.set_charge(0.19)
    live(robot, 0.1)
    assert phase(robot) is OwnState.STANDBY
    assert robot.drive.is_idle


def test_every_phase_has_a_state_of_its_own() -> None:
    assert len({each.value for each in OwnState}) == len(OwnState)
    assert OwnCleaning(WheelDrive(0.248)).phase is OwnState.STANDBY
