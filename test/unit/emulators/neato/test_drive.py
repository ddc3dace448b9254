"""The wheels of a made-up Neato: they drive the commanded distance, and then stand."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.emulators.neato.drive import FASTEST, WheelDrive
from roomba.geometry import STANDSTILL

TRACK, STEP = 0.248, 0.025


def driven(drive: WheelDrive) -> tuple[float, float, int]:
    """How far each wheel rolls until the robot stands, m, and the number of steps."""
    left = right = 0.0
    for steps in range(10_000):
        twist = drive.next(STEP)
        if twist == STANDSTILL:
            return left, right, steps
        half = 0.5 * TRACK * twist.angular
        assert max(abs(twist.linear - half), abs(twist.linear + half)) <= 1e-3 * FASTEST + 1e-9
        left, right = left + STEP * (twist.linear - half), right + STEP * (twist.linear + half)
    raise AssertionError("it never stands")


@given(st.integers(-2000, 2000), st.integers(-2000, 2000), st.integers(20, 400))
def test_each_wheel_rolls_its_way_and_stands(left: int, right: int, speed: int) -> None:
    drive = WheelDrive(TRACK)
    drive.go(left, right, speed, None)
    rolled = driven(drive)
    assert rolled[0] == pytest.approx(1e-3 * left, abs=1e-6)
    assert rolled[1] == pytest.approx(1e-3 * right, abs=1e-6)


def test_it_takes_as_long_as_its_speed_says() -> None:
    drive = WheelDrive(TRACK)
    drive.go(300, 300, 100, 300)
    assert driven(drive)[2] * STEP == pytest.approx(3.0, abs=0.5)


def test_zeros_are_passed_over_and_without_power_it_stands_at_once() -> None:
    drive = WheelDrive(TRACK)
    drive.go(1000, 1000, 200, None)
    drive.next(STEP)
    drive.go(0, 0, 0, None)
    assert drive.next(STEP) != STANDSTILL
    drive.halt()
    assert drive.next(STEP) == STANDSTILL
