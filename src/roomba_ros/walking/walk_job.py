"""A goal under way: the walk, the turn at its end, and how it comes to rest when cancelled."""

from __future__ import annotations

import enum
import math
import threading

import rospy

from roomba.configuration.nodes import NodesConfig
from roomba.geometry import wrap_angle
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk, WalkState, expected_duration
from roomba_ros.walking.walk_goals import WalkGoal
from roomba_ros.walking.walk_topics import WalkTopics


class WalkStage(enum.Enum):
    """The stage that a goal under way is in."""

    WALKING = enum.auto()
    """The robot drives along its path."""
    TURNING = enum.auto()
    """It is there, and turns on the spot to the heading that the goal wants."""
    BRAKING = enum.auto()
    """The goal was cancelled, and the robot does not stand yet."""
    LETTING_GO = enum.auto()
    """The robot stands; the cruise speed stays 0 until its place was heard as the setpoint."""
    OVER = enum.auto()
    """The goal's end was reported."""


class WalkJob:
    """A goal being walked to; a setpoint is told at each tick until it is over."""

    def __init__(
        self,
        goal: WalkGoal,
        walk: Walk,
        topics: WalkTopics,
        nodes: NodesConfig,
        planning: threading.Lock,
    ) -> None:
        """Tell nothing yet; ``planning`` is held while the walk may plan."""
        self.goal, self.stage = goal, WalkStage.WALKING
        self._walk, self._topics, self._planning = walk, topics, planning
        self._end = nodes.walk_end
        self._stage_ends = math.inf
        """When the stage ends at the latest, s of the robot's clock."""
        self._setpoint: tuple[float, float] | None = None
        """The newest setpoint that was published, m; None before the first."""
        self._feedback_period = self._feedback_due = 0.0

    @property
    def is_over(self) -> bool:
        """Whether its end was told."""
        return self.stage is WalkStage.OVER

    def begin(self, now: float, max_speed: float) -> None:
        """Accept the goal; ``now`` in s, and m/s."""
        path = self._walk.path
        self.goal.accept(f"{path.length:.2f} m to walk")
        self._feedback_period = self.goal.feedback_period(expected_duration(path, max_speed))
        self._feedback_due = now
        self._topics.show_path(now, self._walk)

    def tick(self, senses: Senses, max_speed: float) -> None:
        """Go on with the stage that it is in; m/s at most."""
        if self.stage is WalkStage.WALKING:
            self._walk_on(senses, max_speed)
        elif self.stage is WalkStage.TURNING:
            self._turn(senses)
        elif self.stage is WalkStage.BRAKING:
            self._brake(senses)
        elif self.stage is WalkStage.LETTING_GO:
            self._let_go(senses, max_speed)

    def cancel(self, now: float) -> None:
        """Come to rest, and then tell that it was cancelled; ``now`` in s."""
        if self.stage not in (WalkStage.LETTING_GO, WalkStage.OVER):
            self.stage, self._stage_ends = WalkStage.BRAKING, now + self._end.longest_braking

    def replaced(self, now: float, reason: str) -> None:
        """Make room for another goal at once; ``now`` in s."""
        self.stage = WalkStage.OVER
        self.goal.cancelled(self._walk.time_spent(now), reason)

    def give_up(self, now: float, reason: str) -> None:
        """End at once, and tell why; ``now`` in s."""
        self.stage = WalkStage.OVER
        self.goal.given_up(self._walk.time_spent(now), reason)

    def _walk_on(self, senses: Senses, max_speed: float) -> None:
        walk = self._walk
        path = walk.path
        with self._planning:
            step = walk.tick(senses, max_speed)
        if walk.path is not path:
            rospy.loginfo("a new way: %.2f m to walk", walk.path.length)
            self._topics.show_path(senses.now, walk)
        self._topics.drive_at(step.cruise_speed)
        # While the pose is unknown a setpoint moves nothing, but shows that the walk goes on.
        self._setpoint = step.setpoint
        self._topics.drive_to(*step.setpoint)
        if step.state in (WalkState.WALKING, WalkState.ASTRAY):
            # Also while the pose is unknown: a walk without feedback counts as lost.
            self._tell_feedback(senses, step.distance_left)
        elif step.state is not WalkState.ARRIVED:
            rospy.logwarn("walk given up: %s", step.reason)
            self.give_up(senses.now, step.reason)
        elif self.goal.heading is not None:
            self.stage = WalkStage.TURNING
            self._stage_ends = senses.now + self._end.longest_turn
        else:
            self._arrive(senses.now)

    def _turn(self, senses: Senses) -> None:
        """Turn on the spot to the heading that the goal wants."""
        wanted = self.goal.heading
        assert wanted is not None
        wrong = wrap_angle(wanted - senses.pose.theta)
        stands = abs(senses.twist.angular) < self._end.not_turning
        if abs(wrong) < self._end.aimed and stands:
            self._arrive(senses.now)
        elif senses.now < self._stage_ends:
            self._topics.turn_to(wanted)
            self._tell_feedback(senses, 0.0)
        else:
            self.give_up(senses.now, f"it is there, but {wrong:.2f} rad were not turned")

    def _brake(self, senses: Senses) -> None:
        """Publish speed 0 and the last setpoint again: a stream that stops counts as lost."""
        self._topics.drive_at(0.0)
        if self._setpoint is not None:
            self._topics.drive_to(*self._setpoint)
        stands = abs(senses.twist.linear) <= self._end.standstill
        if stands or senses.now >= self._stage_ends:
            self.stage = WalkStage.LETTING_GO
            self._stage_ends = senses.now + self._end.heard_by

    def _let_go(self, senses: Senses, max_speed: float) -> None:
        """Publish the robot's place as the setpoint, and only then free the speed.

        If the speed were free before that setpoint arrived, the robot would drive to the old one.
        """
        if senses.knowledge.is_usable:
            self._topics.drive_to(senses.pose.x, senses.pose.y)
        # Do not wait by a clock that was set back.
        if self._stage_ends - self._end.heard_by <= senses.now < self._stage_ends:
            return
        self._topics.drive_at(max_speed)
        self.replaced(senses.now, "cancelled")

    def _arrive(self, now: float) -> None:
        self.stage = WalkStage.OVER
        self.goal.arrived(self._walk.time_spent(now), "arrived")

    def _tell_feedback(self, senses: Senses, distance_left: float) -> None:
        now = senses.now
        if now < self._feedback_due - self._feedback_period:
            self._feedback_due = now
        if now >= self._feedback_due:
            self._feedback_due += self._feedback_period
            self.goal.tell(now, distance_left, senses.pose)
