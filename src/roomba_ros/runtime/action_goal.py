"""One goal of an action, as its server keeps it: the part that all kinds of goals share."""

from __future__ import annotations

import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Final, NamedTuple, TypeVar

import actionlib
import rospy
from actionlib.handle_tracker_deleter import HandleTrackerDeleter
from actionlib.status_tracker import StatusTracker
from actionlib_msgs.msg import GoalID, GoalStatus

from roomba_ros.convert.errors import MessageError
from roomba_ros.runtime.subscriptions import refuse

_STATUS_PERIOD: Final = 0.2
"""s of wall time between two messages of the states of goals, as the library has it."""
MOST_GOALS: Final = 200
"""Goals, and cancels of goals to come, that a server keeps at the same time. Each status message
lists all of them, until 5 s after their end; more goals than that are rejected."""


class GoalIdentity(NamedTuple):
    """What identifies a goal: its action, its id, and its time."""

    action: str
    identity: str
    seconds: int
    nanoseconds: int


class ActionGoal(ABC):
    """One goal, from its coming to its end."""

    name: str
    """The action's name."""
    action: type
    """The action's type."""

    def __init__(self, handle: actionlib.ServerGoalHandle) -> None:
        """Take the action library's handle of it."""
        self._handle = handle

    @property
    def identity(self) -> GoalIdentity:
        """What identifies the goal."""
        told = self._handle.get_goal_id()
        return GoalIdentity(self.name, str(told.id), told.stamp.secs, told.stamp.nsecs)

    @property
    def is_recalled(self) -> bool:
        """Whether it was cancelled before it began."""
        return bool(self._handle.get_goal_status().status == GoalStatus.RECALLING)

    @abstractmethod
    def check(self) -> None:
        """Raise MessageError if it is not clear what the goal asks for."""

    @abstractmethod
    def reject(self, reason: str) -> None:
        """Tell why it is not begun."""


class SteadyActionServer(actionlib.ActionServer):
    """The library's action server, mended in three places.

    It publishes the status of its goals also when the clock is set. The library has a timer of the
    ROS clock for that, which ends when the clock is set back; clients then take the server for
    gone.

    A cancel may be repeated that comes before its goal, or long after the goal's end. The library
    logs errors then, as it looks for the goal of each cancel that it keeps.

    The number of goals and cancels is limited: a flood of them would make status messages ever
    longer.
    """

    def initialize(self) -> None:
        """Connect, and tell the states from now on."""
        super().initialize()
        self.status_timer.shutdown()
        threading.Thread(target=self._tell, name=f"{self.ns} status", daemon=True).start()

    def _tell(self) -> None:
        while not rospy.is_shutdown():
            time.sleep(_STATUS_PERIOD)
            try:
                self.publish_status_async(None)
            except rospy.ROSException as error:
                # The node is ending, and its connections were closed first.
                rospy.logdebug("states of goals are not told: %s", error)

    def internal_cancel_callback(self, goal_id: GoalID) -> None:
        """Cancel goals; a cancel may come before its goal."""
        with self.lock:
            if goal_id.id and not self._has_room_for(goal_id):
                self._refuse("cancel")
                return
            super().internal_cancel_callback(goal_id)
            for tracker in self.status_list:
                if tracker.goal is None:
                    tracker.goal = self.ActionGoal(goal_id=tracker.status.goal_id)

    def internal_goal_callback(self, goal: Any) -> None:
        """Take a goal; if too many came it is rejected, so that its client does not wait for it."""
        with self.lock:
            if self._has_room_for(goal.goal_id):
                super().internal_goal_callback(goal)
                return
            self._refuse("goal")
            if goal.goal_id.id:
                text = f"expected at most {MOST_GOALS} goals at the same time"
                status = GoalStatus(goal.goal_id, GoalStatus.REJECTED, text)
                # Status messages do not list this goal: they are to stay short.
                self.result_pub.publish(self.ActionResult(status=status))

    def _has_room_for(self, goal_id: GoalID) -> bool:
        """Whether the server keeps this goal already, or has room for one more."""
        told = self.status_list
        return len(told) < MOST_GOALS or any(each.status.goal_id.id == goal_id.id for each in told)

    def _refuse(self, topic: str) -> None:
        fault = f"expected at most {MOST_GOALS} goals at the same time, got one more"
        refuse(f"{self.ns}/{topic}", MessageError(fault))

    def adopt(self, identity: GoalIdentity) -> actionlib.ServerGoalHandle:
        """Return a handle of a goal that a server before this one had accepted.

        Call before :meth:`start`: a client takes a goal for lost that a server does not tell of.
        """
        goal = self.ActionGoal()
        stamp = rospy.Time(identity.seconds, identity.nanoseconds)
        goal.goal_id = GoalID(stamp, identity.identity)
        tracker = StatusTracker(goal=goal)
        tracker.status.status = GoalStatus.ACTIVE
        tracker.handle_tracker = HandleTrackerDeleter(self, tracker)
        self.status_list.append(tracker)
        return actionlib.ServerGoalHandle(tracker, self, tracker.handle_tracker)


Goal = TypeVar("Goal", bound=ActionGoal)


def server_of(
    kind: type[Goal],
    take: Callable[[Goal], object],
    cancel: Callable[[GoalIdentity], object],
) -> SteadyActionServer:
    """Return a server of an action, not started: ``take`` gets goals, ``cancel`` their identities.

    A goal that cannot be used is rejected, and counts as a message that was refused.
    """

    def hear(handle: actionlib.ServerGoalHandle) -> None:
        goal = kind(handle)
        try:
            goal.check()
        except MessageError as error:
            refuse(f"{kind.name}/goal", error)
            goal.reject(str(error))
            return
        take(goal)

    return SteadyActionServer(
        kind.name,
        kind.action,
        hear,
        lambda handle: cancel(kind(handle).identity),
        auto_start=False,
    )
