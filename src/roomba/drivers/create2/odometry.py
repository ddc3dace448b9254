"""Odometry by the wheels' encoders, whose counters wrap around after 65,536 counts."""

from __future__ import annotations

import math
from collections import deque
from typing import Final

from roomba.configuration.robot import RobotConfig
from roomba.drivers.create2.open_interface import ENCODER_SPAN
from roomba.geometry import STANDSTILL, Pose, Twist

_SPEED_WINDOW: Final = 0.1
"""s over which speeds are averaged: a single count is 0.4 mm."""
_FASTEST_WHEEL: Final = 1.0
"""m/s of a wheel; counts that would need more mean that the encoders began anew."""
_SLACK_WAY: Final = 0.05
"""m beyond that speed: more than a wheel rolls while bytes wait."""


class EncoderOdometry:
    """``pose`` in the frame in which it began, and ``twist``, by the counts of both wheels."""

    def __init__(self, config: RobotConfig) -> None:
        """Begin at the origin; ``config`` gives the wheels and their counts per turn."""
        body = config.body
        self._way = math.pi * body.wheel_diameter / config.wheels.counts_per_turn
        self._track = body.wheel_separation
        self._last: tuple[float, int, int] | None = None
        self._steps: deque[tuple[float, float, float]] = deque()
        self.pose, self.twist = Pose(), STANDSTILL

    def forget(self) -> None:
        """Begin anew at the present pose with the next counts; the way until then is lost."""
        self._last, self.twist = None, STANDSTILL
        self._steps.clear()

    def pause(self) -> None:
        """Stand until the next counts; a plausible way that was rolled meanwhile still counts."""
        self.twist = STANDSTILL
        self._steps.clear()

    def take(self, now: float, left: int, right: int) -> None:
        """Take the counts of both encoders, 0 to 65,535, at ``now``, s."""
        before, self._last = self._last, (now, left, right)
        is_resumed = not self._steps
        if before is None:
            self._steps.append((now, 0.0, 0.0))
            return
        at, left_before, right_before = before
        rolled = self._rolled(left_before, left), self._rolled(right_before, right)
        if max(map(abs, rolled)) > _SLACK_WAY + _FASTEST_WHEEL * (now - at):
            self.forget()
            self._last = now, left, right
            return
        way, turn = 0.5 * (rolled[0] + rolled[1]), (rolled[1] - rolled[0]) / self._track
        # The chord of an arc, in the middle of its turn.
        half = 0.5 * turn
        chord = way * (math.sin(half) / half if half else 1.0)
        self.pose = self.pose.compose(Pose(chord * math.cos(half), chord * math.sin(half), turn))
        # When the wheels rolled in a pause is not known, so no speed is measured by that.
        self._steps.append((now, 0.0, 0.0) if is_resumed else (now, way, turn))
        self._measure(now)

    def _rolled(self, before: int, now: int) -> float:
        half = ENCODER_SPAN // 2
        return self._way * ((now - before + half) % ENCODER_SPAN - half)

    def _measure(self, now: float) -> None:
        while len(self._steps) > 2 and now - self._steps[1][0] >= _SPEED_WINDOW:
            self._steps.popleft()
        passed = now - self._steps[0][0]
        if passed <= 0.0:
            return
        ways = [step[1:] for step in list(self._steps)[1:]]
        self.twist = Twist(
            sum(way for way, _ in ways) / passed, sum(turn for _, turn in ways) / passed
        )
