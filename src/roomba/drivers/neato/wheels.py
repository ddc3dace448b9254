"""A twist as distances of the wheels: a velocity loop that ends by itself.

A Neato knows no speeds: it drives both wheels a distance, the farther one at a speed, and stands.
So each command is for as long as the next one may take, and a silent line is a robot that stands.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from roomba.geometry import Twist

STOP: Final = "SetMotor LWheelDisable RWheelDisable"
"""Distances of 0 are passed over by some firmware, which then rolls on for a second."""
ENABLE: Final = "SetMotor LWheelEnable RWheelEnable"
_FASTEST: Final = 0.3
"""m/s, of a wheel."""


@dataclass(frozen=True, slots=True)
class WheelCommand:
    """Distances, mm, ahead above 0, and the speed of the wheel with the longer one, mm/s."""

    left: int
    right: int
    speed: int

    @property
    def text(self) -> str:
        """The command as it is sent."""
        return (
            f"SetMotor LWheelDist {self.left} RWheelDist {self.right} Speed {self.speed} "
            f"Accel {_ACCELERATION}"
        )


_ACCELERATION: Final = 300
"""mm/s2, the most that there is: the wheels then follow soonest."""
GAIN: Final = 1e-3 * _ACCELERATION
"""m/s2."""


def wheel_command(
    twist: Twist, track: float, seconds: float, moving: float = math.inf
) -> WheelCommand | None:
    """Return what drives ``twist`` for ``seconds``; None for standing still.

    ``track`` is how far the wheels are apart, m; ``moving`` how fast the faster wheel goes already,
    m/s: as long as it gains speed it comes less far in that time. Too fast a twist is driven
    slower, along the same curve. Raises ValueError for one that is not finite.
    """
    if not twist.is_finite:
        raise ValueError(f"expected a finite twist, got {twist}")
    half = 0.5 * track * twist.angular
    left, right = twist.linear - half, twist.linear + half
    fastest = max(abs(left), abs(right))
    if fastest > _FASTEST:
        left, right = left * _FASTEST / fastest, right * _FASTEST / fastest
        fastest = _FASTEST
    speed = round(1e3 * fastest)
    if speed == 0:
        return None
    # What it lacks while it gains speed it does not come in that time.
    lacking = max(0.0, fastest - moving)
    gaining = min(seconds, lacking / GAIN)
    full = seconds - gaining * (lacking - 0.5 * GAIN * gaining) / fastest
    ways = round(1e3 * left * full), round(1e3 * right * full)
    if ways == (0, 0):
        return None
    return WheelCommand(*ways, speed)
