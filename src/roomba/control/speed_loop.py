"""The speed loop: it decides the twist that the drive gets.

It chooses one source of commands, keeps to the speed limit, stops for stale commands, backs
away from what the bumper meets and from cliffs, and stands when a wheel hangs in the air. Above all
that is the emergency stop.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from roomba.clock import is_recent
from roomba.configuration.body import BodyConfig
from roomba.geometry import STANDSTILL, Twist


class Hold(Enum):
    """Why the drive gets less than the command."""

    NONE = "drives as asked"
    NO_COMMAND = "no command"
    """There is no command yet, or the newest one is too old."""
    SPEED_ZERO = "the speed wanted is 0"
    BUMPER = "the bumper is pressed"
    """The robot backs off a little, so that it can turn away; after that it only may not push."""
    CLIFF = "there is no floor ahead"
    """The robot backs away, for ``cliff_backing_time`` at most, in place of what is commanded."""
    WHEEL_DROP = "a wheel hangs in the air"
    EMERGENCY = "emergency stop"
    """The robot stands until the stop is released; no command counts."""


class Source(Enum):
    """Sources of commands by priority: the first one with a fresh command is obeyed."""

    DIRECT = "cmd_vel"
    """A walk, or manual steering."""
    MISSION = "cmd_vel_mission"
    """Cleaning and docking."""


@dataclass(frozen=True, slots=True)
class Hazards:
    """What the drive must not go on into: whether the front bumper is pressed, a cliff sensor sees
    no floor, a wheel hangs in the air."""

    bumper: bool = False
    cliff: bool = False
    wheel_drop: bool = False


@dataclass(frozen=True, slots=True)
class _Command:
    twist: Twist
    given: float


class SpeedLoop:
    """Holds the newest commands, cruise speed and hazards; :meth:`tick` says what the drive gets.

    Speeds in m/s and rad/s, times in s of the robot's clock.
    """

    def __init__(self, body: BodyConfig, max_speed: float) -> None:
        """Keep to ``max_speed``, m/s; a command older than the body's ``command_timeout`` is stale.

        This loop does not look at the body's own top speed: that is left to the drive.
        """
        self._body, self._max_speed = body, max_speed
        self._cruise_speed = math.inf
        self._commands: dict[Source, _Command] = {}
        self._hazards = Hazards()
        self._backs_since: float | None = None
        self._pressed_since: float | None = None
        self.emergency = False
        """Whether the emergency stop holds the drive."""

    @property
    def speed_limit(self) -> float:
        """The fastest speed that the loop lets through, m/s."""
        return min(self._max_speed, self._cruise_speed)

    def set_max_speed(self, max_speed: float) -> None:
        """Set the robot's top speed."""
        self._max_speed = max_speed

    def set_cruise_speed(self, speed: float) -> None:
        """Set the cruise speed; raises ValueError unless it is finite and not negative."""
        if not math.isfinite(speed) or speed < 0.0:
            raise ValueError(f"expected a finite speed of 0 m/s or more, got {speed}")
        self._cruise_speed = speed

    def command(self, now: float, twist: Twist, source: Source = Source.DIRECT) -> None:
        """Take a wanted twist; raises ValueError for numbers that cannot be driven."""
        if not twist.is_finite:
            raise ValueError(f"expected finite velocities, got {twist}")
        self._commands[source] = _Command(twist, now)

    def forget_commands(self) -> None:
        """Drop all commands: from now on nothing is wanted of the drive."""
        self._commands.clear()

    def set_hazards(self, hazards: Hazards) -> None:
        """Tell which hazards there are now."""
        self._hazards = hazards
        if not hazards.bumper:
            self._pressed_since = None
        if not hazards.cliff:
            self._backs_since = None

    def tick(self, now: float) -> tuple[Twist, Hold]:
        """Return the twist for the drive, and why it is less than the command."""
        if self.emergency:
            # Commands from before are dropped, so that nothing is driven at the release.
            self.forget_commands()
            return STANDSTILL, Hold.EMERGENCY
        command = self._fresh_command(now)
        if command is None:
            return STANDSTILL, Hold.NO_COMMAND
        if self.speed_limit == 0.0:
            return STANDSTILL, Hold.SPEED_ZERO
        if self._hazards.wheel_drop:
            return STANDSTILL, Hold.WHEEL_DROP
        if self._hazards.cliff:
            self._backs_since = _began(self._backs_since, now)
            is_over = now - self._backs_since > self._body.cliff_backing_time
            return STANDSTILL if is_over else self._backwards(), Hold.CLIFF
        limited = self._within_limit(command)
        if self._hazards.bumper and limited.linear > 0.0:
            self._pressed_since = _began(self._pressed_since, now)
            is_over = now - self._pressed_since > self._body.bumper_backing_time
            return Twist(0.0, limited.angular) if is_over else self._backwards(), Hold.BUMPER
        return limited, Hold.NONE

    def _backwards(self) -> Twist:
        return Twist(-min(self._body.backing_speed, self.speed_limit), 0.0)

    def _fresh_command(self, now: float) -> Twist | None:
        for source in Source:
            command = self._commands.get(source)
            if command is None:
                continue
            if now < command.given:
                # The clock was set back (a bag played again): the command's age starts anew.
                self._commands[source] = command = _Command(command.twist, now)
            if is_recent(now, command.given, self._body.command_timeout):
                return command.twist
            del self._commands[source]
        return None

    def _within_limit(self, twist: Twist) -> Twist:
        """Slow the twist down to the limits on the same arc."""
        share = 1.0
        if abs(twist.linear) > self.speed_limit:
            share = self.speed_limit / abs(twist.linear)
        if abs(twist.angular) * share > self._body.max_angular_speed:
            share = self._body.max_angular_speed / abs(twist.angular)
        return Twist(twist.linear * share, twist.angular * share)


def _began(since: float | None, now: float) -> float:
    """Return since when a state holds: from now on if it is new, or the clock was set back."""
    return now if since is None or now < since else since
