import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.control.drive_gate import DriveGate
from roomba.geometry import STANDSTILL, Twist

TIMEOUT = 0.15
STEP = 0.01
AHEAD = Twist(0.3, 0.1)


def test_it_stands_before_a_command() -> None:
    assert DriveGate(TIMEOUT).step(STEP) == STANDSTILL


def test_it_is_not_held_at_first() -> None:
    assert DriveGate(TIMEOUT).is_held is False


def test_a_step_that_begins_within_the_time_out_is_driven() -> None:
    gate = DriveGate(0.5)
    gate.command(AHEAD)
    assert [gate.step(1.0), gate.step(1.0)] == [AHEAD, STANDSTILL]


def test_a_command_counts_until_its_time_out() -> None:
    gate = DriveGate(TIMEOUT)
    gate.command(AHEAD)
    twists = [gate.step(STEP) for _ in range(20)]
    assert twists == 15 * [AHEAD] + 5 * [STANDSTILL]


def test_a_repeated_command_goes_on() -> None:
    gate = DriveGate(TIMEOUT)
    for _ in range(5):
        gate.command(AHEAD)
        assert [gate.step(STEP) for _ in range(15)] == 15 * [AHEAD]


def test_a_held_drive_stands_whatever_it_is_told() -> None:
    gate = DriveGate(TIMEOUT)
    gate.command(AHEAD)
    gate.hold(True)
    assert gate.is_held
    assert gate.step(STEP) == STANDSTILL
    gate.command(AHEAD)
    assert gate.step(STEP) == STANDSTILL


def test_what_was_told_to_a_held_drive_is_not_driven_after_the_release() -> None:
    gate = DriveGate(TIMEOUT)
    gate.hold(True)
    gate.command(AHEAD)
    gate.hold(False)
    assert not gate.is_held
    assert gate.step(STEP) == STANDSTILL
    gate.command(AHEAD)
    assert gate.step(STEP) == AHEAD


@pytest.mark.parametrize("bad", [Twist(math.nan, 0.0), Twist(0.0, math.inf)])
def test_what_cannot_be_driven_is_refused_and_the_command_before_counts(bad: Twist) -> None:
    gate = DriveGate(TIMEOUT)
    gate.command(AHEAD)
    with pytest.raises(ValueError, match="finite"):
        gate.command(bad)
    assert gate.step(STEP) == AHEAD


@given(st.lists(st.sampled_from(["command", "hold", "release", "step"]), max_size=60))
def test_it_drives_only_by_a_fresh_command_since_the_last_release(actions: list[str]) -> None:
    gate, is_held, left = DriveGate(TIMEOUT), False, 0
    for action in actions:
        if action == "command":
            gate.command(AHEAD)
            left = 0 if is_held else 15
        elif action == "step":
            assert gate.step(STEP) == (AHEAD if left > 0 else STANDSTILL)
            left -= 1
        else:
            is_held, left = action == "hold", 0
            gate.hold(is_held)
