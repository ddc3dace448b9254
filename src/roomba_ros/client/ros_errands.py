"""Cleans, walks and ways to the station under way, as a client of the servers sees them."""

from __future__ import annotations

import math
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Final, Generic, TypeVar

import rospy
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from roomba_robot.msg import CleanFeedback, CleanResult

from roomba.client.protocol import (
    CleanProgress,
    CleanReport,
    DockReport,
    ErrandOutcome,
    ExploreReport,
    RobotUnavailableError,
    WalkOutcome,
    WalkReport,
)
from roomba_ros.convert.client import (
    clean_end_of,
    exploration_end_of,
    outcome_of,
    progress_of,
)
from roomba_ros.convert.values import unchanged
from roomba_ros.runtime.action_client import GoalClient, is_heard
from roomba_ros.runtime.calls import SERVER_DEADLINE
from roomba_ros.runtime.subscriptions import subscribe

SILENCE_DEADLINE: Final = 2.5
"""s of wall time without the server's status (5 Hz) after which it is taken for dead."""
_ENDINGS: Final = {
    GoalStatus.SUCCEEDED: ErrandOutcome.COMPLETED,
    GoalStatus.PREEMPTED: ErrandOutcome.STOPPED,
    GoalStatus.RECALLED: ErrandOutcome.STOPPED,
    GoalStatus.REJECTED: ErrandOutcome.REFUSED,
    GoalStatus.ABORTED: ErrandOutcome.FAULT,
    GoalStatus.LOST: ErrandOutcome.DISCONNECTED,
}
_WALKS: Final = {
    ErrandOutcome.COMPLETED: WalkOutcome.ARRIVED,
    ErrandOutcome.STOPPED: WalkOutcome.CANCELLED,
    ErrandOutcome.REFUSED: WalkOutcome.REFUSED,
    ErrandOutcome.DISCONNECTED: WalkOutcome.DISCONNECTED,
}
"""How walks end; in any other way they failed."""

_Told = TypeVar("_Told")
_Report = TypeVar("_Report")


def wait_for_server(client: Any, deadline: float) -> bool:
    """Wait by the wall clock: the stock call's clock, the robot's, may stand still or jump."""
    end = time.monotonic() + deadline
    while not rospy.is_shutdown() and time.monotonic() < end:
        if client.wait_for_server(rospy.Duration(0.001)):
            return True
        time.sleep(0.02)
    return False


class Server:
    """An action server as its client sees it: where goals go to, and whether it lives."""

    def __init__(self, name: str, action: type) -> None:
        self.name = name
        # Not the simple client: that follows its newest goal alone, so a refused one hides the
        # others.
        self._client = GoalClient(name, action)
        self._status_seen = -math.inf
        subscribe(f"{name}/status", GoalStatusArray, unchanged, self._on_status)

    @property
    def silence(self) -> float:
        """s of wall time since it told its status."""
        return time.monotonic() - self._status_seen

    def send(self, goal: Any, on_change: Any, on_feedback: Any) -> Any:
        """Send a goal; return the action library's handle of it."""
        if not wait_for_server(self._client, SERVER_DEADLINE):
            raise RobotUnavailableError(
                f"no action server answers on {self.name} within {SERVER_DEADLINE:g} s; "
                "is the robot running (`./roomba run`)?"
            )
        self._status_seen = time.monotonic()
        return self._client.send_goal(goal, on_change, on_feedback)

    def _on_status(self, _: GoalStatusArray) -> None:
        self._status_seen = time.monotonic()


