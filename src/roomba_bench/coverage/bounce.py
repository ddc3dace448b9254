"""Random bounce, as in the first robot vacuums: straight on until it bumps, then a random turn."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.geometry import Twist
from roomba_bench.coverage.peer import PeerRobot

_LEAST_TURN: Final = math.pi / 2.0
"""rad; a smaller turn would lead into the same wall again."""
_TURNING: Final = 2.0
"""rad/s."""
_BACK: Final = Twist(-0.1, 0.0)
_BACKING: Final = 0.3
"""s; long enough for the body to lose contact."""


def bounce(robot: PeerRobot, seconds: float, seed: int) -> None:
    """Drive about for a while."""
    random = np.random.default_rng(seed)
    while robot.time < seconds:
        if not robot.touches:
            robot.tick(Twist(robot.speed, 0.0))
            continue
        robot.drive(_BACK, _BACKING)
        turn = random.uniform(_LEAST_TURN, 2.0 * math.pi - _LEAST_TURN)
        way = _TURNING if turn < math.pi else -_TURNING
        robot.drive(Twist(0.0, way), min(turn, 2.0 * math.pi - turn) / _TURNING)
