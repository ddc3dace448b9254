"""Walking to a point: a path, a setpoint that moves along it, and what to do when it is blocked.

No clock and no I/O: it is ticked with what the robot senses and answers with what it wants.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from roomba.clock import ClockJumps
from roomba.configuration.robot import BodyConfig, WalkConfig
from roomba.geometry import Pose
from roomba.mission.driving.path_follower import PathFollower
from roomba.mission.driving.unknown_things import UnknownThings
from roomba.perception.localization.estimate import Knowledge
from roomba.planning.path.planner import NoPathError, Path, PathPlanner

Point = tuple[float, float]

_PROGRESS = 0.05
"""m; coming nearer to the goal by less than this is no progress."""
_STANDSTILL = 0.03
"""m/s; slower than this the robot stands."""
_LONGEST_TICK = 2.0
"""s; more between two ticks than this is a clock that was set."""
_OFF_PATH = 0.35
"""m; farther from its path than this the robot was carried or pushed, and plans anew."""


class WalkState(Enum):
    """How a walk stands."""

    WALKING = "walking"
    ASTRAY = "astray"
    """Under way, but the robot's place is not known; it continues when that is known again."""
    ARRIVED = "arrived"
    FAILED = "failed"
    """Given up; the reason is told."""


@dataclass(frozen=True, slots=True)
class Sensed:
    """What a walk needs to know at a tick: time in s, pose in the map frame, speed in m/s.

    ``knowledge`` is how well the pose is known, and ``trouble`` why not better.
    """

    now: float
    pose: Pose
    speed: float
    bumper_left: bool = False
    bumper_right: bool = False
    cliff_left: bool = False
    cliff_right: bool = False
    knowledge: Knowledge = Knowledge.KNOWN
    trouble: str = ""

    @property
    def touches(self) -> tuple[bool, bool]:
        """Whether something is in the way on the left, on the right: felt, or no floor seen."""
        return self.bumper_left or self.cliff_left, self.bumper_right or self.cliff_right


@dataclass(frozen=True, slots=True)
class WalkStep:
    """What a walk wants at a tick: the setpoint, m, and the cruise speed to go there, m/s."""

    state: WalkState
    setpoint: Point
    cruise_speed: float
    distance_left: float
    reason: str = ""


class Walk:
    """One walk to ``goal``.

    It ends by arriving or by failing, never otherwise: each new plan needs a bump, a standstill or
    a push, and there are at most ``max_replans`` of them.
    """

    def __init__(
        self,
        planner: PathPlanner,
        config: WalkConfig,
        body: BodyConfig,
        things: UnknownThings,
        goal: Point,
        sensed: Sensed,
    ) -> None:
        """Plan the way; raises NoPathError when there is none, ValueError for a goal not finite."""
        self.goal = goal
        self.path = planner.plan((sensed.pose.x, sensed.pose.y), goal, things.at(sensed.now))
        self._planner = planner
        self._config = config
        self._body = body
        self._things = things
        self._follower = PathFollower(self.path, config)
        self._started = sensed.now
        self._jumps = ClockJumps(last=sensed.now, longest=_LONGEST_TICK)
        self._replans = 0
        self._was_touching = any(sensed.touches)
        self._least_left = math.inf
        self._progressed = sensed.now
        self._went_astray = False
        self._astray_since = sensed.now

    def time_spent(self, now: float) -> float:
        """Return how long it has walked, s."""
        return now - self._started

    def tick(self, sensed: Sensed, max_speed: float) -> WalkStep:
        """Return what is wanted now; ``max_speed`` in m/s."""
        self._follow_clock(sensed.now)
        if not sensed.knowledge.is_usable:
            return self._wait_to_be_found(sensed, max_speed)
        if sensed.knowledge is Knowledge.ROUGH:
            max_speed = min(max_speed, self._config.careful_speed)
        if self._has_arrived(sensed):
            return WalkStep(WalkState.ARRIVED, self.goal, max_speed, 0.0)
        trouble = self._notice_trouble(sensed)
        if trouble:
            failure = self._plan_anew(sensed, trouble)
            if failure:
                here = (sensed.pose.x, sensed.pose.y)
                return WalkStep(WalkState.FAILED, here, max_speed, self._follower.left, failure)
        setpoint, cruise_speed = self._follower.tick(sensed.pose, max_speed)
        return WalkStep(WalkState.WALKING, setpoint, cruise_speed, self._follower.left)

    def _wait_to_be_found(self, sensed: Sensed, max_speed: float) -> WalkStep:
        """Ask for nothing while the robot's place is not known; it may look around meanwhile."""
        if not self._went_astray:
            self._went_astray, self._astray_since = True, sensed.now
        self._progressed = sensed.now
        is_lost = sensed.knowledge is Knowledge.LOST
        is_lost |= sensed.now - self._astray_since > self._config.astray_timeout
        return WalkStep(
            WalkState.FAILED if is_lost else WalkState.ASTRAY,
            (sensed.pose.x, sensed.pose.y),
            max_speed,
            self._follower.left,
            f"the robot does not know where it is: {sensed.trouble}",
        )

    def _follow_clock(self, now: float) -> None:
        """When the clock was set, move the times that are remembered with it."""
        jump = self._jumps.at(now)
        self._started += jump
        self._progressed += jump
        self._astray_since += jump

    def _has_arrived(self, sensed: Sensed) -> bool:
        near = sensed.pose.distance_to(*self.goal) <= self._config.arrival_tolerance
        return near and abs(sensed.speed) <= _STANDSTILL

    def _notice_trouble(self, sensed: Sensed) -> str:
        """Return why a new plan is needed, or nothing."""
        where = f"near ({sensed.pose.x:.2f}, {sensed.pose.y:.2f})"
        went_astray, self._went_astray = self._went_astray, False
        if went_astray:
            return f"the robot found itself again {where}"
        left, right = sensed.touches
        is_new, self._was_touching = (left or right) and not self._was_touching, left or right
        if is_new:
            self._things.felt(sensed.now, sensed.pose, left, right)
            if sensed.cliff_left or sensed.cliff_right:
                return f"the floor ends {where}"
            return f"something that the map does not show stands in the way {where}"
        if self._follower.distance_off(sensed.pose) > _OFF_PATH:
            return f"the robot was moved off its path {where}"
        if self._follower.left < self._least_left - _PROGRESS:
            self._least_left = self._follower.left
            self._progressed = sensed.now
        if sensed.now - self._progressed > self._config.progress_timeout:
            return f"the robot comes no nearer {where}"
        return ""

    def _plan_anew(self, sensed: Sensed, trouble: str) -> str:
        """Plan from here; return why the walk is given up, or nothing."""
        self._replans += 1
        if self._replans > self._config.max_replans:
            return f"gave up after {self._config.max_replans} ways around: {trouble}"
        obstacles = self._things.at(sensed.now)
        try:
            self.path = self._planner.plan((sensed.pose.x, sensed.pose.y), self.goal, obstacles)
        except NoPathError as error:
            return f"{trouble}, and there is no way around it: {error}"
        self._follower = PathFollower(self.path, self._config)
        self._least_left = math.inf
        self._progressed = sensed.now
        return ""


def expected_duration(path: Path, max_speed: float) -> float:
    """Return the time, s, that a path takes at top speed; the walk's feedback is timed by it."""
    return path.length / max_speed


def feedback_period(duration: float) -> float:
    """Return how often to tell the distance left, s, on a walk of ``duration`` s (SEED's rule)."""
    if duration < 10.0:
        return 2.0
    return 3.0 if duration < 20.0 else 4.0
