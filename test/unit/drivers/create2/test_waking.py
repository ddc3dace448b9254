"""Pulses on the pin that wakes a Create 2, on a line whose pin leads to a made-up one."""

from __future__ import annotations

import pytest
from fixtures.robots.create2_rig import create2_in_studio

from roomba.drivers.create2.open_interface import Opcode
from roomba.drivers.create2.waking import HIGH_TIME, PULSE_PERIOD, PULSE_TIME, WAKING_TIME, BrcPin
from roomba.drivers.line import SerialLine
from roomba.emulators.create2.instructions import Instruction
from roomba.emulators.create2.robot import SLEEPS_AFTER, Create2Robot
from roomba.emulators.living import STEP
from roomba.emulators.pseudo_terminal import PseudoTerminal


class PinnedLine:
    """A line whose pin leads to a robot; to wait on it lets time pass for the robot, too."""

    def __init__(self, robot: Create2Robot, slower: int = 1) -> None:
        self.robot, self.has_pin = robot, True
        self._step = STEP * slower
        self.now = 0.0
        self.levels: list[tuple[float, bool]] = []

    def read(self, seconds: float) -> bytes:
        for _ in range(max(1, round(seconds / self._step))):
            self.robot.advance()
            self.now += self._step
        return b""

    def pull(self, *, is_low: bool) -> bool:
        if self.has_pin:
            self.levels.append((self.now, is_low))
            self.robot.pull_brc(is_low=is_low)
        return self.has_pin


@pytest.fixture
def line() -> PinnedLine:
    robot = Create2Robot(create2_in_studio(), sleeps_after=0.5)
    robot.do(Instruction(Opcode.START))
    return PinnedLine(robot)


def test_a_pulse_wakes_it_and_is_too_long_to_change_its_rate(line: PinnedLine) -> None:
    line.read(1.0)
    assert line.robot.is_asleep
    # Its pin may be low already, as of a port that was just opened.
    line.robot.pull_brc(is_low=True)
    line.robot.is_asleep = True
    began = line.now
    assert BrcPin(lambda: line.now).wake(line)
    assert not line.robot.is_asleep
    times = [time - began for time, _ in line.levels]
    assert [is_low for _, is_low in line.levels] == [False, True, False]
    assert times == pytest.approx([0.0, HIGH_TIME, HIGH_TIME + PULSE_TIME], abs=0.03)
    assert line.now - began == pytest.approx(HIGH_TIME + PULSE_TIME + WAKING_TIME, abs=0.03)
    assert times[2] - times[1] > 0.5


def test_a_line_without_pins_is_left_at_once(line: PinnedLine) -> None:
    line.has_pin = False
    assert not BrcPin(lambda: line.now).wake(line)
    assert line.now == 0.0


@pytest.mark.parametrize("may_sleep", [True, False])
def test_it_is_kept_awake_while_it_may_fall_asleep(may_sleep: bool) -> None:
    slower = 16
    robot = Create2Robot(create2_in_studio(), sleeps_after=SLEEPS_AFTER / slower)
    robot.do(Instruction(Opcode.START))
    line = PinnedLine(robot, slower)
    pin = BrcPin(lambda: line.now)
    while line.now < SLEEPS_AFTER + 2.0 * PULSE_PERIOD:
        pin.keep_awake(line, may_sleep=may_sleep)
        line.read(0.2)
    assert robot.is_asleep is not may_sleep
    lows = [time for time, is_low in line.levels if is_low]
    assert len(lows) == (7 if may_sleep else 0)


def test_a_pseudo_terminal_has_no_pins() -> None:
    terminal = PseudoTerminal()
    line = SerialLine(terminal.name, 115_200)
    assert not line.pull(is_low=True)
    line.close()
    terminal.close()
