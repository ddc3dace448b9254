"""The pose by wheel odometry, with its heading corrected by walls.

Wheels that differ by a thousandth turn a robot by 5 degrees a minute, always to the same side, and
carpets take some of each turn. But walls of a home stand square to each other, and so does its
station: a straight way along a wall tells the heading, up to quarter turns. How far the
heading was wrong, and over which way, also tells how the wheels differ: from then on the robot's
drift is taken out.
"""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import Pose

_QUARTER = 0.5 * math.pi
_PARTS = 8
"""Parts of a way along a wall; if the whole way tells nothing, its first part is dropped."""


class WallCompass:
    """Follows the odometry; ``pose`` is the corrected pose, m and rad, from the first one.

    ``veer``, rad/m, is the learned drift: how far the robot turns left unasked.
    """

    def __init__(self, config: BumpingConfig) -> None:
        """Know nothing yet."""
        self._config = config
        self.pose = Pose()
        self.veer = 0.0
        self._told: Pose | None = None
        self._square = 0.0
        self._points: deque[tuple[float, float]] = deque()
        self._way = 0.0
        self._corrected_at: Pose | None = None
        self._turned = 0.0
        self._has_learned = False

    @property
    def is_due(self) -> bool:
        """Whether the heading is doubtful: never corrected, or too far driven or turned since."""
        config = self._config
        if not self._has_learned:
            return True
        return self._way > config.compass_due or abs(self._turned) > config.compass_turns

    def stand_square(self) -> None:
        """Take the present heading as square to the walls, as that on the station is."""
        self._square = self.pose.theta
        self._corrected_at, self._way, self._turned = self.pose, 0.0, 0.0

    def stand_at(self, pose: Pose) -> None:
        """Take ``pose`` as the present one, when it is known, as on the station."""
        self.pose = self._corrected_at = pose
        self._points.clear()
        self._way = self._turned = 0.0

    def take(self, told: Pose, *, is_along: bool) -> bool:
        """Take the wheels' pose; ``is_along``: along a wall. Return whether that corrected it."""
        before, self._told = self._told or told, told
        moved = before.inverse().compose(told)
        step = math.hypot(moved.x, moved.y)
        turn = moved.theta - self.veer * step
        self.pose = self.pose.compose(Pose(moved.x, moved.y, turn))
        self._way += step
        self._turned += turn
        if not is_along:
            self._points.clear()
            return False
        self._points.append((self.pose.x, self.pose.y))
        while len(self._points) > 2 and self._chord(1) >= self._config.compass_way:
            self._points.popleft()
        if self._chord(0) < self._config.compass_way:
            return False
        learned = self._put_right()
        # Points that were used are done; those that told nothing tell nothing a step later either.
        for _ in range(len(self._points) if learned else len(self._points) // _PARTS):
            self._points.popleft()
        return learned

    def _chord(self, first: int) -> float:
        return math.dist(self._points[first], self._points[-1])

    def _put_right(self) -> bool:
        along, aside = _line_through(np.array(self._points))
        wrong = math.remainder(along - self._square, _QUARTER)
        if aside > self._config.compass_aside or abs(wrong) > self._config.compass_most:
            return False
        way = max(self._way, self._config.compass_way)
        self.veer += self._config.compass_learning * wrong / max(way, self._config.compass_far)
        # Half of the error arose before the middle of the way, so the position is wrong as well.
        since = self._corrected_at or self.pose
        half, pose = -0.5 * wrong, self.pose
        off_x, off_y = pose.x - since.x, pose.y - since.y
        cos, sin = math.cos(half), math.sin(half)
        self.pose = Pose(
            since.x + cos * off_x - sin * off_y,
            since.y + sin * off_x + cos * off_y,
            pose.theta - wrong,
        )
        self._corrected_at, self._way = self.pose, 0.0
        self._turned = 0.0
        self._has_learned = True
        return True


def _line_through(points: NDArray[np.float64]) -> tuple[float, float]:
    """Return the direction of the line nearest to points, rad, and how far they are off it, m."""
    off = points - points.mean(axis=0)
    _, _, (along, across) = np.linalg.svd(off, full_matrices=False)
    return math.atan2(along[1], along[0]), float(np.abs(off @ across).max())
