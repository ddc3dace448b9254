"""How far the wheels should have rolled by their commands, between two answers of theirs."""

from __future__ import annotations

import math

from roomba.drivers.neato.wheels import GAIN, WheelCommand

Ways = tuple[float, float]
"""Of the left and the right wheel, m."""


class PlannedWheels:
    """The ways of both wheels since this object was made, predicted by their commands.

    By a command the wheel with the longer way gains speed up to the speed that it is told, and both
    wheels stand at the end of their ways. How they brake there is left out.
    """

    def __init__(self) -> None:
        """Begin standing."""
        self._at, self._base = -math.inf, (0.0, 0.0)
        self._command: WheelCommand | None = None
        self._began_with = 0.0

    def take(self, at: float, command: WheelCommand | None) -> None:
        """Take a command that the robot heard at a time, s; None: it stands at once."""
        base, speed = self.ways(at), self._speed(at)
        self._at, self._base, self._command = at, base, command
        self._began_with = 0.0 if command is None else min(speed, command.top_speed)

    def ways(self, now: float) -> Ways:
        """Return how far the wheels should have rolled at a time, s."""
        command = self._command
        if command is None:
            return self._base
        share = min(1.0, self._way(now, command.top_speed) / command.way)
        left, right = 1e-3 * command.left * share, 1e-3 * command.right * share
        return self._base[0] + left, self._base[1] + right

    def _way(self, now: float, speed: float) -> float:
        """Return the way of the faster wheel since the command, m, if it had no end."""
        since = max(0.0, now - self._at)
        gaining = min(since, (speed - self._began_with) / GAIN)
        return self._began_with * gaining + 0.5 * GAIN * gaining**2 + speed * (since - gaining)

    def _speed(self, now: float) -> float:
        """Return how fast the faster wheel is to be, m/s."""
        command = self._command
        if command is None:
            return 0.0
        if self._way(now, command.top_speed) >= command.way:
            return 0.0
        return min(command.top_speed, self._began_with + GAIN * max(0.0, now - self._at))
