"""The messages of round trips; each carries a number, by which its answer is recognized."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

_BYTES = 60
_BEAMS = 360
_SPEEDS = 1000
_SLOWEST = 0.1


@dataclass(frozen=True)
class Kind:
    """A kind of message: its class, how to make one of a number, and how to read that number."""

    message: type
    make: Callable[[int], Any]
    number: Callable[[Any], int]


def _scan(number: int) -> LaserScan:
    return LaserScan(range_max=float(number % 2**20), ranges=[1.5] * _BEAMS, intensities=[])


def _twist(number: int) -> Twist:
    twist = Twist()
    twist.linear.x = _SLOWEST + number % _SPEEDS * 1e-4
    return twist


KINDS = {
    "64 B": Kind(String, lambda n: String(f"{n:0{_BYTES}d}"), lambda m: int(m.data)),
    "scan": Kind(LaserScan, _scan, lambda m: round(m.range_max)),
    "twist": Kind(Twist, _twist, lambda m: round((m.linear.x - _SLOWEST) * 1e4)),
}
"""By name. A twist is below the robot's limits, so that a node passes it on unchanged."""
