"""Driving a path to its end, around what stands in the way.

No clock and no I/O: it is ticked with what the robot senses and answers with the twist it wants. It
remembers what it finds in its way, leaves the path before the thing, and joins it again behind.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.clock import LONGEST_TICK, ClockJumps
from roomba.configuration.mission import DrivingConfig
from roomba.configuration.robot import RobotConfig
from roomba.control.path_tracker import PathTracker
from roomba.geometry import STANDSTILL, Twist
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.progress_kernels import PROGRESS, is_held
from roomba.mission.driving.recovery import Recovery
from roomba.mission.driving.rejoin import Rejoin
from roomba.mission.driving.trail import Trail
from roomba.mission.driving.way_ahead import LEAVING, WayAhead
from roomba.mission.inputs.senses import Senses

_PAUSE: Final = 3.5
"""Ticks; after more of them without a command its drive has stopped."""
_HERE: Final = 0.001
"""m; the robot counts as standing at a corner that is as near as this."""


class DriveState(Enum):
    """The state of a drive."""

    DRIVING = "driving"
    BACKING = "backing"
    """Away from what it touched."""
    RECOVERING = "recovering"
    """It came no farther and tries to get free."""
    DONE = "done"
    """At the end of its path."""
    OVERTAKEN = "overtaken"
    """Something stands on its path that was not known when that was planned: plan it anew."""
    CUT_OFF = "cut off"
    """No way leads to any of what is left of its path; the reason is told."""
    STUCK = "stuck"
    """It cannot get free; the reason is told."""

    @property
    def is_over(self) -> bool:
        """Whether it ended."""
        return self in (
            DriveState.DONE,
            DriveState.OVERTAKEN,
            DriveState.CUT_OFF,
            DriveState.STUCK,
        )


@dataclass(frozen=True, slots=True)
class DriveStep:
    """What a drive wants at a tick."""

    state: DriveState
    twist: Twist = STANDSTILL
    reason: str = ""


class PathDriver:
    """Drives along ``points``, float64 [n, 2], m, from wherever the robot stands.

    Its progress is in ``progress``, PROGRESS [1], and what stands before it in ``ahead``; compiled
    kernels go on with both while it :attr:`is_tracking`.

    Each tick ends in bounded time, and so does the drive: what blocks it is remembered, and it
    gives up after so many recoveries without progress.
    """

    def __init__(
        self,
        points: NDArray[np.float64],
        rejoin: Rejoin,
        obstacles: Obstacles,
        trail: Trail,
        config: DrivingConfig,
        robot: RobotConfig,
        senses: Senses,
        plans_anew: Callable[[float, Floats], bool] = lambda now, rest: False,
    ) -> None:
        """Begin; the path may begin anywhere: the robot goes to its start first.

        ``plans_anew`` is asked, with the time, s, and the :attr:`rest`, whether a path on which
        something stands is better planned anew than driven around that.
        """
        self._rejoin, self._obstacles, self._trail = rejoin, obstacles, trail
        self._config, self._robot = config, robot
        self._plans_anew = plans_anew
        self._state = DriveState.DRIVING
        self._reason = ""
        self._was_touching = any(senses.touches)
        self._jumps = ClockJumps(last=senses.now, longest=LONGEST_TICK)
        self._backs_from: tuple[float, float, float] | None = None
        self._recovery: Recovery | None = None
        self.progress = np.zeros(1, PROGRESS)
        self.progress["timeout"] = config.progress_timeout
        self.progress["least"] = config.least_progress
        self.progress["least_turn"] = config.least_turn
        self.progress["leaves_trouble"] = config.leaves_trouble
        self._planned_at, self._futile = (math.inf, math.inf), 0
        self._nudged_at = (math.inf, math.inf)
        self._touched_at, self._touches = (math.inf, math.inf), 0
        self._begin(points, senses)
        if self.tracker.off_path(senses.pose) > config.least_progress:
            self._go_around(senses)

    @property
    def left(self) -> float:
        """How much of the path is before the robot, m."""
        return self.tracker.left

    @property
    def points_left(self) -> NDArray[np.float64]:
        """The corners of the path before the robot, and its end, float64 [n, 2], m.

        A corner at which the robot stands counts as behind it.
        """
        course = self.tracker.course
        return course.points[course.stations > self.tracker.along + _HERE]

    @property
    def rest(self) -> Floats:
        """What is left of the path, from where the robot is on it: float64 [n, 2], m."""
        return self.tracker.rest

    @property
    def is_tracking(self) -> bool:
        """Whether only the tracker runs in the next ticks, as long as nothing comes up."""
        return self._state is DriveState.DRIVING and not self.tracker.is_done

    def tick(self, senses: Senses, limit: float) -> DriveStep:
        """Return what is wanted now; ``limit`` is the speed wanted, m/s."""
        self._follow_clock(senses.now)
        self._trail.add(senses.pose.x, senses.pose.y)
        if self._state.is_over:
            return DriveStep(self._state, STANDSTILL, self._reason)
        self._notice_touch(senses)
        if self._backs_from is not None:
            return self._back_off(senses, self._backs_from)
        if self._recovery is not None:
            return self._get_free(senses, self._recovery)
        if self._needs_new_way(senses):
            self._leave_path(senses)
        elif self._comes_no_farther(senses):
            self._begin_recovery(senses)
        if self._state is DriveState.DRIVING:
            twist = self.tracker.tick(senses.pose, limit)
            if self.tracker.is_done:
                self._state = DriveState.DONE
            return DriveStep(self._state, twist)
        return DriveStep(self._state, STANDSTILL, self._reason)

    def caught_up(self, senses: Senses) -> None:
        """Go on after ticks that only the tracker ran."""
        self._jumps.last, self._was_touching = senses.now, False

    def _follow_clock(self, now: float) -> None:
        """Move the remembered times along when the clock was set.

        A robot that was not driven for some ticks stands by now.
        """
        if self._jumps.last is None or now - self._jumps.last > _PAUSE * self._robot.timing.tick:
            self.tracker.stand()
        jump = self._jumps.at(now)
        self.progress["at"] += jump
        if self._backs_from is not None:
            since, x, y = self._backs_from
            self._backs_from = since + jump, x, y

    def _notice_touch(self, senses: Senses) -> None:
        touches = any(senses.touches)
        is_new, self._was_touching = touches and not self._was_touching, touches
        if is_new:
            self._obstacles.feel(senses)
            is_here = senses.pose.distance_to(*self._touched_at) < self._config.touch_radius
            self._touches = self._touches + 1 if is_here else 1
            self._touched_at = senses.pose.x, senses.pose.y
            self._recovery = None
            self._backs_from = senses.now, senses.pose.x, senses.pose.y
            self._state = DriveState.BACKING

    def _back_off(self, senses: Senses, began: tuple[float, float, float]) -> DriveStep:
        """Drive back a little, then look for another way."""
        since, x, y = began
        config = self._config
        longest = 2.0 * config.backing_way / config.backing_speed
        way = senses.pose.distance_to(x, y)
        if way < config.backing_way and senses.now - since < longest:
            return DriveStep(self._state, Twist(-config.backing_speed, 0.0))
        self._backs_from = None
        self._state = DriveState.DRIVING
        if any(senses.touches) and way < 0.25 * config.backing_way:
            self._begin_recovery(senses)
        elif self._touches > self._config.most_touches:
            self._state = DriveState.CUT_OFF
            self._reason = f"something stands near {senses.where} that only the bumper feels"
        else:
            self._go_around(senses)
        return DriveStep(self._state, STANDSTILL, self._reason)

    def _needs_new_way(self, senses: Senses) -> bool:
        """Whether the robot is off its path, or something that was seen stands on it."""
        if self.tracker.off_path(senses.pose) > self._config.off_path:
            return True
        return self.ahead.is_blocked(self.tracker.along)

    def _leave_path(self, senses: Senses) -> None:
        """Go around what stands on the path, or have the rest of it planned anew."""
        if self.tracker.off_path(senses.pose) > self._config.off_path:
            self._go_around(senses)
            return
        moved = senses.pose.distance_to(*self._nudged_at)
        points = self._rejoin.nudged(senses, self.tracker, self._obstacles)
        if points is not None and moved > self._config.least_progress:
            self._nudged_at = senses.pose.x, senses.pose.y
            self._begin(points, senses)
        elif self._plans_anew(senses.now, self.rest):
            self._state = DriveState.OVERTAKEN
        else:
            self._go_around(senses)

    def _begin(
        self, points: NDArray[np.float64], senses: Senses, leaves_until: float = 0.0
    ) -> None:
        """Drive another path; before ``leaves_until``, m along it, things seen do not count."""
        robot = self._robot
        self.tracker = PathTracker(points, robot.tracking, robot.body, robot.timing.tick)
        self.ahead = WayAhead(
            self.tracker.course, self._obstacles, self._config.look_ahead, leaves_until
        )
        row = self.progress[0]
        row["at"], row["along"], row["leg"], row["to_turn"] = senses.now, 0.0, 0, math.inf

    def _go_around(self, senses: Senses) -> None:
        """Plan to the next piece of the path that can be reached; a bump may have shortened it."""
        x, y = self._planned_at
        moved = senses.pose.distance_to(x, y)
        self._futile = self._futile + 1 if moved < self._config.least_progress else 0
        self._planned_at = senses.pose.x, senses.pose.y
        if self._futile > self._config.most_futile:
            self._futile = 0
            self._begin_recovery(senses)
            return
        points, back = self._rejoin.way(senses, self.tracker, self._obstacles, self._trail)
        if points is None:
            self._state = DriveState.CUT_OFF
            self._reason = f"no way leads on from {senses.where}: {self._rejoin.trouble}"
            return
        self._begin(points, senses, leaves_until=back + LEAVING)

    def _comes_no_farther(self, senses: Senses) -> bool:
        tracker = self.tracker
        return bool(is_held(self.progress, tracker.along, tracker.leg, tracker.to_turn, senses.now))

    def _begin_recovery(self, senses: Senses) -> None:
        self.progress["recoveries"] += 1
        recoveries = int(self.progress["recoveries"][0])
        if recoveries > self._config.most_recoveries:
            self._state = DriveState.STUCK
            self._reason = (
                f"stuck near {senses.where}: backing, turning and driving curves did not help; "
                "set it free and resume"
            )
            return
        self._state = DriveState.RECOVERING
        self._recovery = Recovery(recoveries, self._config, senses)

    def _get_free(self, senses: Senses, recovery: Recovery) -> DriveStep:
        twist = recovery.tick(senses)
        if twist is not None:
            return DriveStep(self._state, twist)
        self._recovery = None
        self._state = DriveState.DRIVING
        if recovery.moved(senses):
            self._obstacles.forget_felt_at(senses)
        self._go_around(senses)
        return DriveStep(self._state, STANDSTILL, self._reason)
