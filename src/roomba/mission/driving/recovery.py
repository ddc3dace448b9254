"""Recovery motions: back off and turn, back off in curves, turn and drive ahead."""

from __future__ import annotations

from typing import Final

from roomba.configuration.mission import DrivingConfig
from roomba.geometry import Twist, wrap_angle
from roomba.mission.inputs.senses import Senses

_TURNING: Final = 1.5
"""rad/s."""
_MOVES: Final = (
    ((-1.0, 0.0, 1.0), (0.0, 1.0, 0.8)),
    ((-1.0, 0.0, 1.0), (0.0, -1.0, 1.6)),
    ((1.0, 0.0, 0.6), (-1.0, 0.6, 1.2), (-1.0, -0.6, 1.2)),
    ((0.0, 1.0, 2.1), (1.0, 0.0, 1.0)),
    ((0.0, -1.0, 4.2), (1.0, 0.0, 1.0)),
)
"""For each attempt: how fast (shares of backing speed and of turning), and how long, s."""
_MOVED: Final = 0.03
_TURNED: Final = 0.3
"""m, rad; after this it is free."""


class Recovery:
    """One attempt, the ``number``-th (from 1) of them; it ends by itself."""

    def __init__(self, number: int, config: DrivingConfig, senses: Senses) -> None:
        """Begin where the robot stands."""
        self._moves = _MOVES[(number - 1) % len(_MOVES)]
        self._speed = config.backing_speed
        self._began, self._from = senses.now, senses.pose

    def tick(self, senses: Senses) -> Twist | None:
        """Return the wanted twist, or None at the end; a clock that is set back ends it."""
        time = senses.now - self._began
        if time < 0.0:
            return None
        for linear, angular, takes in self._moves:
            if time < takes:
                return Twist(linear * self._speed, angular * _TURNING)
            time -= takes
        return None

    def moved(self, senses: Senses) -> bool:
        """Whether the robot is somewhere else now, or looks another way."""
        turned = wrap_angle(senses.pose.theta - self._from.theta)
        way = senses.pose.distance_to(self._from.x, self._from.y)
        return way > _MOVED or abs(turned) > _TURNED
