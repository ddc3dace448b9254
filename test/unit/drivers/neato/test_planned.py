"""Where the wheels should be by their commands, against the wheels of the made-up robot."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.drivers.neato.planned import PlannedWheels
from roomba.drivers.neato.wheels import wheel_command
from roomba.emulators.neato.drive import WheelDrive
from roomba.geometry import Twist

TRACK, STEP = 0.248, 0.025
SPEEDS, TURNS = st.floats(-0.3, 0.3), st.floats(-2.0, 2.0)


@given(st.lists(st.tuples(SPEEDS, TURNS), min_size=1, max_size=6))
def test_they_are_where_a_drive_takes_them(twists: list[tuple[float, float]]) -> None:
    """Each twist is told three times, a tenth of a second apart; the last one comes to its end."""
    planned, drive, now, rolled = PlannedWheels(), WheelDrive(TRACK), 0.0, [0.0, 0.0]
    for linear, angular in twists:
        for _ in range(3):
            command = wheel_command(Twist(linear, angular), TRACK, 0.3)
            planned.take(now, command)
            if command is None:
                drive.halt()
            else:
                drive.go(command.left, command.right, command.speed, 300)
            for _ in range(4):
                moved = drive.next(STEP)
                half = 0.5 * TRACK * moved.angular
                rolled[0] += STEP * (moved.linear - half)
                rolled[1] += STEP * (moved.linear + half)
                now += STEP
                # The drive brakes towards the end of a way, and is told steps, not the time.
                assert planned.ways(now) == pytest.approx(rolled, abs=0.02 + 0.004 * now)


def test_they_stand_when_they_are_told_to_and_at_the_end_of_the_way() -> None:
    planned = PlannedWheels()
    assert planned.ways(5.0) == (0.0, 0.0)
    planned.take(10.0, wheel_command(Twist(0.2, 0.0), TRACK, 0.3))
    assert planned.ways(10.0) == (0.0, 0.0)
    assert planned.ways(math.inf) == pytest.approx((0.06, 0.06))
    half_way = planned.ways(10.3)
    assert 0.0 < half_way[0] < 0.06
    planned.take(10.3, None)
    assert planned.ways(99.0) == half_way
