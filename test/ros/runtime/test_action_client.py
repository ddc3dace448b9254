"""The action client, over ROS's own client, which gets an answer while it still sends."""

import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
import rospy
from actionlib import CommState, SimpleGoalState
from actionlib.action_client import ClientGoalHandle
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from fixtures.graph import RosGraph
from fixtures.nodes.errand import Errand
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from roomba_robot.msg import DockAction, DockActionGoal, DockActionResult, DockGoal

from roomba_ros.runtime import action_client
from roomba_ros.runtime.action_client import ActionClient, GoalClient, GoalProgress, is_heard
from roomba_ros.runtime.action_goal import server_of


class Eager:
    """In place of the stock client's lower half: the answer is there before the goal is sent."""

    def __init__(self, *_: Any) -> None:
        self.ns = "walk"
        self.answers: list[threading.Thread] = []

    def send_goal(
        self, _: str, on_transition: Callable[[Any], None], on_feedback: Callable[[Any, Any], None]
    ) -> Any:
        handle = SimpleNamespace(get_comm_state=lambda: CommState.DONE)

        def answer() -> None:
            on_feedback(handle, "half way")
            on_transition(handle)

        self.answers.append(threading.Thread(target=answer))
        self.answers[-1].start()
        # Long enough for an answer that nothing holds up.
        self.answers[-1].join(0.2)
        return handle


@pytest.mark.filterwarnings("ignore:notifyAll:DeprecationWarning")
def test_what_is_answered_while_it_sends_is_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(action_client, "GoalClient", Eager)
    client = ActionClient("walk", object)
    feedback: list[str] = []
    client.send_goal("there", feedback_cb=feedback.append)
    client.action_client.answers[0].join(20.0)
    assert client.simple_state == SimpleGoalState.DONE
    assert feedback == ["half way"]


class Sent:
    """A goal that was sent, and what the library complained of since."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.errors: list[str] = []
        monkeypatch.setattr(rospy, "logerr", lambda text, *_: self.errors.append(text))
        self.cancels: list[GoalID] = []
        self.goals: list[DockActionGoal] = []
        goal = DockActionGoal(goal_id=GoalID(id="this"))
        send = (self.goals.append, self.cancels.append)
        self.progress = GoalProgress(goal, None, None, *send)
        self.handle = ClientGoalHandle(self.progress)

    def tell(self, **states: int) -> None:
        told = [GoalStatus(goal_id=GoalID(id=name), status=at) for name, at in states.items()]
        self.progress.update_status(GoalStatusArray(status_list=told))

    def end(self, status: int) -> None:
        ended = GoalStatus(goal_id=GoalID(id="this"), status=status)
        self.progress.update_result(DockActionResult(status=ended))

    @property
    def end_told(self) -> int | None:
        """The status with which it ended; None before that."""
        is_done = self.handle.get_comm_state() == CommState.DONE
        return int(self.handle.get_terminal_state()) if is_done else None


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch) -> Sent:
    return Sent(monkeypatch)


def test_a_goal_cancelled_before_it_was_heard_ends_as_its_server_says(sent: Sent) -> None:
    sent.handle.cancel()
    sent.tell(other=GoalStatus.ACTIVE)
    assert sent.end_told is None
    sent.end(GoalStatus.RECALLED)
    assert (sent.end_told, sent.errors) == (GoalStatus.RECALLED, [])


def test_a_cancel_after_the_end_changes_nothing(sent: Sent) -> None:
    sent.tell(this=GoalStatus.ACTIVE)
    sent.end(GoalStatus.SUCCEEDED)
    sent.handle.cancel()
    sent.tell(this=GoalStatus.RECALLING)
    sent.end(GoalStatus.RECALLED)
    assert len(sent.cancels) == 1
    assert (sent.end_told, sent.errors) == (GoalStatus.SUCCEEDED, [])


def test_a_goal_that_its_server_forgot_is_lost_and_a_late_result_is_no_error(sent: Sent) -> None:
    sent.tell(this=GoalStatus.ACTIVE)
    sent.tell(other=GoalStatus.ACTIVE)
    assert sent.end_told == GoalStatus.LOST
    sent.end(GoalStatus.SUCCEEDED)
    assert (sent.end_told, sent.errors) == (GoalStatus.LOST, [])


def test_a_new_server_gets_what_none_has_heard(sent: Sent) -> None:
    sent.progress.send_again()
    assert [goal.goal_id.id for goal in sent.goals] == ["this"]
    sent.progress.cancel_again()
    assert sent.cancels == []
    sent.tell(this=GoalStatus.ACTIVE)
    sent.progress.send_again()
    assert len(sent.goals) == 1


def test_a_new_server_gets_the_cancel_of_a_goal_and_not_the_goal(sent: Sent) -> None:
    sent.handle.cancel()
    sent.progress.send_again()
    sent.progress.cancel_again()
    assert ([cancel.id for cancel in sent.cancels], sent.goals) == (["this", "this"], [])
    sent.tell(this=GoalStatus.RECALLING)
    sent.progress.cancel_again()
    sent.tell(other=GoalStatus.ACTIVE)
    assert (len(sent.cancels), sent.end_told) == (2, GoalStatus.LOST)


def test_a_goal_that_none_has_heard_for_long_is_lost_and_not_begun_late(
    sent: Sent, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(action_client, "SERVER_DEADLINE", -1.0)
    sent.progress.send_again()
    assert (sent.goals, sent.end_told) == ([], GoalStatus.LOST)


def test_a_goal_whose_server_ended_before_it_told_the_result_is_lost(sent: Sent) -> None:
    sent.tell(this=GoalStatus.ACTIVE)
    sent.tell(this=GoalStatus.SUCCEEDED)
    assert sent.end_told is None
    sent.tell(other=GoalStatus.ACTIVE)
    assert sent.end_told == GoalStatus.LOST


def test_a_goal_that_is_sent_before_its_server_is_there_is_taken_once(master: RosGraph) -> None:
    Probe(master)
    client = GoalClient("errand", DockAction)
    ended: list[int] = []

    def on_transition(handle: Any) -> None:
        if handle.get_comm_state() == CommState.DONE:
            ended.append(handle.get_terminal_state())

    sent = client.send_goal(DockGoal(), on_transition)
    taken: list[Errand] = []
    server_of(Errand, taken.append, lambda _: None).start()
    wait_until(lambda: taken, 20.0, "the goal")
    wait_until(lambda: is_heard(sent), 20.0, "the server tells of it")
    assert len(taken) == 1
    assert ended == []
