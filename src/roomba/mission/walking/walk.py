"""Walking to a point: a path, a setpoint that moves along it, and what to do when it is blocked.

What the lidar sees on the path is walked around before the robot comes there, as on a clean.

No clock and no I/O: it is ticked with what the robot senses and answers with what it wants.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from roomba.clock import LONGEST_TICK, ClockJumps
from roomba.configuration.loops import WalkConfig
from roomba.geometry import Point
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.search_patience import SearchPatience
from roomba.mission.driving.way_ahead import LEAVING, WayAhead
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.path_follower import PathFollower
from roomba.perception.localization.estimate import Knowledge
from roomba.planning.path.planner import NoPathError, NoPathReason, Path, PathPlanner

_UNKNOWN = "something that the map does not show stands"


class WalkState(Enum):
    """The state of a walk."""

    WALKING = "walking"
    ASTRAY = "astray"
    """Under way, but the robot's place is not known; it continues when that is known again."""
    ARRIVED = "arrived"
    FAILED = "failed"
    """Given up; the reason is told."""


@dataclass(frozen=True, slots=True)
class WalkStep:
    """What a walk wants at a tick: the setpoint, m, and the cruise speed to go there, m/s."""

    state: WalkState
    setpoint: Point
    cruise_speed: float
    distance_left: float
    reason: str = ""


