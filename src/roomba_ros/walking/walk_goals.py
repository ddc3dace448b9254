"""The goals of both actions that walk to a point, in one form for the server."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseFeedback, MoveBaseResult
from roomba_robot.msg import WalkToPointAction, WalkToPointFeedback, WalkToPointResult

from roomba.geometry import Point, Pose
from roomba.mission.walking.walk import feedback_period
from roomba_ros.convert.common import pose_in_map, pose_message, theta_of
from roomba_ros.convert.errors import require_finite
from roomba_ros.runtime.action_goal import ActionGoal


class WalkGoal(ActionGoal):
    """One place to walk to; ``time_spent`` in s."""

    @property
    @abstractmethod
    def destination(self) -> Point:
        """The point to walk to, m, map frame; raises MessageError for an invalid one."""

    @property
    @abstractmethod
    def heading(self) -> float | None:
        """The heading to turn to there, rad, map frame; None: any heading."""

    @abstractmethod
    def feedback_period(self, duration: float) -> float:
        """Return the time between two feedback messages, s, for a walk of ``duration`` s."""

    @abstractmethod
    def _result(self, time_spent: float) -> Any:
        """Return the action's result."""

    @abstractmethod
    def _feedback(self, now: float, distance: float, pose: Pose) -> Any:
        """Return the action's feedback."""

    def check(self) -> None:
        """Raise MessageError if there is no such place, or no such heading."""
        assert self.destination

    def accept(self, text: str) -> None:
        """Tell that it is walked to now."""
        self._handle.set_accepted(text)

    def reject(self, reason: str) -> None:
        """Tell why it is not walked to."""
        self._handle.set_rejected(self._result(0.0), reason)

    def arrived(self, time_spent: float, text: str) -> None:
        """Tell that the robot is there."""
        self._handle.set_succeeded(self._result(time_spent), text)

    def given_up(self, time_spent: float, reason: str) -> None:
        """Tell why the robot does not come there."""
        self._handle.set_aborted(self._result(time_spent), reason)

    def cancelled(self, time_spent: float, reason: str) -> None:
        """Tell that it was cancelled, or replaced by another goal."""
        self._handle.set_canceled(self._result(time_spent), reason)

    def tell(self, now: float, distance: float, pose: Pose) -> None:
        """Tell how far it is, m along the path, and where the robot is; ``now`` in s."""
        self._handle.publish_feedback(self._feedback(now, distance, pose))


class WalkToPointGoal(WalkGoal):
    """The report's own action."""

    name, action = "walk_to_point", WalkToPointAction

    @property
    def destination(self) -> Point:
        """Where to walk, m, map frame; raises MessageError."""
        wanted = self._handle.get_goal().destin
        require_finite("a destination", wanted.dest_x, wanted.dest_y)
        return wanted.dest_x, wanted.dest_y

    @property
    def heading(self) -> float | None:
        """None: the action asks for no final heading."""
        return None

    def feedback_period(self, duration: float) -> float:
        """Return the time between two feedback messages, s, by the report's rule."""
        return feedback_period(duration)

    def _result(self, time_spent: float) -> WalkToPointResult:
        return WalkToPointResult(time_spent)

    def _feedback(self, now: float, distance: float, pose: Pose) -> WalkToPointFeedback:
        return WalkToPointFeedback(distance)


class MoveBaseGoal(WalkGoal):
    """The action that navigation on ROS usually has."""

    name, action = "move_base", MoveBaseAction

    @property
    def destination(self) -> Point:
        """The point to walk to, m, map frame; raises MessageError for another frame, too."""
        pose = pose_in_map(self._handle.get_goal().target_pose)
        return pose.x, pose.y

    @property
    def heading(self) -> float | None:
        """The heading to turn to there, rad; None for an orientation of zeros."""
        wanted = self._handle.get_goal().target_pose.pose.orientation
        if not any((wanted.x, wanted.y, wanted.z, wanted.w)):
            return None
        return theta_of(wanted)

    def feedback_period(self, duration: float) -> float:
        """Return the time between two feedback messages, s."""
        return 0.2

    def _result(self, time_spent: float) -> MoveBaseResult:
        return MoveBaseResult()

    def _feedback(self, now: float, distance: float, pose: Pose) -> MoveBaseFeedback:
        return MoveBaseFeedback(pose_message(now, pose, "map"))


def checked_goal(message: PoseStamped) -> PoseStamped:
    """Return a goal's pose unchanged; raises MessageError for an invalid one.

    It is invalid in another frame than the map's, or with numbers that are not finite.
    """
    pose_in_map(message)
    return message
