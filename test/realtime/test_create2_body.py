"""A driver and a made-up Create 2 at the two ends of a pseudo terminal, in real time."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fixtures.robots.create2_rig import Create2Rig, create2_config
from fixtures.waiting import wait_until

from roomba.drivers.create2.body import Create2Body
from roomba.drivers.create2.open_interface import OpenMode
from roomba.drivers.line import LineError
from roomba.emulators.pseudo_terminal import PseudoTerminal
from roomba.geometry import Pose, Twist
from roomba.robot.command import Command
from roomba.robot.readings import ScanReading
from roomba.world.engine.state.arrays import Fault

BEFORE = Pose(-0.6, 0.0, 0.0)
"""The station, as the robot on it sees the place."""


def away() -> Pose:
    from fixtures.robots.create2_rig import create2_in_studio

    return create2_in_studio().pose.compose(BEFORE)


@pytest.fixture(params=[None, 115_200, 19_200], ids=["usb", "115200", "19200"])
def rig(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Create2Rig]:
    made = Create2Rig(tmp_path, request.param, away())
    yield made
    made.end()


@pytest.fixture
def docked(tmp_path: Path) -> Iterator[Create2Rig]:
    made = Create2Rig(tmp_path)
    yield made
    made.end()


@pytest.fixture
def quick(tmp_path: Path) -> Iterator[Create2Rig]:
    made = Create2Rig(tmp_path, None, away())
    yield made
    made.end()


def test_it_drives_and_its_odometry_is_the_way(rig: Create2Rig) -> None:
    begin = rig.simulator.pose
    rig.drive_until(Twist(-0.15, 0.3), lambda: rig.body.read().odometry.x < -0.25, "it drove")
    rig.drive_until(Twist(), lambda: not rig.moves, "it stands")

    def agrees() -> bool:
        told, true = rig.body.read().odometry, rig.simulator.pose
        moved = begin.inverse().compose(true)
        return told.distance_to(moved.x, moved.y) < 0.005 and abs(told.theta - moved.theta) < 0.01

    wait_until(agrees, 5.0, "odometry tells where it is")
    assert not rig.errors
    assert rig.robot.mode is OpenMode.SAFE


def test_its_scans_are_those_of_its_lidar(quick: Create2Rig) -> None:
    scans: list[ScanReading] = []

    def has_come() -> bool:
        scan = quick.body.read().scan
        if scan is not None:
            scans.append(scan)
        return len(scans) > 2

    wait_until(has_come, 20.0, "scans", pause=0.02)
    newest = scans[-1]
    assert newest is quick.body.newest_scan() or quick.body.newest_scan() is not None
    seen, true = newest.ranges, quick.simulator.ranges[-np.arange(450)]
    both = np.isfinite(seen) & np.isfinite(true)
    assert both.sum() > 100
    assert np.abs(seen[both] - true[both]).max() <= 0.001
    assert newest.lidar.sweep == pytest.approx(0.1, rel=0.05)
    assert 0.0 < time.monotonic() - newest.stamp < 1.0


def test_brush_and_fan_turn_while_it_drives(rig: Create2Rig) -> None:
    rig.drive_until(Twist(-0.1, 0.0), lambda: rig.simulator.duty[1] > 0.55, "the fan turns")
    assert rig.simulator.duty[0] == pytest.approx(1.0)
    rig.drive_until(Twist(), lambda: rig.simulator.duty == (0.0, 0.0), "they rest")


def test_it_tells_battery_station_and_what_it_feels(rig: Create2Rig) -> None:
    rig.simulator.set_charge(0.5)
    wait_until(lambda: abs(rig.body.read().battery.level - 0.5) < 0.01, 5.0, "the charge")
    assert rig.body.read().battery.capacity == pytest.approx(43.2)
    wait_until(lambda: rig.body.read().beams.leads, 5.0, "the station's beams")
    rig.simulator.inject(Fault.BUMPER_STUCK, 1.0)
    wait_until(lambda: rig.body.read().bumper_left and rig.body.read().bumper_right, 5.0, "a bump")
    rig.simulator.inject(Fault.LIFTED, 1.0)
    wait_until(lambda: rig.body.read().is_lifted, 5.0, "it is lifted")
    rig.simulator.inject(Fault.LIFTED, 0.0)
    wait_until(lambda: rig.robot.mode is OpenMode.SAFE, 5.0, "it is taken over again")


def test_at_a_cliff_it_goes_back_and_not_ahead(quick: Create2Rig) -> None:
    quick.drive_until(Twist(-0.1, 0.0), lambda: quick.moves, "it drives")
    quick.simulator.inject(Fault.CLIFF_DIRTY, 1.0)
    quick.drive_until(
        Twist(0.2, 0.0), lambda: quick.body.read().cliff.any and not quick.moves, "it stands"
    )
    begin = quick.simulator.pose
    until = time.monotonic() + 0.5
    quick.drive_until(Twist(0.2, 0.0), lambda: time.monotonic() > until, "time")
    assert quick.simulator.pose == begin
    quick.drive_until(
        Twist(-0.1, 0.0),
        lambda: quick.simulator.pose.distance_to(begin.x, begin.y) > 0.05,
        "it backs off",
    )


def test_on_its_station_it_charges_and_leaves_it_backwards_alone(docked: Create2Rig) -> None:
    assert docked.body.read().battery.is_docked
    wait_until(lambda: docked.robot.mode is OpenMode.PASSIVE, 5.0, "passive mode, which charges")
    until = time.monotonic() + 0.5
    docked.drive_until(Twist(0.2, 0.0), lambda: time.monotonic() > until, "time")
    assert docked.robot.mode is OpenMode.PASSIVE
    docked.drive_until(
        Twist(-0.15, 0.0), lambda: docked.body.read().odometry.x < -0.15, "it leaves"
    )
    wait_until(lambda: docked.robot.mode is OpenMode.SAFE, 5.0, "safe mode off the station")


@pytest.mark.parametrize("name", ["docked", "quick"])
def test_it_sings_to_be_found_and_does_not_move(name: str, request: pytest.FixtureRequest) -> None:
    rig: Create2Rig = request.getfixturevalue(name)
    begin = rig.simulator.pose
    wait_until(lambda: rig.robot.mode is not OpenMode.OFF, 5.0, "it was taken over")
    rig.body.locate()
    wait_until(lambda: rig.robot.songs.is_playing, 5.0, "it sings")
    wait_until(lambda: not rig.robot.songs.is_playing, 5.0, "it ends")
    assert rig.simulator.pose == begin


def test_garbage_on_the_line_is_passed_over(rig: Create2Rig) -> None:
    random = np.random.default_rng(1)
    for _ in range(50):
        rig.terminal.write(random.bytes(200))
    told = rig.body.read().odometry
    rig.drive_until(Twist(0.0, 0.5), lambda: rig.body.read().odometry != told, "it goes on")
    moved = rig.body.read().odometry
    assert math.hypot(moved.x, moved.y) < 0.02
    assert rig.body.trouble == ""


def test_after_a_reset_of_the_robot_it_is_taken_over_again(quick: Create2Rig) -> None:
    from roomba.drivers.create2.open_interface import Opcode
    from roomba.emulators.create2.instructions import Instruction

    quick.drive_until(Twist(-0.1, 0.0), lambda: quick.body.read().odometry.x < -0.05, "it drives")
    quick.robot.do(Instruction(Opcode.RESET))
    before = quick.body.read().odometry
    quick.drive_until(Twist(-0.1, 0.0), lambda: quick.robot.mode is OpenMode.SAFE, "taken over")
    assert quick.errors
    after = quick.body.read().odometry
    assert after.distance_to(before.x, before.y) < 0.1


def test_unplugged_and_plugged_it_stands_and_goes_on(quick: Create2Rig) -> None:
    quick.drive_until(Twist(-0.1, 0.0), lambda: quick.moves, "it drives")
    quick.unplug()
    wait_until(lambda: quick.body.trouble != "", 5.0, "the driver notices")
    assert quick.body.read().twist == Twist()
    quick.plug()
    wait_until(lambda: not quick.moves, 10.0, "it stands, as nothing more is wanted")
    quick.drive_until(
        Twist(0.0, 0.5), lambda: quick.moves and quick.body.trouble == "", "it goes on"
    )


def test_asleep_on_its_station_it_is_woken_and_leaves(tmp_path: Path) -> None:
    sleeper = Create2Rig(tmp_path, sleeps_after=2.0)
    try:
        wait_until(lambda: sleeper.robot.is_asleep, 10.0, "it falls asleep", pause=0.001)
        wait_until(lambda: "none for 0.5 s" in sleeper.body.trouble, 5.0, "the driver notices")
        wait_until(lambda: sleeper.body.trouble == "", 10.0, "it was woken")
        sleeper.drive_until(
            Twist(-0.15, 0.0), lambda: sleeper.body.read().odometry.x < -0.15, "it leaves"
        )
    finally:
        sleeper.end()


def test_a_robot_that_is_not_there_is_told_with_what_to_do(tmp_path: Path) -> None:
    config = create2_config()
    with pytest.raises(LineError, match="Is it plugged in"):
        Create2Body(str(tmp_path / "ttyNone"), time.monotonic, config).begin()
    silent = PseudoTerminal()
    # Its own clock may stand while its line is gone.
    with pytest.raises(LineError, match="no answer at 115200 or 19200 baud"):
        Create2Body(silent.name, lambda: 0.0, config).begin()
    with pytest.raises(LineError, match="begin"):
        Create2Body(silent.name, time.monotonic, config).serve()
    silent.close()


def test_what_is_no_number_is_not_driven() -> None:
    body = Create2Body("nowhere", time.monotonic, create2_config())
    with pytest.raises(ValueError, match="finite"):
        body.act(Command(Twist(math.nan, 0.0)))


def test_while_its_clock_stands_the_line_is_served_all_the_same(quick: Create2Rig) -> None:
    quick.stop_serving()
    quick.body.end()
    body = Create2Body(str(quick.link), lambda: 7.0, quick.simulator.config)
    body.begin()

    def served() -> bool:
        body.act(Command(Twist(-0.1, 0.0)))
        body.serve()
        return quick.moves

    wait_until(served, 5.0, "it drives", pause=0.0)
    assert body.read().time == 7.0
    quick.robot.is_streaming = False
    with pytest.raises(LineError, match=r"none for 0\.5 s"):
        wait_until(lambda: served() and False, 5.0, "it is told", pause=0.0)
    body.end()
