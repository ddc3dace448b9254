"""A robot of the same body in the same simulator, for other ways to cover a floor.

In the peers' favour it knows its true pose, its sensors are ideal, and its battery is always full.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.mission import MissionConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator
from roomba_bench.ours_sim import ROBOT

TICK: Final = 0.05
_STEPS: Final = 2
"""Steps of a tick, as our robot has."""
_CHARGED_EACH: Final = 600.0
"""s between two times at which the battery is filled."""
_AIMED: Final = 0.02
"""rad; the robot drives on when its direction is off by less."""
_TURNING: Final = 2.5
_GAIN: Final = 6.0
_ASTRAY: Final = 0.5
"""rad; the robot stops to turn when its direction is off by more."""
_ARRIVED: Final = 0.004
"""m."""
_BRAKING: Final = 0.8
"""m/s2."""
_PATIENCE: Final = 4.0
"""s without coming nearer after which the robot goes on to the next point."""

_TOUCHES: Final = (
    "bumper_left",
    "bumper_right",
    "cliff_left",
    "cliff_front_left",
    "cliff_front_right",
    "cliff_right",
)


class PeerRobot:
    """A robot that drives as told, tick by tick, and records its true pose."""

    def __init__(self, home: Home, start: Pose, seed: int = 0) -> None:
        """Put it at a place where it fits, off the station."""
        self._simulator = Simulator(home, ROBOT.with_sensors("ideal"), seed=seed, start=start)
        self.speed = MissionConfig().driving.speed
        self._rows = [self._row()]
        self._charged = 0.0

    @property
    def time(self) -> float:
        """s since it began."""
        return self._rows[-1][0]

    @property
    def pose(self) -> Pose:
        """Where it truly is."""
        return Pose(*self._rows[-1][1:])

    @property
    def touches(self) -> bool:
        """Whether its bumper is pressed, or a cliff sensor sees no floor."""
        numbers = self._simulator.numbers
        return any(numbers[name] > 0.0 for name in _TOUCHES)

    @property
    def hits(self) -> int:
        """How often the robot bumped."""
        return int(self._simulator.numbers["hits"])

    @property
    def poses(self) -> Floats:
        """Rows t, x, y, theta of all ticks."""
        return np.array(self._rows)

    def tick(self, twist: Twist) -> None:
        """Let a tick pass."""
        if self.time - self._charged > _CHARGED_EACH:
            self._simulator.set_charge(1.0)
            self._charged = self.time
        self._simulator.advance(twist, TICK / _STEPS, _STEPS)
        self._rows.append(self._row())

    def drive(self, twist: Twist, seconds: float) -> None:
        """Drive so for a while."""
        for _ in range(max(1, round(seconds / TICK))):
            self.tick(twist)

    def follow(self, points: Floats) -> int:
        """Turn to each point and drive straight to it; return how many points were not reached."""
        return sum(not self._go_to(float(x), float(y)) for x, y in points[:, :2])

    def _go_to(self, x: float, y: float) -> bool:
        nearest, since, turns = math.inf, self.time, True
        while True:
            here = self.pose
            left = here.distance_to(x, y)
            if left < _ARRIVED:
                return True
            bearing = here.bearing_to(x, y)
            if left < nearest - 0.005 or turns:
                nearest, since = min(nearest, left), self.time if left < nearest else since
            if self.time - since > _PATIENCE + math.pi / _TURNING:
                return False
            turns = abs(bearing) > (_AIMED if turns else _ASTRAY)
            if turns:
                self.tick(Twist(0.0, max(-_TURNING, min(_TURNING, _GAIN * bearing))))
                continue
            ahead = left * math.cos(bearing)
            speed = max(0.03, min(self.speed, math.sqrt(2.0 * _BRAKING * max(ahead, 0.0))))
            # In the last tick the robot goes no farther than the point.
            speed = min(speed, max(ahead, 0.0) / TICK + 0.01)
            steering = wrap_angle(bearing) if left > 0.05 else 0.0
            self.tick(Twist(speed, max(-1.0, min(1.0, _GAIN * steering))))
            if ahead < 0.0:
                return left < 5.0 * _ARRIVED

    def _row(self) -> tuple[float, float, float, float]:
        pose = self._simulator.pose
        return self._simulator.time, pose.x, pose.y, pose.theta
