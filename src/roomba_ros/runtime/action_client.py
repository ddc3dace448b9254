"""Clients of an action that lose no answer, and take none for an error that is only late."""

from __future__ import annotations

import threading
import time
import weakref
from collections.abc import Callable
from typing import Any

import actionlib
import rospy
from actionlib import CommState, SimpleGoalState
from actionlib.action_client import ClientGoalHandle, CommStateMachine, GoalManager
from actionlib_msgs.msg import GoalID, GoalStatusArray

from roomba_ros.runtime.calls import SERVER_DEADLINE


class GoalClient(actionlib.ActionClient):
    """The library's client of many goals, each of which ends once.

    The library's client has three faults that this one mends. It takes a goal for lost that is
    cancelled before the server heard of it, since the server's status messages do not name the goal
    yet; the true result is an error then. It revives a goal that is cancelled after its end. A goal
    that is sent while the server restarts reaches no server and never ends; this client sends it
    again to the new server, for some seconds.
    """

    def __init__(self, name: str, action: type) -> None:
        """Connect to the action of that name and type."""
        super().__init__(name, action)
        goals = _Goals(action)
        goals.register_send_goal_fn(self.pub_goal.publish)
        goals.register_cancel_fn(self.pub_cancel.publish)
        # Answers come by this client's own callbacks, which ask for it by that name.
        self.manager = goals
        self.pub_goal.impl.add_subscriber_listener(_OnServer(goals.send_again))
        self.pub_cancel.impl.add_subscriber_listener(_OnServer(goals.cancel_again))


class ActionClient(actionlib.SimpleActionClient):
    """The library's client of one goal at a time, with one lock around sending and its callbacks.

    Without the lock, an answer that comes while a goal is being sent is taken for an answer to an
    older goal and dropped; then the goal never ends (actionlib issue 206).
    """

    def __init__(self, name: str, action: type) -> None:
        """Connect to the action of that name and type."""
        # As in the library's constructor, but with the client above in place of its own.
        self._sending = threading.RLock()
        self.action_client = GoalClient(name, action)
        self.simple_state = SimpleGoalState.DONE
        self.gh = None
        self.done_condition = threading.Condition()

    def send_goal(self, *arguments: Any, **callbacks: Any) -> None:
        """Send a goal in place of the one before."""
        with self._sending:
            super().send_goal(*arguments, **callbacks)

    def _handle_transition(self, handle: Any) -> None:
        with self._sending:
            # News of an earlier goal is late, and no error.
            if handle == self.gh:
                super()._handle_transition(handle)

    def _handle_feedback(self, handle: Any, feedback: Any) -> None:
        with self._sending:
            if handle == self.gh:
                super()._handle_feedback(handle, feedback)


def is_heard(handle: Any) -> bool:
    """Whether the server has told of a goal."""
    return bool(handle.comm_state_machine.is_heard)


class GoalProgress(CommStateMachine):
    """What a client knows of one goal: its state, by the messages of its server."""

    def __init__(self, *arguments: Any) -> None:
        """Take what the library's own takes: the goal, callbacks, and how to send and cancel."""
        super().__init__(*arguments)
        self.is_heard = False
        self._made = time.monotonic()

    def update_status(self, statuses: GoalStatusArray) -> None:
        """Hear the states of all goals of the server."""
        with self.mutex:
            named = {each.goal_id.id for each in statuses.status_list}
            self.is_heard = self.is_heard or self.action_goal.goal_id.id in named
            # A status message from before the server had the goal says nothing about the goal.
            if self.is_heard:
                super().update_status(statuses)
            # The goal has ended, and its server ended before it sent the result.
            is_forgotten = self.action_goal.goal_id.id not in named
            if is_forgotten and self.state == CommState.WAITING_FOR_RESULT:
                self._mark_as_lost()

    def update_result(self, result: Any) -> None:
        """Take a result, perhaps that of another goal."""
        with self.mutex:
            if self.state != CommState.DONE:
                super().update_result(result)

    def send_again(self) -> None:
        """Send the goal to a restarted server, if none has heard it; an old goal is lost."""
        with self.mutex:
            if self.is_heard or self.state != CommState.WAITING_FOR_GOAL_ACK:
                return
            if time.monotonic() - self._made <= SERVER_DEADLINE:
                self.send_goal_fn(self.action_goal)
            else:
                self._mark_as_lost()

    def cancel_again(self) -> None:
        """Send the cancel to a restarted server, if none has answered it."""
        with self.mutex:
            if self.state == CommState.WAITING_FOR_CANCEL_ACK:
                self.send_cancel_fn(GoalID(id=self.action_goal.goal_id.id))

    def transition_to(self, state: int) -> None:
        """Change the state; a goal that has ended stays so, even when it is cancelled."""
        if self.state != CommState.DONE:
            super().transition_to(state)


class _Goals(GoalManager):
    """Goals that were sent, followed by :class:`GoalProgress`."""

    def init_goal(self, goal: Any, transition_cb: Any = None, feedback_cb: Any = None) -> Any:
        """Send a goal; return the handle of it, as the library does."""
        action_goal = self.ActionGoal(goal_id=self._generate_id(), goal=goal)
        action_goal.header.stamp = action_goal.goal_id.stamp
        progress = GoalProgress(
            action_goal, transition_cb, feedback_cb, self.send_goal_fn, self.cancel_fn
        )
        with self.list_mutex:
            self.statuses.append(weakref.ref(progress))
        self.send_goal_fn(action_goal)
        return ClientGoalHandle(progress)

    def send_again(self) -> None:
        """Send a restarted server all goals that none has heard."""
        for progress in self._get_live_statuses():
            progress.send_again()

    def cancel_again(self) -> None:
        """Send a restarted server all cancels that none has answered."""
        for progress in self._get_live_statuses():
            progress.cancel_again()


class _OnServer(rospy.SubscribeListener):
    """Calls a function when a server subscribes to a topic."""

    def __init__(self, call: Callable[[], None]) -> None:
        self._call = call

    def peer_subscribe(self, *_: Any) -> None:
        """Call the function: one more node subscribes."""
        self._call()