class _Errand(ABC, Generic[_Told, _Report]):
    """A goal under way. One lock guards sending and answers: an answer may come while it is sent.

    The goal is not cancelled when the server falls silent: a restarted server resumes a clean by
    itself.
    """

    _after_silence = (
        "; a clean goes on by itself once that is back, and vacuum/state tells how far it is"
    )

    def __init__(self, server: Server, goal: Any) -> None:
        self._server = server
        self._news = threading.Condition(threading.RLock())
        self._newest: _Told | None = None
        self._is_new = False
        self._report: _Report | None = None
        with self._news:
            self._handle = server.send(goal, self._on_change, self._on_feedback)
            self._started, self._sent = rospy.get_time(), time.monotonic()

    def next_feedback(self, timeout: float) -> _Told | None:
        deadline = time.monotonic() + timeout
        while self.report() is None:
            with self._news:
                if self._is_new:
                    self._is_new = False
                    return self._newest
                left = deadline - time.monotonic()
                if left <= 0.0:
                    return None
                # In slices: no event tells when the server falls silent.
                self._news.wait(min(left, 0.1))
        return None

    def report(self) -> _Report | None:
        with self._news:
            if self._report is None:
                self._notice_silence()
            return self._report

    def cancel(self) -> None:
        self._handle.cancel()

    @abstractmethod
    def _told(self, feedback: Any) -> _Told:
        """Return what a feedback message tells."""

    @abstractmethod
    def _ended(self, outcome: ErrandOutcome, result: Any, message: str) -> _Report:
        """Return the report; ``result`` is the result message, or None without one."""

    def _notice_silence(self) -> None:
        silence, waited = self._server.silence, time.monotonic() - self._sent
        if silence > SILENCE_DEADLINE:
            why = f"the action server has been silent for {SILENCE_DEADLINE:g} s"
        elif not is_heard(self._handle) and waited > SERVER_DEADLINE:
            why = f"the action server took no notice of it for {SERVER_DEADLINE:g} s"
        else:
            return
        self._report = self._ended(ErrandOutcome.DISCONNECTED, None, f"{why}{self._after_silence}")

    def _on_feedback(self, _: Any, feedback: Any) -> None:
        with self._news:
            self._newest, self._is_new = self._told(feedback), True
            self._news.notify_all()

    def _on_change(self, handle: Any) -> None:
        with self._news:
            if handle.get_comm_state() != CommState.DONE or self._report is not None:
                return
            outcome = _ENDINGS[handle.get_terminal_state()]
            text = handle.get_goal_status_text()
            if outcome is ErrandOutcome.DISCONNECTED:
                text = f"the action server began anew and knows nothing of it{self._after_silence}"
            self._report = self._ended(outcome, handle.get_result(), text)
            self._news.notify_all()


class RosClean(_Errand[CleanProgress, CleanReport]):
    """A clean under way."""

    def _told(self, feedback: CleanFeedback) -> CleanProgress:
        return progress_of(feedback)

    def _ended(self, outcome: ErrandOutcome, result: Any, message: str) -> CleanReport:
        is_given_up = outcome is ErrandOutcome.FAULT and result is not None
        if is_given_up and result.outcome == CleanResult.STOPPED:
            # The client gave up with its server: the clean's numbers are unknown.
            result = None
        if result is None:
            newest = self._newest
            return CleanReport(
                outcome=outcome,
                message=message,
                covered=math.nan if newest is None else newest.covered,
                wanted=math.nan if newest is None else newest.wanted,
                dirt=math.nan,
                distance=math.nan,
                duration=rospy.get_time() - self._started,
                energy=math.nan,
            )
        if outcome is not ErrandOutcome.REFUSED:
            outcome = outcome_of(result.outcome)
        # Only the goal's status says which program ended a clean.
        return clean_end_of(result, outcome, message if outcome is ErrandOutcome.STOPPED else "")


class RosWalk(_Errand[float, WalkReport]):
    """A walk under way. With a server that is silent it ends."""

    _after_silence = ""

    def __init__(self, server: Server, goal: Any, travelled: Callable[[], float]) -> None:
        """Send the goal; ``travelled`` is how far the robot has moved, m, since any time."""
        self._travelled, self._travelled_before = travelled, travelled()
        super().__init__(server, goal)

    def _told(self, feedback: Any) -> float:
        return float(feedback.distance)

    def _ended(self, outcome: ErrandOutcome, result: Any, message: str) -> WalkReport:
        travelled = self._travelled() - self._travelled_before
        spent = rospy.get_time() - self._started if result is None else float(result.time_spent)
        return WalkReport(_WALKS.get(outcome, WalkOutcome.FAILED), travelled, spent, message)

    def _notice_silence(self) -> None:
        super()._notice_silence()
        if self._report is not None:
            # The server may answer again later: the robot must not walk on unseen then.
            self.cancel()


class RosExploring(_Errand[float, ExploreReport]):
    """An exploration under way."""

    def _told(self, feedback: Any) -> float:
        return float(feedback.known)

    def _ended(self, outcome: ErrandOutcome, result: Any, message: str) -> ExploreReport:
        if result is None:
            known = math.nan if self._newest is None else self._newest
            lasted = rospy.get_time() - self._started
            return ExploreReport(outcome, message, known, math.nan, lasted)
        if outcome is ErrandOutcome.FAULT:
            outcome = outcome_of(result.outcome)
        done = outcome is ErrandOutcome.COMPLETED
        return exploration_end_of(result, outcome, "" if done else message)


class RosDocking(_Errand[str, DockReport]):
    """A way into or out of the station."""

    def _told(self, feedback: Any) -> str:
        return str(feedback.state)

    def _ended(self, outcome: ErrandOutcome, result: Any, message: str) -> DockReport:
        text = message if result is None else result.message
        if not text and outcome is not ErrandOutcome.COMPLETED:
            text = message
        return DockReport(outcome, text)
