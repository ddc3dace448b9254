"""The setpoint: where the robot should be, and whether its sender is still connected.

The robot drives to a single setpoint, repeated or not, until it arrives or comes no nearer: a
setpoint in a wall would otherwise hold the drive for ever. A stream of setpoints (a moving
setpoint) is only valid while it flows: when its sender vanishes, or is silent, the robot stops.
"""

from __future__ import annotations

import math

from roomba.clock import LONGEST_TICK, ClockJumps, is_recent
from roomba.geometry import Point


class Setpoint:
    """The newest setpoint, m in the map frame; times in s of the robot's clock."""

    def __init__(self, stream_timeout: float, given_up_after: float, nearer: float) -> None:
        """Take as a stream setpoints that differ and follow each other within ``stream_timeout`` s.

        A single setpoint is given up when the robot does not come nearer to it by ``nearer`` m in
        ``given_up_after`` s.
        """
        self._stream_timeout = stream_timeout
        self._given_up_after, self._nearer = given_up_after, nearer
        self._nearest, self._came_nearer = math.inf, -math.inf
        self._jumps = ClockJumps(longest=LONGEST_TICK)
        self._target: Point | None = None
        self._received = -math.inf
        self._streamed = False
        self._senders = 0

    @property
    def target(self) -> Point | None:
        """The point to be at, or None without a setpoint."""
        return self._target

    def wish(self, now: float, target: Point, senders: int) -> None:
        """Take a new setpoint; ``senders`` is how many publishers are connected."""
        follows = self._target is not None and self.is_wished(now)
        self._streamed = follows and (self._streamed or target != self._target)
        if target != self._target:
            self._nearest = math.inf
        self._target = target
        self._received = now
        self._senders = senders

    def fulfilled(self, now: float) -> None:
        """Forget the setpoint, where the robot is by now, unless more are still streaming in."""
        if not self.is_wished(now):
            self._target = None

    def is_wished(self, now: float) -> bool:
        """Whether a setpoint came within the stream's timeout, even if it is forgotten already."""
        return is_recent(now, self._received, self._stream_timeout)

    def drop_if_out_of_reach(self, now: float, distance: float) -> bool:
        """Drop a single setpoint, ``distance`` m away, that the robot comes no nearer to.

        Call this at each tick. Return whether the setpoint was dropped now.
        """
        self._came_nearer += self._jumps.at(now)
        if distance <= self._nearest - self._nearer:
            self._nearest, self._came_nearer = distance, now
        if self._streamed or now - self._came_nearer < self._given_up_after:
            return False
        self._target = None
        return True

    def forget(self) -> None:
        """Forget the setpoint."""
        self._target = None

    def drop_if_lost(self, now: float, senders: int) -> bool:
        """Drop a stream that is silent, or whose sender vanished; return whether it was dropped."""
        if self._target is None:
            return False
        if senders > self._senders:
            self._senders = senders
        is_silent = now >= self._received and not self.is_wished(now)
        lost = self._streamed and (is_silent or senders < self._senders)
        if lost:
            self._target = None
        return lost
