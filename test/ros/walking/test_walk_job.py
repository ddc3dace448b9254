"""A goal goes through its stages, with exact feedback at each tick; without a graph."""

from __future__ import annotations

import threading
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from roomba.configuration.nodes import NodesConfig
from roomba.geometry import Pose, Twist
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk, WalkState, WalkStep
from roomba.perception.localization.estimate import Knowledge
from roomba.planning.path.planner import Path
from roomba_ros.walking.walk_goals import WalkGoal
from roomba_ros.walking.walk_job import WalkJob, WalkStage
from roomba_ros.walking.walk_topics import WalkTopics

NODES = NodesConfig()
END = NODES.walk_end
FASTEST = 0.4
"""m/s."""
HERE = Pose(0.5, 0.25, 1.0)
DRIVING = Senses(10.0, HERE, twist=Twist(0.2, 0.0))
UNDER_WAY = WalkStep(WalkState.WALKING, (0.75, 0.25), 0.3, 1.5)


class WrittenGoal:
    """Writes down what is told of it."""

    def __init__(self, heading: float | None) -> None:
        self.heading = heading
        self.told: list[tuple[Any, ...]] = []

    def feedback_period(self, duration: float) -> float:
        """Return a tenth of what the walk takes, s."""
        return duration / 10.0

    def __getattr__(self, name: str) -> Any:
        return lambda *arguments: self.told.append((name, *arguments))


class WrittenTopics:
    """Writes down what is told."""

    def __init__(self) -> None:
        self.told: list[tuple[Any, ...]] = []

    def __getattr__(self, name: str) -> Any:
        return lambda *arguments: self.told.append((name, *arguments))


class WrittenWalk:
    """Wants the same at each tick; begun at 5 s."""

    def __init__(self) -> None:
        self.path = Path(np.array([[0.0, 0.0], [2.0, 0.0]]))
        self.step = UNDER_WAY
        self.planning = threading.Lock()

    def time_spent(self, now: float) -> float:
        return now - 5.0

    def tick(self, senses: Senses, max_speed: float) -> WalkStep:
        assert self.planning.locked(), "make_plan may plan at the same time"
        assert max_speed == FASTEST
        return self.step


class Walking:
    """A job over what only writes down."""

    def __init__(self, heading: float | None = None) -> None:
        self.goal, self.topics, self.walk = WrittenGoal(heading), WrittenTopics(), WrittenWalk()
        self.job = WalkJob(
            cast(WalkGoal, self.goal),
            cast(Walk, self.walk),
            cast(WalkTopics, self.topics),
            NODES,
            self.walk.planning,
        )

    def tick(self, senses: Senses = DRIVING, **changes: Any) -> list[tuple[Any, ...]]:
        """Return what topics and then the goal are told."""
        self.job.tick(replace(senses, **changes), FASTEST)
        return self.taken()

    def taken(self) -> list[tuple[Any, ...]]:
        told = [*self.topics.told, *self.goal.told]
        self.topics.told.clear()
        self.goal.told.clear()
        return told

    def arrive(self) -> None:
        self.walk.step = WalkStep(WalkState.ARRIVED, (2.0, 0.0), FASTEST, 0.0)


def test_a_goal_is_accepted_and_its_path_shown() -> None:
    walking = Walking()
    walking.job.begin(10.0, FASTEST)
    shown = ("show_path", 10.0, walking.walk)
    assert walking.taken() == [shown, ("accept", "2.00 m to walk")]
    assert walking.job.stage is WalkStage.WALKING


def test_the_setpoint_is_told_at_each_tick_and_feedback_by_its_period() -> None:
    walking = Walking()
    walking.job.begin(10.0, FASTEST)  # 2 m at 0.4 m/s: feedback each 0.5 s
    walking.taken()
    at, to, far = ("drive_at", 0.3), ("drive_to", 0.75, 0.25), ("tell", 10.0, 1.5, HERE)
    assert walking.tick() == [at, to, far]
    assert walking.tick(now=10.05) == [at, to]
    assert walking.tick(now=10.5) == [at, to, ("tell", 10.5, 1.5, HERE)]
    assert walking.tick(now=2.0) == [at, to, ("tell", 2.0, 1.5, HERE)], "a clock that was set back"


def test_a_cruise_speed_is_told_at_each_tick() -> None:
    walking = Walking()
    walking.job.begin(10.0, FASTEST)
    speeds = []
    for tick in range(4):
        if tick == 2:
            walking.walk.step = replace(UNDER_WAY, cruise_speed=0.1)
        speeds += [(tick, *rest) for name, *rest in walking.tick() if name == "drive_at"]
    assert speeds == [(0, 0.3), (1, 0.3), (2, 0.1), (3, 0.1)]


def test_a_new_way_is_shown() -> None:
    walking = Walking()
    walking.tick()

    def plan_anew(senses: Senses, max_speed: float) -> WalkStep:
        walking.walk.path = Path(np.array([[0.0, 0.0], [0.0, 1.0]]))
        return UNDER_WAY

    walking.walk.tick = plan_anew  # type: ignore[method-assign]
    assert ("show_path", 10.0, walking.walk) in walking.tick()


