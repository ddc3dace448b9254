"""The wheels of a made-up Create 2: what each command makes of them."""

from __future__ import annotations

import pytest

from roomba.emulators.create2.wheels import RequestedWheels
from roomba.geometry import Twist

TRACK = 0.235


@pytest.mark.parametrize(
    ("velocity", "radius", "twist"),
    [
        (200, 0x7FFF, Twist(0.2, 0.0)),
        (-200, -0x8000, Twist(-0.2, 0.0)),
        (235, 1, Twist(0.0, 2.0)),
        (235, -1, Twist(0.0, -2.0)),
        (200, 500, Twist(0.2, 0.4)),
        (200, -500, Twist(0.2, -0.4)),
        (-200, 500, Twist(-0.2, -0.4)),
    ],
)
def test_drive_goes_along_a_curve(velocity: int, radius: int, twist: Twist) -> None:
    wheels = RequestedWheels(TRACK)
    wheels.drive(velocity, radius)
    assert wheels.twist.linear == pytest.approx(twist.linear, abs=1e-3)
    assert wheels.twist.angular == pytest.approx(twist.angular, abs=5e-3)
    assert (wheels.velocity, wheels.radius) == (velocity, radius)


def test_each_wheel_has_its_speed_and_no_more_than_it_can() -> None:
    wheels = RequestedWheels(TRACK)
    wheels.drive_direct(300, 100)
    assert wheels.twist.linear == pytest.approx(0.2)
    assert wheels.twist.angular == pytest.approx(0.2 / TRACK)
    wheels.drive_direct(900, -32640)
    assert (wheels.right, wheels.left) == (500, -500)
    wheels.drive_pwm(255, 255)
    assert (wheels.twist.linear, wheels.twist.angular) == (pytest.approx(0.5), 0.0)
    assert (wheels.right, wheels.left) == (0, 0)
    wheels.halt()
    assert wheels.twist == Twist()
