"""A twist as distances of the wheels: a velocity loop that ends by itself.

A Neato takes no velocities: it drives each wheel a distance, the longer one at a given speed, and
then stands. So each command lasts as long as the next one may take, and when the line falls silent
the robot stands.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from roomba.geometry import Twist

STOP: Final = "SetMotor LWheelDisable RWheelDisable"
"""Distances of 0 are passed over by some firmware, which then rolls on for a second."""
ENABLE: Final = "SetMotor LWheelEnable RWheelEnable"
_FASTEST_WHEEL: Final = 0.3
"""m/s, of a wheel."""


@dataclass(frozen=True, slots=True)
class WheelCommand:
    """Distances, mm, ahead above 0, and the speed of the wheel with the longer one, mm/s."""

    left: int
    right: int
    speed: int

    @property
    def way(self) -> float:
        """How far the wheel with the longer distance rolls, m."""
        return 1e-3 * max(abs(self.left), abs(self.right))

    @property
    def top_speed(self) -> float:
        """How fast it rolls at most, m/s."""
        return 1e-3 * self.speed

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


@dataclass(frozen=True, slots=True)
class AheadLimit:
    """A wheel may roll ``way`` m ahead, and takes ``seconds`` for it at least."""

    way: float = math.inf
    seconds: float = 0.0


def fastest_ahead(twist: Twist, track: float) -> float:
    """Return how fast the wheel that is faster ahead is to roll, m/s; 0 or less: none rolls ahead.

    No wheel is faster than it can.
    """
    return min(_FASTEST_WHEEL, twist.linear + 0.5 * track * abs(twist.angular))


def wheel_command(
    twist: Twist,
    track: float,
    seconds: float,
    moving: float = math.inf,
    limit: AheadLimit = AheadLimit(),
) -> WheelCommand | None:
    """Return what drives ``twist`` for ``seconds``; None for standing still.

    ``track`` is how far the wheels are apart, m; ``moving`` how fast the faster wheel goes already,
    m/s: while it gains speed, it rolls less far in that time. A twist that is too fast is driven
    slower, along the same curve. A twist that would lead farther ahead than ``limit`` is driven
    slower and less far. Raises ValueError for one that is not finite.
    """
    if not twist.is_finite:
        raise ValueError(f"expected a finite twist, got {twist}")
    half = 0.5 * track * twist.angular
    left, right = twist.linear - half, twist.linear + half
    left, right = _scaled(left, right, _share(_FASTEST_WHEEL, max(abs(left), abs(right))))
    left, right = _scaled(left, right, _share(limit.way, max(left, right) * limit.seconds))
    fastest = max(abs(left), abs(right))
    speed = round(1e3 * fastest)
    if speed == 0:
        return None
    # While the wheel gains speed it rolls less far, so its way is made shorter.
    lacking = max(0.0, fastest - moving)
    gaining = min(seconds, lacking / GAIN)
    full = seconds - gaining * (lacking - 0.5 * GAIN * gaining) / fastest
    full *= _share(limit.way, full * max(left, right))
    ways = round(1e3 * left * full), round(1e3 * right * full)
    if ways == (0, 0):
        return None
    return WheelCommand(*ways, speed)


def _scaled(left: float, right: float, share: float) -> tuple[float, float]:
    return share * left, share * right


def _share(most: float, wanted: float) -> float:
    """Return the share of what is wanted that is not more than ``most``."""
    return most / wanted if wanted > most else 1.0