def test_while_the_robot_is_astray_it_is_told_that_the_walk_goes_on() -> None:
    walking = Walking()
    walking.job.begin(10.0, FASTEST)
    walking.tick()
    walking.walk.step = replace(UNDER_WAY, state=WalkState.ASTRAY)
    still = [("drive_at", 0.3), ("drive_to", 0.75, 0.25)]
    assert walking.tick(now=10.5) == [*still, ("tell", 10.5, 1.5, HERE)]
    assert walking.tick(now=10.55) == still
    assert walking.job.stage is WalkStage.WALKING


def test_where_the_heading_does_not_matter_it_is_over_at_the_goal() -> None:
    walking = Walking()
    walking.arrive()
    assert walking.tick()[-1] == ("arrived", 5.0, "arrived")
    assert walking.job.is_over
    assert walking.tick() == []


def test_a_walk_that_failed_is_given_up_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rospy.logwarn", lambda *_: None)
    walking = Walking()
    walking.walk.step = WalkStep(WalkState.FAILED, (0.5, 0.25), 0.3, 1.5, "a wall")
    assert walking.tick()[-1] == ("given_up", 5.0, "a wall")
    assert walking.job.is_over


def test_at_the_goal_it_turns_until_it_looks_there_and_stands() -> None:
    walking = Walking(heading=1.5)
    walking.arrive()
    walking.tick()
    assert walking.job.stage is WalkStage.TURNING
    turn = [("turn_to", 1.5)]
    assert [each for each in walking.tick(now=10.1) if each[0] != "tell"] == turn
    looking = replace(DRIVING, pose=Pose(2.0, 0.0, 1.5 + 0.9 * END.aimed))
    turning = replace(looking, twist=Twist(0.0, END.not_turning))
    assert [each for each in walking.tick(turning) if each[0] != "tell"] == turn
    assert walking.tick(looking, now=11.0) == [("arrived", 6.0, "arrived")]
    assert walking.job.is_over


def test_a_turn_that_does_not_end_is_given_up() -> None:
    walking = Walking(heading=1.5)
    walking.arrive()
    walking.tick()
    assert ("turn_to", 1.5) in walking.tick(now=9.99 + END.longest_turn)
    ended = walking.tick(now=10.0 + END.longest_turn)
    text = "it is there, but 0.50 rad were not turned"
    assert ended == [("given_up", 5.0 + END.longest_turn, text)]


def test_a_cancelled_walk_brakes_then_lets_its_place_be_heard_and_frees_the_speed() -> None:
    walking = Walking()
    walking.tick()
    walking.job.cancel(10.0)
    braking = [("drive_at", 0.0), ("drive_to", 0.75, 0.25)]
    assert walking.tick(now=10.1) == braking
    assert walking.tick(now=10.2, twist=Twist(END.standstill, 0.0)) == braking
    assert walking.job.stage is WalkStage.LETTING_GO
    place = ("drive_to", 0.5, 0.25)
    assert walking.tick(now=10.3) == [place]
    walking.job.cancel(10.3)
    assert walking.tick(now=10.19 + END.heard_by) == [place]
    lost = walking.tick(now=10.2 + END.heard_by, knowledge=Knowledge.LOST)
    assert lost == [("drive_at", FASTEST), ("cancelled", 5.2 + END.heard_by, "cancelled")]
    assert walking.job.is_over


def test_without_odometry_it_counts_as_standing_after_a_while() -> None:
    walking = Walking()
    walking.job.cancel(10.0)
    walking.job.cancel(10.5)
    assert walking.tick(now=10.4 + END.longest_braking) == [("drive_at", 0.0)]
    assert walking.job.stage is WalkStage.BRAKING
    walking.tick(now=10.5 + END.longest_braking)
    assert walking.job.stage is WalkStage.LETTING_GO


def test_a_clock_that_was_set_back_is_not_waited_for() -> None:
    walking = Walking()
    walking.job.cancel(10.0)
    walking.tick(twist=Twist(0.0, 0.0))
    assert walking.tick(now=9.9)[-1] == ("cancelled", 4.9, "cancelled")


def test_it_turns_no_more_when_it_is_cancelled() -> None:
    walking = Walking(heading=1.5)
    walking.arrive()
    walking.tick()
    walking.job.cancel(10.0)
    assert walking.tick() == [("drive_at", 0.0), ("drive_to", 2.0, 0.0)]


def test_it_ends_at_once_for_another_goal_or_for_a_reason() -> None:
    walking = Walking()
    walking.job.replaced(12.0, "a newer goal took over")
    assert walking.taken() == [("cancelled", 7.0, "a newer goal took over")]
    assert walking.job.is_over
    other = Walking()
    other.job.give_up(12.0, "held")
    assert other.taken() == [("given_up", 7.0, "held")]
    assert other.job.is_over
    other.job.cancel(12.0)
    assert other.job.is_over
