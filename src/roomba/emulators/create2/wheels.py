"""The wheels of a Create 2: they keep the speed that they were told last, with no time-out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from roomba.drivers.create2.open_interface import FASTEST
from roomba.geometry import Twist

STRAIGHT: Final = (0x7FFF, -0x8000)
"""Radii that mean no curve at all."""
_FARTHEST: Final = 2000
"""mm, of a radius."""
_MOST_PWM: Final = 255


@dataclass(slots=True)
class RequestedWheels:
    """What the packets 39 to 42 tell, mm/s and mm, and how fast the wheels are to turn, m/s.

    ``track`` is how far the wheels are apart, m.
    """

    track: float
    velocity: int = 0
    radius: int = 0
    right: int = 0
    left: int = 0
    _left: float = 0.0
    _right: float = 0.0

    def drive(self, velocity: int, radius: int) -> None:
        """Drive along a curve of ``radius``, mm; above 0 its middle is to the left."""
        velocity = _within(velocity, FASTEST)
        if radius not in STRAIGHT:
            radius = _within(radius, _FARTHEST)
        self.halt()
        self.velocity, self.radius = velocity, radius
        if radius in STRAIGHT or radius == 0:
            left = right = float(velocity)
        elif abs(radius) == 1:
            left, right = -radius * float(velocity), radius * float(velocity)
        else:
            half = 500.0 * self.track
            left, right = velocity * (1.0 - half / radius), velocity * (1.0 + half / radius)
        self._left, self._right = 1e-3 * _within(left, FASTEST), 1e-3 * _within(right, FASTEST)

    def drive_direct(self, right: int, left: int) -> None:
        """Drive each wheel at its speed, mm/s."""
        self.halt()
        self.right, self.left = _within(right, FASTEST), _within(left, FASTEST)
        self._right, self._left = 1e-3 * self.right, 1e-3 * self.left

    def drive_pwm(self, right: int, left: int) -> None:
        """Give each wheel its power, of 255; without load its speed is in proportion (assumed)."""
        scale = FASTEST / _MOST_PWM
        self.halt()
        self._right = 1e-3 * scale * _within(right, _MOST_PWM)
        self._left = 1e-3 * scale * _within(left, _MOST_PWM)

    def halt(self) -> None:
        """Stand."""
        self.velocity = self.radius = self.right = self.left = 0
        self._left = self._right = 0.0

    @property
    def twist(self) -> Twist:
        """How the robot is to move, m/s and rad/s."""
        return Twist(0.5 * (self._left + self._right), (self._right - self._left) / self.track)


def _within(value: float, most: int) -> int:
    return max(-most, min(most, round(value)))
