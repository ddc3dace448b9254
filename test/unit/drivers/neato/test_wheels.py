"""Twists as distances of wheels, and back by the made-up robot's drive."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.drivers.neato.wheels import AheadLimit, WheelCommand, fastest_ahead, wheel_command
from roomba.geometry import Twist

TRACK = 0.248
SPEEDS = st.floats(-0.5, 0.5)
TURNS = st.floats(-4.0, 4.0)


@given(SPEEDS, TURNS)
def test_the_curve_is_that_of_the_twist_and_no_wheel_is_faster_than_it_can(
    linear: float, angular: float
) -> None:
    command = wheel_command(Twist(linear, angular), TRACK, 0.3)
    if command is None:
        assert abs(linear) + 0.5 * TRACK * abs(angular) < 0.01
        return
    assert 0 < command.speed <= 300
    assert max(abs(command.left), abs(command.right)) <= 0.3 * 300 + 1
    wanted = [linear - 0.5 * TRACK * angular, linear + 0.5 * TRACK * angular]
    scale = min(1.0, 0.3 / max(map(abs, wanted)))
    assert command.left == pytest.approx(300.0 * scale * wanted[0], abs=0.51)
    assert command.right == pytest.approx(300.0 * scale * wanted[1], abs=0.51)


@given(st.floats(0.02, 0.3), st.floats(0.0, 0.3), st.floats(0.1, 0.5))
def test_it_comes_as_far_as_it_can_in_that_time(fast: float, moving: float, seconds: float) -> None:
    """It gains 0.3 m/s in a second; what it is compared with goes by small steps."""
    command = wheel_command(Twist(fast, 0.0), TRACK, seconds, moving)
    speed, way, steps = min(moving, fast), 0.0, 1000
    for _ in range(steps):
        speed = min(fast, speed + 0.3 * seconds / steps)
        way += speed * seconds / steps
    assert (0 if command is None else command.left) == pytest.approx(1e3 * way, abs=1.1)


def test_it_is_sent_with_names() -> None:
    command = WheelCommand(60, -60, 200)
    assert command.text == "SetMotor LWheelDist 60 RWheelDist -60 Speed 200 Accel 300"


def test_standing_is_no_distance_and_nonsense_is_refused() -> None:
    assert wheel_command(Twist(), TRACK, 0.3) is None
    with pytest.raises(ValueError, match="expected a finite twist"):
        wheel_command(Twist(math.nan, 0.0), TRACK, 0.3)


@given(SPEEDS, TURNS, st.floats(0.0, 0.1), st.floats(0.0, 0.6))
def test_ahead_it_comes_as_far_as_it_may_and_takes_its_time(
    linear: float, angular: float, way: float, seconds: float
) -> None:
    free = wheel_command(Twist(linear, angular), TRACK, 0.3)
    command = wheel_command(Twist(linear, angular), TRACK, 0.3, limit=AheadLimit(way, seconds))
    ahead = fastest_ahead(Twist(linear, angular), TRACK)
    if ahead <= 0.0:
        assert command == free
    if command is not None:
        assert max(command.left, command.right) <= 1e3 * way + 0.5
        share = max(command.left, command.right) / max(abs(command.left), abs(command.right))
        assert 1e-3 * command.speed * share * seconds <= way + 0.02


def test_with_no_way_ahead_it_stands_and_still_goes_back() -> None:
    none = AheadLimit(0.0, 0.2)
    assert wheel_command(Twist(0.3, 0.0), TRACK, 0.3, limit=none) is None
    assert wheel_command(Twist(0.0, 1.0), TRACK, 0.3, limit=none) is None
    back = wheel_command(Twist(-0.1, 0.0), TRACK, 0.3, limit=none)
    assert back is not None
    assert back.left < 0


def test_the_wheel_that_is_fastest_ahead() -> None:
    assert fastest_ahead(Twist(0.1, 1.0), TRACK) == pytest.approx(0.224)
    assert fastest_ahead(Twist(0.0, -1.0), TRACK) == pytest.approx(0.124)
    assert fastest_ahead(Twist(-0.2, 1.0), TRACK) < 0.0
    assert fastest_ahead(Twist(0.5, 0.0), TRACK) == pytest.approx(0.3)
