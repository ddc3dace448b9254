"""Undocking: the robot, which faces its charging station, backs straight out of it.

No clock and no I/O: it is ticked with what the robot senses and answers with what it wants.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from roomba.clock import RobotTime
from roomba.configuration.docking import DockingConfig
from roomba.geometry import STANDSTILL, Pose, Twist, wrap_angle
from roomba.mission.docking.step import DockSenses


class UndockState(Enum):
    """The state of undocking."""

    BACKING_OUT = "backing out"
    OUT = "out"
    """It stands before its station, or was away from it already."""
    FAILED = "failed"
    """Given up; the reason is told."""


@dataclass(frozen=True, slots=True)
class UndockStep:
    """What undocking wants at a tick, and why it failed."""

    state: UndockState
    twist: Twist
    reason: str = ""


class Undocking:
    """One undocking from ``station``; it ends undocked or failed, at the latest at its limit."""

    def __init__(self, config: DockingConfig, station: Pose, senses: DockSenses) -> None:
        """Begin; ``station`` is where the docked robot stands, its nose to the station, map frame.

        Raises ValueError for a pose that is not finite.
        """
        if not station.is_finite:
            raise ValueError(f"expected a finite pose of the station, got {station}")
        self._config = config
        self._time = RobotTime(senses.now)
        self._last_pose = _believed(senses)
        self._way = 0.0
        self._moved = (0.0, 0.0)
        self._wanted = STANDSTILL
        self._touches = senses.bumper
        is_docked = senses.is_charging or stands_in(station, senses, config)
        self._state = UndockState.BACKING_OUT if is_docked else UndockState.OUT
        self._reason = ""

    def tick(self, senses: DockSenses) -> UndockStep:
        """Return what is wanted now."""
        wanted = STANDSTILL
        if self._state is UndockState.BACKING_OUT:
            self._follow(senses)
            self._state, self._reason = self._judge(senses)
            if self._state is UndockState.BACKING_OUT:
                wanted = Twist(-self._config.undock_speed, 0.0)
        self._wanted = wanted
        return UndockStep(self._state, wanted, self._reason)

    def _follow(self, senses: DockSenses) -> None:
        """Follow time, and the way by the believed pose, or by what was wanted without one."""
        dt = self._time.tick(senses.now)
        pose, before = _believed(senses), self._last_pose
        if pose is None or before is None:
            self._way -= self._wanted.linear * dt
        else:
            self._way -= before.inverse().compose(pose).x
        self._last_pose = pose
        if self._way > self._moved[1] + self._config.standstill_way:
            self._moved = self._time.elapsed, self._way

    def _judge(self, senses: DockSenses) -> tuple[UndockState, str]:
        config, failed = self._config, UndockState.FAILED
        was_touching, self._touches = self._touches, senses.bumper
        if senses.bumper and not was_touching:
            return failed, "something touches the robot: clear the way around it"
        if senses.cliff:
            return failed, "the cliff sensors see no floor: wipe them, or clear the floor"
        if self._way >= config.undock_distance:
            if not senses.is_charging:
                return UndockState.OUT, ""
            return failed, "the robot does not get out of its station: see whether it is held"
        if self._time.elapsed - self._moved[0] > config.stuck_timeout:
            if self._way >= config.undocked_distance and not senses.is_charging:
                # A wall is behind it, and room enough between the two.
                return UndockState.OUT, ""
            return failed, "the robot does not move: see what is behind it or holds its wheels"
        if self._time.elapsed > config.undock_time_limit:
            return failed, "it took too long: see what is behind the robot or holds its wheels"
        return UndockState.BACKING_OUT, ""


def stands_in(station: Pose, senses: DockSenses, config: DockingConfig) -> bool:
    """Whether the robot, by its believed pose, stands in the station though it gets no current."""
    pose = _believed(senses)
    if pose is None or pose.distance_to(station.x, station.y) >= config.undocked_distance:
        return False
    return abs(wrap_angle(pose.theta - station.theta)) <= config.undocked_turn


def _believed(senses: DockSenses) -> Pose | None:
    return senses.pose if senses.is_known and senses.pose.is_finite else None
