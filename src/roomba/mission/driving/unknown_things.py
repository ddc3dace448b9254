"""Things that the map does not show and bumper or cliff sensors found, remembered for a while."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Final, NamedTuple

import numpy as np

from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import WalkConfig
from roomba.geometry import Pose, RoundObstacle

_STEP: Final = 0.1
"""rad; from one place on the rim to the next, at most."""


class _Touch(NamedTuple):
    """When, s, at which place, m, and in which direction, rad, map frame, a body felt a thing."""

    time: float
    x: float
    y: float
    direction: float

    def beyond(self, away: float) -> tuple[float, float]:
        """Return the point so far from the body's middle in that direction, m."""
        return self.x + away * math.cos(self.direction), self.y + away * math.sin(self.direction)

    def moved(self, moved: Pose) -> _Touch:
        """Return the same in another frame, in which this one lies at ``moved``."""
        there = moved.compose(Pose(self.x, self.y, self.direction))
        return _Touch(self.time, there.x, there.y, there.theta)


class UnknownThings:
    """Round obstacles felt by the bumper; each is forgotten after ``memory`` s, for things move."""

    def __init__(self, walk: WalkConfig, body: BodyConfig, memory: float) -> None:
        """Take the size given to a thing, and the body that feels it."""
        self._body_radius, self._radius = body.radius, walk.bump_radius
        self._reach = body.radius + walk.bump_radius
        self._left, self._both = body.bumper_side, body.bumper_middle
        self._right = tuple(-angle for angle in body.bumper_side)
        self._pressed, self._memory = body.pressed, memory
        self._felt: list[_Touch] = []

    def felt(self, now: float, pose: Pose, left: bool, right: bool) -> None:
        """Remember what is in the way of the front's halves while the body stands at ``pose``."""
        self.felt_at(now, pose, self._angles(left, right))

    def felt_at(self, now: float, pose: Pose, angles: Iterable[float]) -> None:
        """Remember what is in the way of the rim at some bearings, rad from ahead."""
        for angle in angles:
            self._felt.append(_Touch(now, pose.x, pose.y, pose.theta + angle))

    def places(self, pose: Pose, left: bool, right: bool) -> list[tuple[float, float]]:
        """Return where along the halves of its front a body at ``pose`` feels something, m."""
        return [self._on_rim(pose, angle) for angle in self._angles(left, right)]

    def rim(self, pose: Pose, left: bool, right: bool) -> list[tuple[float, float, float]]:
        """Return bearings all along the pressed part of the rim, and x and y there, rad and m."""
        first, last = self._pressed(left, right)
        angles = np.linspace(first, last, 1 + math.ceil((last - first) / _STEP)).tolist()
        return [(angle, *self._on_rim(pose, angle)) for angle in angles]

    def _on_rim(self, pose: Pose, angle: float) -> tuple[float, float]:
        return _Touch(0.0, pose.x, pose.y, pose.theta + angle).beyond(self._body_radius)

    def _angles(self, left: bool, right: bool) -> tuple[float, ...]:
        return self._both if left and right else self._left if left else self._right

    def at(self, now: float, radius: float | None = None) -> list[RoundObstacle]:
        """Return what is still remembered; a clock set back forgets nothing.

        A thing touches the body where the body felt it; ``radius``, m, is given to things in place
        of the usual one.
        """
        self._felt = [touch for touch in self._felt if now - touch.time < self._memory]
        size = self._radius if radius is None else radius
        return [(*touch.beyond(self._body_radius + size), size) for touch in self._felt]

    def forget_around(self, x: float, y: float) -> None:
        """Forget what was felt within the body's reach of a place where the robot stands."""
        self._felt = [
            touch for touch in self._felt if math.dist(self._middle_of(touch), (x, y)) > self._reach
        ]

    def forget_since(self, time: float) -> None:
        """Forget what was felt at a time, s, and after it."""
        self._felt = [touch for touch in self._felt if touch.time < time]

    def move(self, moved: Pose) -> None:
        """Go on in another frame, in which this one lies at ``moved``."""
        self._felt = [touch.moved(moved) for touch in self._felt]

    def take(self, others: UnknownThings) -> None:
        """Take over what ``others`` remember; they forget it."""
        self._felt += others._felt
        others.forget()

    def forget(self) -> None:
        """Forget everything."""
        self._felt = []

    def drop(self, is_known: Callable[[float, float], bool]) -> None:
        """Forget what was felt where the map itself shows something."""
        self._felt = [touch for touch in self._felt if not is_known(*self._middle_of(touch))]

    def _middle_of(self, touch: _Touch) -> tuple[float, float]:
        return touch.beyond(self._reach)
