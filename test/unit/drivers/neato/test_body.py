"""A driver and a made-up Neato at the two ends of a pseudo terminal, in real time."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fixtures.robots.neato_rig import NEATO, NeatoRig
from fixtures.waiting import wait_until

from roomba.configuration.robot import load_robot_config
from roomba.drivers.line import LineError, SerialLine
from roomba.drivers.neato.body import NeatoBody
from roomba.drivers.neato.conversation import END, Conversation, SilenceError
from roomba.drivers.neato.wheels import STOP
from roomba.emulators.pseudo_terminal import PseudoTerminal
from roomba.geometry import Twist
from roomba.robot.command import Command
from roomba.robot.readings import ScanReading


@pytest.fixture(params=[None, 115_200], ids=["usb", "serial"])
def rig(request: pytest.FixtureRequest) -> Iterator[NeatoRig]:
    made = NeatoRig(request.param)
    yield made
    made.close()


def test_it_drives_and_its_odometry_is_the_way(rig: NeatoRig) -> None:
    begin = rig.simulator.pose
    rig.drive_until(Twist(0.15, 0.0), lambda: rig.body.read().odometry.x > 0.25, "it drove")
    rig.drive_until(Twist(), lambda: not rig.moves, "it stands")

    def agrees() -> bool:
        told, true = rig.body.read().odometry, rig.simulator.pose
        moved = begin.inverse().compose(true)
        return abs(told.x - moved.x) < 0.005 and abs(told.y - moved.y) < 0.005

    wait_until(agrees, 5.0, "odometry tells where it is")
    assert not rig.errors


def test_its_scans_are_those_of_its_lidar(rig: NeatoRig) -> None:
    scans: list[ScanReading] = []

    def has_come() -> bool:
        rig.body.act(Command())
        scan = rig.body.read().scan
        if scan is not None:
            scans.append(scan)
        return len(scans) > 2

    wait_until(has_come, 20.0, "scans")
    seen, true = scans[-1].ranges, rig.simulator.ranges
    both = np.isfinite(seen) & np.isfinite(true)
    assert both.sum() > 100
    assert np.abs(seen[both] - true[both]).max() <= 0.001
    assert scans[-1].lidar.time_increment == pytest.approx(1.0 / 4.0 / 360.0, rel=0.01)


def test_garbage_on_the_line_is_passed_over(rig: NeatoRig) -> None:
    random = np.random.default_rng(1)
    for _ in range(20):
        rig.terminal.write(random.bytes(200))
    told = rig.body.read().odometry
    rig.drive_until(Twist(0.0, 0.5), lambda: rig.body.read().odometry != told, "it goes on")
    assert all(isinstance(error, SilenceError) for error in rig.errors)


def test_a_line_that_is_gone_is_told() -> None:
    rig = NeatoRig(None)
    rig.server.end()
    rig.terminal.close()
    wait_until(lambda: bool(rig.errors), 10.0, "the driver notices")
    rig.close()


class FailingLine:
    """A line whose other end answers at once, but what is said with ``failing`` the first times."""

    def __init__(self, failing: str, times: int, *, is_gone: bool) -> None:
        self.said: list[str] = []
        self._failing, self._left, self._is_gone = failing, times, is_gone
        self._answer = b""

    def write(self, data: bytes) -> None:
        command = data.decode().strip()
        self.said.append(command)
        self._answer = f"{command}\r\n".encode() + END
        if command != self._failing or self._left == 0:
            return
        self._left -= 1
        self._answer = b""
        if self._is_gone:
            raise LineError("gone")

    def read(self, seconds: float) -> bytes:
        answer, self._answer = self._answer, b""
        return answer

    def discard(self) -> None:
        self._answer = b""

    def close(self) -> None:
        pass


def given_back(line: FailingLine) -> list[str]:
    """Return what a driver says at its end."""
    seconds = itertools.count()  # one goes by at each look at the clock
    talk = Conversation(line, lambda: float(next(seconds)))
    body = NeatoBody(talk, lambda: 0.0, load_robot_config(NEATO))
    body.end()
    return line.said


@pytest.mark.parametrize("is_gone", [False, True])
@pytest.mark.parametrize("times", [1, 2])
@pytest.mark.parametrize("failing", ["SetMotor VacuumOff", "TestMode Off"])
def test_it_is_given_back_though_a_command_is_not_answered(
    failing: str, times: int, *, is_gone: bool
) -> None:
    said = given_back(FailingLine(failing, times, is_gone=is_gone))
    assert said[0] == STOP
    assert said.index(failing) == len(said) - 2 or failing == "TestMode Off"
    assert said.count("TestMode Off") == (times + 1 if failing == "TestMode Off" else 1)
    assert said[-1] == "TestMode Off"


@pytest.mark.parametrize("is_gone", [False, True])
def test_giving_it_back_ends_where_nothing_answers(*, is_gone: bool) -> None:
    assert given_back(FailingLine("TestMode Off", 100, is_gone=is_gone)).count("TestMode Off") == 3


def test_a_port_that_is_not_there_is_told_with_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(LineError, match="Is it plugged in"):
        SerialLine(str(tmp_path / "ttyNone"), 115_200)


def test_a_link_names_the_line_and_replaces_no_file(tmp_path: Path) -> None:
    link = tmp_path / "neato"
    terminal = PseudoTerminal(link)
    assert os.readlink(link) == terminal.name
    terminal.close()
    assert not link.exists()
