"""The last stage before the drive: speed limits and hazards."""

from __future__ import annotations

from roomba.configuration.robot import BodyConfig
from roomba.control.speed_loop import SpeedLoop
from roomba.geometry import Twist
from roomba.robot.readings import Readings


class SafeDrive:
    """The speed loop, told of hazards before each command."""

    def __init__(self, body: BodyConfig, max_speed: float) -> None:
        """Begin standing; ``max_speed`` in m/s."""
        self._loop = SpeedLoop(body, max_speed)

    def limit(self, max_speed: float) -> None:
        """Set the robot's top speed, m/s."""
        self._loop.set_max_speed(max_speed)

    def command(self, readings: Readings, twist: Twist) -> Twist:
        """Return the twist that the wheels get when ``twist`` is wanted."""
        loop = self._loop
        loop.set_bumper(readings.bumps)
        loop.set_cliff(readings.cliff.any)
        loop.set_wheel_drop(readings.dropped_left or readings.dropped_right)
        loop.command(readings.time, twist)
        return loop.tick(readings.time)[0]
