"""How soon a Create 2 stands when its driver, its program or the brain is silent: in real time."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.processes.dead_man import kill_dead_mans_switch
from fixtures.robots.create2_rig import Create2Rig, create2_in_studio
from fixtures.waiting import wait_until

from roomba.drivers.create2.obedience import DisobeyedError
from roomba.geometry import Pose, Twist

PROMISE = 0.5
"""s; so long after the last command the robot stands."""
LOOKS = 0.05
"""s; the looks and the steps of the world are up to so much apart."""
DRIVER = """
import sys, time
from pathlib import Path
from roomba.configuration.robot import load_robot_config as load_config
from roomba.drivers.create2.body import Create2Body
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Twist
from roomba.robot.command import Command

config = load_config(CONFIGURATION / "robots" / "create2.yaml")
body = Create2Body(sys.argv[1], time.monotonic, config)
body.begin()
while True:
    body.act(Command(Twist(-0.1, 0.0)))
    body.serve()
"""
"""A program that drives, and never ends by itself."""


def away() -> Pose:
    return create2_in_studio().pose.compose(Pose(-0.6, 0.0, 0.0))


@pytest.fixture(params=[None, 19_200], ids=["usb", "19200"])
def rig(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Create2Rig]:
    made = Create2Rig(tmp_path, request.param, away())
    yield made
    made.end()


def assert_it_stands_soon(rig: Create2Rig) -> None:
    silent = rig.simulator.time
    wait_until(lambda: not rig.moves, 5.0, "it stands")
    assert rig.simulator.time - silent <= PROMISE + LOOKS


def test_it_stands_when_nothing_more_is_wanted_of_it(rig: Create2Rig) -> None:
    rig.drive_until(Twist(-0.1, 0.0), lambda: rig.moves, "it drives")
    assert_it_stands_soon(rig)


def test_it_stands_when_its_driver_hangs(rig: Create2Rig) -> None:
    rig.drive_until(Twist(-0.1, 0.0), lambda: rig.moves, "it drives")
    rig.stop_serving()
    assert_it_stands_soon(rig)


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP, signal.SIGTERM, signal.SIGINT])
def test_it_stands_when_the_program_that_drives_it_is_killed_or_frozen(
    how: signal.Signals, tmp_path: Path
) -> None:
    rig = Create2Rig(tmp_path, None, away())
    rig.stop_serving()
    rig.body.end()
    words = [sys.executable, "-c", DRIVER, os.fspath(rig.link)]
    program = subprocess.Popen(words, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        wait_until(lambda: rig.moves, 20.0, "it drives")
        program.send_signal(how)
        assert_it_stands_soon(rig)
    finally:
        program.kill()
        program.wait(5.0)
        rig.end()


def test_one_whose_dead_mans_switch_is_killed_gets_another_before_it_drives_on(
    rig: Create2Rig,
) -> None:
    rig.drive_until(Twist(-0.1, 0.0), lambda: rig.moves, "it drives")
    kill_dead_mans_switch(os.fspath(rig.link))
    rig.drive_until(Twist(-0.1, 0.0), lambda: bool(rig.errors), "it is noticed")
    assert "dead man's switch" in str(rig.errors[0])
    rig.drive_until(
        Twist(-0.1, 0.0), lambda: rig.moves and rig.body.trouble == "", "it goes on by itself"
    )
    rig.stop_serving()
    assert_it_stands_soon(rig)


def test_it_stands_when_nothing_comes_from_it_for_two_seconds(rig: Create2Rig) -> None:
    """The wire by which it tells is broken: it is stopped on the other one."""
    rig.drive_until(Twist(-0.1, 0.0), lambda: rig.moves, "it drives")
    silent = rig.simulator.time
    rig.server.is_mute = True
    rig.drive_until(Twist(-0.1, 0.0), lambda: not rig.moves, "it stands")
    assert rig.simulator.time - silent <= PROMISE + LOOKS
    wait_until(lambda: rig.simulator.time > silent + 2.0, 10.0, "two seconds")
    assert not rig.moves
    rig.server.is_mute = False
    rig.drive_until(Twist(-0.1, 0.0), lambda: rig.moves, "it was taken over again, and drives")


def test_a_robot_that_does_not_hear_its_driver_is_told_of(rig: Create2Rig) -> None:
    """The wire by which it is told is broken: nothing stops it, but that is known."""
    rig.drive_until(Twist(-0.1, 0.0), lambda: rig.moves, "it drives")
    rig.server.is_deaf = True
    rig.drive_until(Twist(), lambda: bool(rig.errors), "it is noticed")
    assert rig.moves
    (error, *_) = rig.errors
    assert isinstance(error, DisobeyedError)
    assert "wire" in error.remedy


def test_a_cable_that_is_pulled_while_it_drives_nothing_makes_up_for(tmp_path: Path) -> None:
    """What cannot be held, so that it is known: until the cable is back it drives on."""
    rig = Create2Rig(tmp_path, None, away())
    rig.drive_until(Twist(0.0, 0.5), lambda: rig.moves, "it turns")
    rig.unplug()
    pulled = rig.simulator.time
    wait_until(lambda: rig.simulator.time > pulled + 1.5, 10.0, "time")
    assert rig.moves
    rig.plug()
    wait_until(lambda: not rig.moves, 10.0, "it stands when the driver has it again")
    rig.end()
