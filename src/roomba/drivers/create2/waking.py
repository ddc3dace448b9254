"""The pin BRC of a Create 2: pulled low for a second it wakes the robot, and keeps it awake.

In passive mode the robot falls asleep after five minutes, and then hears nothing on its line. A
falling edge on BRC wakes it, or begins the five minutes anew; three short pulses (0.05 to 0.5 s)
would change its rate instead. Source: iRobot Create 2 Open Interface specification (2018). iRobot's
cable leads the adapter's RTS there, others DTR: both are pulled.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, Protocol

HIGH_TIME: Final = 0.1
"""s for which the pin is held high before a pulse, so that the pulse begins with a falling edge."""
PULSE_TIME: Final = 1.0
"""s of a pulse: longer than those that change the rate."""
PULSE_PERIOD: Final = 60.0
"""s between two pulses that keep it awake: one that is lost does not matter."""
WAKING_TIME: Final = 1.0
"""s that it needs to wake, at most; assumed."""
_LOOK_PERIOD: Final = 0.02
"""s between two looks."""


class PinLine(Protocol):
    """A line with pins beside its data."""

    def read(self, seconds: float) -> bytes:
        """Return what comes within ``seconds``."""

    def pull(self, *, is_low: bool) -> bool:
        """Pull its pins low, or let them go; return whether it has any."""


class BrcPin:
    """Pulses on one line; ``wall`` is a clock that never stands, s."""

    def __init__(self, wall: Callable[[], float]) -> None:
        """Pulse nothing yet."""
        self._wall = wall
        self._began = -math.inf
        self._is_low: bool | None = None

    def wake(self, line: PinLine) -> bool:
        """Pulse once, and wait until the robot is awake; False, at once, on a line without pins."""
        if not line.pull(is_low=False):
            return False
        self._is_low, self._began = False, self._wall()
        while self._wall() - self._began < HIGH_TIME + PULSE_TIME + WAKING_TIME:
            self._follow(line)
            line.read(_LOOK_PERIOD)
        return True

    def keep_awake(self, line: PinLine, *, may_sleep: bool) -> None:
        """Begin a pulse each minute while it may fall asleep, and end it in time."""
        if may_sleep and self._wall() - self._began >= PULSE_PERIOD:
            self._began = self._wall()
        self._follow(line)

    def forget(self) -> None:
        """Begin anew, on a line that was opened anew."""
        self._began, self._is_low = -math.inf, None

    def _follow(self, line: PinLine) -> None:
        is_low = HIGH_TIME <= self._wall() - self._began < HIGH_TIME + PULSE_TIME
        if is_low is not self._is_low:
            self._is_low = is_low
            line.pull(is_low=is_low)
