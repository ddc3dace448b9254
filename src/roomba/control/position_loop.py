"""The position loop: from where the robot is and where it should be to the twist it wants."""

from __future__ import annotations

import math

from roomba.configuration.robot import BodyConfig, ControlConfig
from roomba.geometry import Pose, Twist

_STANDSTILL = Twist()


class PositionLoop:
    """Drives to a setpoint that may stand or move; turns on the spot for what lies far aside.

    Having arrived it stands until it is farther from that setpoint than ``restart_distance``, so
    that noise and the way of braking do not make it dance.
    """

    def __init__(self, control: ControlConfig, body: BodyConfig) -> None:
        """Take the loop's gains and the body's limits."""
        self._control = control
        self._body = body
        self._arrived_at: tuple[float, float] | None = None

    def tick(self, pose: Pose, target: tuple[float, float], max_speed: float) -> Twist:
        """Return the wanted twist; ``pose`` and ``target`` in one frame, ``max_speed`` in m/s."""
        distance = pose.distance_to(*target)
        bearing = pose.bearing_to(*target)
        if self._is_there(target, distance):
            return _STANDSTILL
        return Twist(
            self._forward_speed(distance, bearing, max_speed),
            self._turning_speed(bearing),
        )

    @property
    def arrived(self) -> bool:
        """Whether it stands at its setpoint."""
        return self._arrived_at is not None

    def _is_there(self, target: tuple[float, float], distance: float) -> bool:
        near = self._control.arrival_tolerance
        if self._arrived_at is not None and math.dist(target, self._arrived_at) < near:
            near = self._control.restart_distance
        self._arrived_at = target if distance < near else None
        return self.arrived

    def _forward_speed(self, distance: float, bearing: float, max_speed: float) -> float:
        if abs(bearing) > self._control.turn_in_place_angle:
            return 0.0
        stopping_speed = math.sqrt(2.0 * self._control.approach_deceleration * distance)
        return min(max_speed, stopping_speed) * math.cos(bearing) ** 2

    def _turning_speed(self, bearing: float) -> float:
        top = min(self._control.turning_speed, self._body.max_angular_speed)
        # What can still be braked away before the bearing is zero.
        brakeable = math.sqrt(self._body.max_angular_acceleration * abs(bearing))
        speed = min(self._control.heading_gain * abs(bearing), top, brakeable)
        return math.copysign(speed, bearing)
