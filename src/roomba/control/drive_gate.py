"""The drive gate: the last link before the motors, on the side of the body.

An error in the brain cannot drive the robot: the wheels turn for a fresh command alone, and not
while the emergency stop holds them.
"""

from __future__ import annotations

import math

from roomba.geometry import STANDSTILL, Twist


class DriveGate:
    """Lets the newest command through while it is fresh and nothing holds the drive.

    Speeds in m/s and rad/s, times in s of the robot's clock.
    """

    def __init__(self, command_timeout: float) -> None:
        """Let a command count for ``command_timeout``, s."""
        self._command_timeout = command_timeout
        self._command, self._age = STANDSTILL, math.inf
        self._is_held = False

    @property
    def is_held(self) -> bool:
        """Whether the emergency stop holds the drive."""
        return self._is_held

    def hold(self, is_held: bool) -> None:
        """Hold the drive from now on, or release it; either way the earlier command is dropped."""
        self._is_held = is_held
        self._command = STANDSTILL

    def command(self, twist: Twist) -> None:
        """Take a command; raises ValueError for numbers that cannot be driven."""
        if not twist.is_finite:
            raise ValueError(f"expected finite velocities, got {twist}")
        if not self._is_held:
            self._command, self._age = twist, 0.0

    def step(self, seconds: float) -> Twist:
        """Return the twist of the wheels for the next ``seconds``."""
        self._age += seconds
        # Half a step more: ages are sums of steps, which rounding makes a little longer.
        if self._age > self._command_timeout + 0.5 * seconds:
            self._command = STANDSTILL
        return self._command
