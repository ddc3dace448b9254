"""The check that the wheels obey: the wire to the robot may be broken while it still tells."""

from __future__ import annotations

import math
from typing import Final

from roomba.drivers.line import LineError
from roomba.geometry import STANDSTILL, Twist
from roomba.vocabulary import Hindrance

_LEAST_DISOBEDIENCE: Final = 0.05
"""m/s; a wheel that is faster than told by more than this, or turns back so fast, does not obey."""
_LONGEST_DISOBEDIENCE: Final = 0.5
"""s for which a wheel may disobey: wheels that are told to stand do so much sooner."""
_LONGEST_AFTER_DRIVING: Final = 3.0
"""s since the robot was last told to drive; wheels that turn later are pushed by hand."""


class DisobeyedError(LineError):
    """The robot tells what it senses, but does not do what it is told."""

    trouble = "the robot does not obey"
    remedy = "Switch it off, look whether the wire to it is broken, and switch it on"
    hindrance = Hindrance.DISOBEYS


class Obedience:
    """Compares what a robot was told with what its wheels did."""

    def __init__(self, track: float) -> None:
        """Begin with a robot that stands, whose wheels are ``track`` m apart."""
        self._track = track
        self.forget()

    def forget(self) -> None:
        """Begin anew with a robot that stands."""
        self._drove = self._obeyed = -math.inf

    def is_lost(self, now: float, told: Twist, measured: Twist) -> bool:
        """Whether the wheels turned otherwise than they were told for too long, by ``now``, s."""
        if told != STANDSTILL:
            self._drove = now
        pairs = zip(self._wheels(told), self._wheels(measured), strict=True)
        if now - self._drove > _LONGEST_AFTER_DRIVING or all(_is_obeyed(*pair) for pair in pairs):
            self._obeyed = now
        return now - self._obeyed > _LONGEST_DISOBEDIENCE

    def _wheels(self, twist: Twist) -> tuple[float, float]:
        """Return the speeds of the left and of the right wheel, m/s."""
        apart = 0.5 * self._track * twist.angular
        return twist.linear - apart, twist.linear + apart


def _is_obeyed(told: float, measured: float) -> bool:
    """Whether a wheel is no faster than it was told, m/s; a slower one is held up by something."""
    return min(0.0, told) - _LEAST_DISOBEDIENCE <= measured <= max(0.0, told) + _LEAST_DISOBEDIENCE
