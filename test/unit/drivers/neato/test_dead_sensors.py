"""A Neato that still answers, but without the needed sensor values: it stands, and says so."""

from __future__ import annotations

import pytest
from fixtures.robots.timed_neato import TimedNeato

from roomba.drivers.line import LineError
from roomba.drivers.neato.conversation import SilenceError
from roomba.geometry import Pose, Twist
from roomba.robot.command import Command

LINES = {"usb": (8_000_000, False), "serial": (115_200, False), "bridge": (115_200, True)}
VITAL = {
    "GetMotors": "its wheels",
    "GetDigitalSensors": "its bumpers",
    "GetAnalogSensors": "its drop sensors",
}
SLOW = {"GetLDSScan": "its lidar", "GetCharger": "its battery"}
FAULTS = ["garbled", "renamed", "unanswered"]
ROOM = Pose(0.0, 0.3, 1.57)
"""In the middle of ``family``'s living room."""


class FailingNeato:
    """A robot that answers to ``command`` with a ``fault`` from ``fails`` on."""

    def __init__(self, line: str, command: str, fault: str) -> None:
        baud, is_bridged = LINES[line]
        self.neato = TimedNeato(baud, home="family", is_ideal=True, is_bridged=is_bridged)
        self.fails = False
        self._command, self._fault = command, fault
        self._answer = self.neato.robot.answer
        self.neato.robot.answer = self._said  # type: ignore[method-assign]

    def _said(self, line: str) -> str:
        told = self._answer(line)
        if not self.fails or line != self._command:
            return told
        if self._fault == "unanswered":
            return ""
        echo, _, rest = told.partition("\n")
        if self._fault == "garbled":
            return f"{echo}\n{rest.replace(',', ';')}"
        return f"{echo}\n" + "\n".join(f"New{row}" for row in rest.split("\n"))

    def drive(self, wanted: Twist) -> None:
        self.neato.tick = lambda: self.neato.driver.act(Command(wanted))

    def seconds_until_told(self, longest: float) -> tuple[float, str]:
        """Return how long after its fault began that was told, and how."""
        begin = self.neato.now
        self.fails = True
        while True:
            try:
                self.neato.driver.serve()
            except LineError as error:
                return self.neato.now - begin, str(error)
            assert self.neato.now - begin < longest, "it is not told"

    def turned_in(self, seconds: float) -> float:
        """Return how far its left wheel turns while it is served for so long, rad."""
        begin = self.neato.robot.seen.wheels.left
        self.neato.pass_time(seconds)
        return abs(self.neato.robot.seen.wheels.left - begin)

    def stands_after(self, seconds: float) -> bool:
        """Let time pass while nothing is said on the line; return whether it stands then."""
        self.neato.read(seconds)
        twist = self.neato.robot.seen.twist
        return abs(twist.linear) < 1e-4 and abs(twist.angular) < 1e-3


@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("command", VITAL)
@pytest.mark.parametrize("wanted", [Twist(), Twist(-0.02, 0.0), Twist(0.0, 0.6)], ids=str)
def test_what_it_needs_to_drive_is_told_to_be_missing_and_it_stands(
    line: str, fault: str, command: str, wanted: Twist
) -> None:
    robot = FailingNeato(line, command, fault)
    robot.neato.simulator.put(ROOM)
    robot.drive(wanted)
    robot.neato.pass_time(2.0)
    after, told = robot.seconds_until_told(6.0)
    # Half a second, a scan, and what one answer takes that does not come.
    assert after < {"usb": 1.3, "serial": 2.0, "bridge": 3.5}[line]
    assert command in told
    assert fault == "unanswered" or VITAL[command] in told
    # One that does not answer may not hear either: it stands at the end of what it was told.
    assert robot.stands_after(0.3 if fault == "unanswered" else 0.05)


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("command", SLOW)
def test_without_scans_or_the_charge_it_stands_some_time_later(fault: str, command: str) -> None:
    robot = FailingNeato("usb", command, fault)
    robot.neato.simulator.put(ROOM)
    robot.drive(Twist(0.0, 0.2))
    robot.neato.pass_time(2.0)
    after, told = robot.seconds_until_told(15.0)
    assert 9.0 < after < 13.0
    assert command in told
    assert SLOW[command] in told
    assert robot.stands_after(0.05)


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("command", [*VITAL, *SLOW])
def test_it_is_not_taken_over_before_it_tells_all_of_that(fault: str, command: str) -> None:
    robot = FailingNeato("usb", command, fault)
    robot.fails = True
    for _ in range(3):
        with pytest.raises(LineError, match=command):
            robot.neato.driver.begin()
    robot.fails = False
    robot.neato.driver.begin()
    robot.drive(Twist(0.0, 0.5))
    assert robot.turned_in(2.0) > 1.0


@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("command", [*VITAL, *SLOW])
def test_an_answer_that_is_garbled_now_and_then_is_passed_over(line: str, command: str) -> None:
    robot = FailingNeato(line, command, "garbled")
    robot.neato.simulator.put(ROOM)
    robot.drive(Twist(0.0, 0.5))
    asked = robot.neato.driver
    for _ in range(10):
        robot.fails = True
        asked.serve()
        robot.fails = False
        robot.neato.pass_time(1.0)
    assert robot.turned_in(2.0) > 1.0


def test_without_drops_it_comes_no_farther_than_the_floor_was_seen() -> None:
    robot = FailingNeato("usb", "GetAnalogSensors", "garbled")
    robot.neato.simulator.put(ROOM)
    robot.drive(Twist(0.3, 0.0))
    assert robot.turned_in(2.0) > 5.0
    begin = robot.neato.simulator.pose
    robot.seconds_until_told(2.0)
    assert robot.stands_after(0.05)
    came = robot.neato.simulator.pose
    assert came.distance_to(begin.x, begin.y) < 0.0775


def test_a_lidar_that_turns_no_more_is_told() -> None:
    robot = FailingNeato("usb", "", "")
    robot.neato.robot.is_turning = False
    begin = robot.neato.now
    with pytest.raises(LineError, match=r"GetLDSScan to tell of its lidar.*expected a lidar that"):
        robot.neato.pass_time(20.0)
    assert robot.neato.now - begin > 9.0
    # It begins to turn when it is taken over.
    robot.neato.driver.begin()
    robot.neato.pass_time(12.0)


def test_silence_is_still_told_as_silence() -> None:
    robot = FailingNeato("usb", "", "")
    robot.neato.robot.answer = lambda line: ""  # type: ignore[method-assign]
    with pytest.raises(SilenceError):
        robot.neato.pass_time(2.0)
