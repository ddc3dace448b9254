"""The position loop: from the robot's pose and its setpoint to a twist."""

from __future__ import annotations

import math

from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import ControlConfig
from roomba.geometry import STANDSTILL, Pose, Twist


class PositionLoop:
    """Drives to a setpoint, fixed or moving; turns on the spot when it lies far aside.

    After arrival it stands until it is farther from the setpoint than ``restart_distance``: this
    hysteresis keeps noise and braking from moving it to and fro.
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
            return STANDSTILL
        return Twist(
            self._forward_speed(distance, bearing, max_speed),
            self._turning_speed(bearing),
        )

    @property
    def arrived(self) -> bool:
        """Whether the robot stands at its setpoint."""
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
        # The turning speed that can still be braked before the bearing is zero.
        brakeable = math.sqrt(self._body.max_angular_acceleration * abs(bearing))
        speed = min(self._control.heading_gain * abs(bearing), top, brakeable)
        return math.copysign(speed, bearing)
