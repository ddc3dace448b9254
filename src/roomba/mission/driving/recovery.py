"""Recovery motions: back off and turn, back off in curves, turn and drive ahead."""

from __future__ import annotations

from roomba.configuration.mission import DrivingConfig
from roomba.geometry import Twist, wrap_angle
from roomba.mission.inputs.senses import Senses


class Recovery:
    """One attempt, the ``number``-th (from 1) of them; it ends by itself."""

    def __init__(self, number: int, config: DrivingConfig, senses: Senses) -> None:
        """Begin where the robot stands."""
        self._config = config.recovery
        self._moves = self._config.moves[(number - 1) % len(self._config.moves)]
        self._speed = config.backing_speed
        self._began, self._from = senses.now, senses.pose

    def tick(self, senses: Senses) -> Twist | None:
        """Return the wanted twist, or None at the end; a clock that is set back ends it."""
        time = senses.now - self._began
        if time < 0.0:
            return None
        for linear, angular, takes in self._moves:
            if time < takes:
                return Twist(linear * self._speed, angular * self._config.turning_speed)
            time -= takes
        return None

    def moved(self, senses: Senses) -> bool:
        """Whether the robot is somewhere else now, or looks another way."""
        turned = wrap_angle(senses.pose.theta - self._from.theta)
        way = senses.pose.distance_to(self._from.x, self._from.y)
        return way > self._config.freed_way or abs(turned) > self._config.freed_turn