class Walk:
    """One walk to ``goal``, around ``obstacles`` that the map does not show.

    It ends by arriving or by failing, never otherwise: each new plan needs a bump, a standstill, a
    push or something seen on the path, and of all of them there are only so many.
    """

    def __init__(
        self,
        planner: PathPlanner,
        config: WalkConfig,
        obstacles: Obstacles,
        goal: Point,
        senses: Senses,
    ) -> None:
        """Plan the way; raises NoPathError when there is none, ValueError for a goal not finite."""
        self.goal = goal
        self._planner, self._config, self._obstacles = planner, config, obstacles
        self._started = senses.now
        self._jumps = ClockJumps(last=senses.now, longest=LONGEST_TICK)
        self._replans = self._ways_around = 0
        self._was_touching = any(senses.touches)
        self._went_astray, self._astray_since = False, senses.now
        self._patience = SearchPatience(config, senses.knowledge)
        self._known_at = (senses.pose.x, senses.pose.y)
        self._begin(self._plan_to_look(senses), senses)

    def time_spent(self, now: float) -> float:
        """Return how long it has walked, s."""
        return now - self._started

    def tick(self, senses: Senses, max_speed: float) -> WalkStep:
        """Return what is wanted now; ``max_speed`` in m/s."""
        self._follow_clock(senses.now)
        if senses.lifted:
            self._obstacles.forget_edges_felt_now(senses.now)
        if not senses.knowledge.is_usable:
            return self._wait_to_be_found(senses, max_speed)
        if senses.knowledge is Knowledge.ROUGH:
            max_speed = min(max_speed, self._config.careful_speed)
        if self._has_arrived(senses):
            return WalkStep(WalkState.ARRIVED, self.goal, max_speed, 0.0)
        failure = self._go_around(senses)
        if failure:
            return self._stay(WalkState.FAILED, senses, max_speed, failure)
        if self._blocked_since is not None:
            return self._stay(WalkState.WALKING, senses, 0.0, self._trouble)
        setpoint, cruise_speed = self._follower.tick(senses.pose, max_speed)
        self._setpoint = setpoint
        return WalkStep(WalkState.WALKING, setpoint, cruise_speed, self._follower.left)

    def _begin(self, path: Path, senses: Senses) -> None:
        """Walk along a path."""
        self.path = path
        self._follower = PathFollower(path, self._config)
        # A path may begin closely beside what it leads away from.
        is_beside = self._obstacles.first_in_way(path, 0.0, 0.0) is not None
        leaves_until = LEAVING if is_beside else 0.0
        self._ahead = WayAhead(path, self._obstacles, self._config.look_ahead, leaves_until)
        self._blocked_since: float | None = None
        self._looked, self._trouble = -math.inf, ""
        self._setpoint = (senses.pose.x, senses.pose.y)
        self._least_left, self._least_turn = math.inf, math.inf
        self._progressed = senses.now

    def _stay(self, state: WalkState, senses: Senses, speed: float, reason: str) -> WalkStep:
        here = (senses.pose.x, senses.pose.y)
        return WalkStep(state, here, speed, self._follower.left, reason)

    def _wait_to_be_found(self, senses: Senses, max_speed: float) -> WalkStep:
        """Ask for no motion while the robot's place is not known; it may look around meanwhile."""
        if not self._went_astray:
            self._went_astray, self._astray_since = True, senses.now
        self._progressed = senses.now
        is_over = self._patience.is_over(senses.knowledge, senses.now - self._astray_since)
        state = WalkState.FAILED if is_over else WalkState.ASTRAY
        reason = f"the robot does not know where it is: {senses.trouble}"
        return self._stay(state, senses, max_speed, reason)

    def _follow_clock(self, now: float) -> None:
        """Move the remembered times along when the clock was set."""
        jump = self._jumps.at(now)
        self._started += jump
        self._progressed += jump
        self._astray_since += jump
        self._looked += jump
        if self._blocked_since is not None:
            self._blocked_since += jump

    def _has_arrived(self, senses: Senses) -> bool:
        near = senses.pose.distance_to(*self.goal) <= self._config.arrival_tolerance
        return near and abs(senses.twist.linear) <= self._config.standstill

    def _go_around(self, senses: Senses) -> str:
        """Plan anew if need be; return why the walk is given up, or nothing."""
        trouble = self._notice_trouble(senses)
        if trouble:
            return self._plan_anew(senses, trouble)
        if self._ahead.is_blocked(self._follower.along):
            return self._plan_around(senses)
        self._blocked_since = None
        return ""

    def _notice_trouble(self, senses: Senses) -> str:
        """Return why a new plan is needed, or nothing; what is seen ahead is not looked at."""
        where = f"near {senses.where}"
        if self._is_found_again(senses):
            return f"the robot found itself again {where}"
        left, right = senses.touches
        is_new, self._was_touching = (left or right) and not self._was_touching, left or right
        if is_new:
            self._obstacles.feel(senses)
            return f"the floor ends {where}" if senses.cliff else f"{_UNKNOWN} in the way {where}"
        if self._follower.distance_off(senses.pose) > self._config.off_path:
            return f"the robot was moved off its path {where}"
        if self._comes_nearer(senses) or self._blocked_since is not None:
            self._progressed = senses.now
        if senses.now - self._progressed > self._config.progress_timeout:
            return f"the robot comes no nearer {where}"
        return ""

    def _comes_nearer(self, senses: Senses) -> bool:
        """Whether less of the way is left than ever, or less of a turn than ever since then."""
        left = self._follower.left
        to_turn = abs(senses.pose.bearing_to(*self._setpoint))
        if left < self._least_left - self._config.least_progress:
            self._least_left, self._least_turn = left, math.inf
            return True
        if to_turn < self._least_turn - self._config.least_turn:
            self._least_turn = to_turn
            return True
        return False

    def _is_found_again(self, senses: Senses) -> bool:
        """Whether the place is known again; what is remembered of another place is forgotten."""
        went_astray, self._went_astray = self._went_astray, False
        moved = senses.pose.distance_to(*self._known_at)
        if went_astray and moved > self._config.carried:
            self._obstacles.forget()
        self._known_at = (senses.pose.x, senses.pose.y)
        return went_astray

    def _plan_anew(self, senses: Senses, trouble: str) -> str:
        """Plan from here after trouble; return why the walk is given up, or nothing."""
        self._replans += 1
        if self._replans > self._config.max_replans:
            return f"gave up after {self._config.max_replans} ways around: {trouble}"
        try:
            self._begin(self._plan_to_look(senses), senses)
        except NoPathError as error:
            return f"{trouble}, and there is no way around it: {error}"
        return ""

    def _plan_around(self, senses: Senses) -> str:
        """Plan around what is seen on the path; return why the walk is given up, or nothing.

        Without a way the robot stands and looks again: people pass.
        """
        if self._blocked_since is None:
            self._blocked_since = senses.now
            self._ways_around += 1
        elif senses.now - self._looked < self._config.look_period:
            return ""
        self._looked = senses.now
        x, y = self.path.point_at(self._ahead.blocked_at or 0.0)
        self._trouble = f"{_UNKNOWN} in the way near ({x:.2f}, {y:.2f})"
        if self._ways_around > self._config.max_ways_around:
            return f"gave up after {self._config.max_ways_around} ways around: {self._trouble}"
        try:
            self._begin(self._plan(senses), senses)
        except NoPathError as error:
            self._trouble += f", and there is no way around it: {error}"
            if error.reason is NoPathReason.GOAL_IN_OBSTACLE:
                self._trouble = f"{_UNKNOWN} at the goal: {error}"
            if senses.now - self._blocked_since > self._config.blocked_wait:
                return self._trouble
        return ""

    def _plan(self, senses: Senses) -> Path:
        """Return a way around all that is known, if need be closely; raises NoPathError."""
        here, now = (senses.pose.x, senses.pose.y), senses.now
        try:
            return self._planner.plan(here, self.goal, self._obstacles.standing(now))
        except NoPathError:
            return self._planner.plan(here, self.goal, self._obstacles.at_least(now))

    def _plan_to_look(self, senses: Senses) -> Path:
        """Return the same, or a way that only what was felt blocks: what was seen may have gone."""
        here = (senses.pose.x, senses.pose.y)
        try:
            return self._plan(senses)
        except NoPathError:
            if math.dist(here, self.goal) <= self._config.arrival_tolerance:
                # It stands there, beside its station perhaps, where a body should not be.
                return Path(np.array([here]))
            return self._planner.plan(here, self.goal, self._obstacles.felt(senses.now))


def expected_duration(path: Path, max_speed: float) -> float:
    """Return the time, s, that a path takes at top speed; the walk's feedback is timed by it."""
    return path.length / max_speed


def feedback_period(duration: float) -> float:
    """Return the period of feedback, s, on a walk of ``duration`` s (the report's rule)."""
    if duration < 10.0:
        return 2.0
    return 3.0 if duration < 20.0 else 4.0
