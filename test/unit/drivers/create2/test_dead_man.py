"""The process that stops a robot when its driver is silent."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fixtures.processes.dead_man import kill_dead_mans_switch
from fixtures.waiting import wait_until

from roomba.drivers.create2.dead_man import SILENT, STOP, DeadManSwitch
from roomba.emulators.pseudo_terminal import PseudoTerminal


@pytest.fixture
def line() -> Iterator[PseudoTerminal]:
    made = PseudoTerminal()
    yield made
    made.close()


def heard(line: PseudoTerminal) -> bytes:
    came = b""
    while piece := line.read(0.0):
        came += piece
    return came


def test_while_the_driver_lives_it_says_nothing(line: PseudoTerminal) -> None:
    switch = DeadManSwitch(line.name)
    switch.start()
    told = [time.monotonic()]
    while told[-1] < told[0] + 5.0 * SILENT:
        switch.tell(True)
        time.sleep(0.02)
        told.append(time.monotonic())
    # On a machine that does much else the driver itself is late now and then.
    was_late = max(np.diff(told)) > 0.5 * SILENT
    assert heard(line) == b"" or was_late
    switch.end()


def test_a_silent_driver_of_a_robot_that_drives_is_replaced_by_the_stop(
    line: PseudoTerminal,
) -> None:
    switch = DeadManSwitch(line.name)
    switch.start()
    switch.tell(True)
    wait_until(lambda: heard(line) == STOP, 5.0, "the stop")
    switch.end()
    assert heard(line) == STOP


def test_a_robot_that_stands_may_be_left_alone(line: PseudoTerminal) -> None:
    switch = DeadManSwitch(line.name)
    switch.start()
    switch.tell(False)
    assert line.read(3.0 * SILENT) == b""
    switch.end()


def test_one_whose_line_is_not_there_does_not_hear_its_driver(tmp_path: Path) -> None:
    switch = DeadManSwitch(str(tmp_path / "nowhere"))
    switch.start()
    wait_until(lambda: not switch.tell(True), 5.0, "it ended")
    assert not switch.tell(True)
    switch.end()


def test_one_that_was_killed_does_not_hear_and_the_next_one_does(line: PseudoTerminal) -> None:
    switch = DeadManSwitch(line.name)
    switch.start()
    assert switch.tell(False)
    kill_dead_mans_switch(line.name)
    wait_until(lambda: not switch.tell(False), 5.0, "it ended")
    switch.start()
    assert switch.tell(True)
    wait_until(lambda: heard(line) == STOP, 5.0, "the stop")
    switch.end()


def test_before_its_start_it_does_not_hear(line: PseudoTerminal) -> None:
    assert not DeadManSwitch(line.name).tell(True)
