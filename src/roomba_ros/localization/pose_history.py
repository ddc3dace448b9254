"""The robot's recent poses, interpolated."""

from __future__ import annotations

from collections import deque
from itertools import pairwise
from typing import Final

from roomba.geometry import Pose, wrap_angle

_KEPT: Final = 40
"""Poses: two seconds of them."""
_LONGEST_GAP: Final = 0.3
"""s; between poses farther apart in time it is not known how the robot moved."""
_JUMP: Final = (0.3, 1.2)
"""m, rad; more than that from a pose to the next is a correction of the place."""


class PoseHistory:
    """The newest poses, map frame, by their stamps in s."""

    def __init__(self) -> None:
        """Begin with none."""
        self._poses: deque[tuple[float, Pose]] = deque(maxlen=_KEPT)

    def add(self, stamp: float, pose: Pose) -> None:
        """Remember a pose; a clock that was set back forgets all before."""
        if self._poses and stamp < self._poses[-1][0]:
            self._poses.clear()
        self._poses.append((stamp, pose))

    @property
    def newest(self) -> tuple[float, Pose] | None:
        """The last one with its stamp, if there is one."""
        return self._poses[-1] if self._poses else None

    def at(self, stamp: float) -> Pose | None:
        """Return where the robot was at a time, s; None if that is not known."""
        if self._poses and self._poses[-1][0] == stamp:
            return self._poses[-1][1]
        for (before, start), (after, end) in pairwise(list(self._poses)):
            if before <= stamp < after:
                share = (stamp - before) / (after - before)
                return _between(start, end, share) if after - before < _LONGEST_GAP else None
        return None


def _between(start: Pose, end: Pose, share: float) -> Pose | None:
    """Return the pose at a share, 0..1, of the way; None for a way that was not driven."""
    turn = wrap_angle(end.theta - start.theta)
    if start.distance_to(end.x, end.y) > _JUMP[0] or abs(turn) > _JUMP[1]:
        return None
    x = start.x + share * (end.x - start.x)
    y = start.y + share * (end.y - start.y)
    return Pose(x, y, wrap_angle(start.theta + share * turn))
