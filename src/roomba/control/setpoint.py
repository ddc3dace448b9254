"""Where the robot should be: the newest wish, and whether its sender still stands behind it.

A single wish is driven to the end. A stream of wishes, a setpoint on the move, is only good while
its sender is there: when the sender vanishes, the robot stops at once.
"""

from __future__ import annotations

import math

Point = tuple[float, float]


class Setpoint:
    """The newest wish, m in the map frame; times in s of the robot's clock."""

    def __init__(self, stream_timeout: float) -> None:
        """A stream is wishes that follow each other within ``stream_timeout`` s."""
        self._stream_timeout = stream_timeout
        self._target: Point | None = None
        self._received = -math.inf
        self._streamed = False
        self._senders = 0

    @property
    def target(self) -> Point | None:
        """The point to be at, or None when nothing is wished."""
        return self._target

    def wish(self, now: float, target: Point, senders: int) -> None:
        """Take a new wish; ``senders`` is how many programs are connected to send wishes."""
        since = now - self._received
        self._streamed = self._target is not None and 0.0 <= since <= self._stream_timeout
        self._target = target
        self._received = now
        self._senders = senders

    def fulfilled(self, now: float) -> None:
        """The robot is there: wish nothing any more, unless wishes are still streaming in."""
        if not 0.0 <= now - self._received <= self._stream_timeout:
            self._target = None

    def is_wished(self, now: float) -> bool:
        """Whether the newest wish is not older than a stream's, though it may be forgotten."""
        return 0.0 <= now - self._received <= self._stream_timeout

    def forget(self) -> None:
        """Wish nothing any more."""
        self._target = None

    def check(self, now: float, senders: int) -> bool:
        """Drop a stream whose sender vanished; return True when that happened just now."""
        if self._target is None:
            return False
        if senders > self._senders:
            self._senders = senders
        lost = self._streamed and senders < self._senders
        self._streamed = self._streamed and now - self._received <= self._stream_timeout
        if lost:
            self._target = None
        return lost
