"""Odometry by wheel positions that come now and then, for a pose at any time."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Final

from roomba.geometry import STANDSTILL, Pose, Twist

_SPEED_WINDOW: Final = 0.15
"""s over which speeds are averaged at least: positions come in steps of a millimetre or so."""
_LEAST_JUMP: Final = 0.5
"""m; a wheel whose position jumps by more than this began to count anew."""


@dataclass(frozen=True, slots=True)
class _Told:
    at: float
    left: float
    right: float


class WheelOdometry:
    """The pose since it was made, and the speeds; ``track`` is how far the wheels are apart, m."""

    def __init__(self, track: float) -> None:
        """Begin with nothing told: at the origin, standing."""
        self._track = track
        self._told: deque[_Told] = deque()
        self._pose, self._twist = Pose(), STANDSTILL

    def take(self, at: float, left: float, right: float) -> None:
        """Take how far the wheels had rolled at ``at``, m, from the same start for each call.

        ``at``, s, grows from call to call.
        """
        now = _Told(at, left, right)
        if self._told:
            before = self._told[-1]
            ways = left - before.left, right - before.right
            if max(map(abs, ways)) > _LEAST_JUMP or at <= before.at:
                self._told.clear()
                self._twist = STANDSTILL
            else:
                self._pose = self._pose.compose(self._arc(*ways))
        self._told.append(now)
        self._measure()

    def stand(self) -> None:
        """Forget the speed, but not the pose: the robot may have stood since its last answer."""
        self._twist = STANDSTILL
        while len(self._told) > 1:
            self._told.popleft()

    @property
    def told_at(self) -> float:
        """When the wheels were told last, s; NaN before that."""
        return self._told[-1].at if self._told else math.nan

    def after(self, left: float, right: float) -> Pose:
        """Return where the robot is if its wheels rolled on so far since they were told, m."""
        return self._pose.compose(self._arc(left, right))

    @property
    def twist(self) -> Twist:
        """How the robot moved over the last positions, m/s and rad/s."""
        return self._twist

    def _measure(self) -> None:
        newest = self._told[-1]
        while len(self._told) > 2 and newest.at - self._told[1].at >= _SPEED_WINDOW:
            self._told.popleft()
        first = self._told[0]
        passed = newest.at - first.at
        if passed > 0.0:
            left, right = (newest.left - first.left) / passed, (newest.right - first.right) / passed
            self._twist = Twist(0.5 * (left + right), (right - left) / self._track)

    def _arc(self, left: float, right: float) -> Pose:
        """Return the pose after both wheels rolled on, m, in the robot's frame."""
        way, turn = 0.5 * (left + right), (right - left) / self._track
        return Pose(way * math.cos(0.5 * turn), way * math.sin(0.5 * turn), turn)
