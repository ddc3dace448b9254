"""A client of a robot that lets it clean again and again, and sees whether that goes on."""

from __future__ import annotations

import contextlib

import rospy
from actionlib import SimpleGoalState
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from roomba_robot.msg import CleanAction, CleanGoal, VacuumState
from soak.rows import Row, until
from std_msgs.msg import String
from std_srvs.srv import Trigger

from roomba_ros.runtime.action_client import ActionClient

GOES_ON = 30.0
"""s of wall time within which a clean must make progress."""
ENDED = 600.0
"""s of wall time that a clean takes at most."""
READY = 60.0
"""s of wall time until a robot accepts a clean, and until it cleans."""
_WAITS = ("error", "paused", "bin full")
"""Phases in which it waits for a person."""


class Cleaner:
    """Lets a robot clean, and notes cleans that do not end once, or not as they should."""

    def __init__(self, graph: RosGraph, probe: Probe | None = None) -> None:
        """Become a client of the robot, by a node that is there already or a new one."""
        self.probe = probe or Probe(graph, "soak")
        self.state, self.trouble = VacuumState(), [""]
        self.row = Row("clean")
        self.may_be_told_otherwise = False
        """Whether other clients gave orders: then the clean under way may end otherwise."""
        self._waited = ""
        rospy.Subscriber("/vacuum/state", VacuumState, self._on_state)
        rospy.Subscriber("/trouble", String, lambda told: self.trouble.append(told.data))
        self._client = ActionClient("clean", CleanAction)
        until(lambda: self._client.wait_for_server(rospy.Duration(0.01)), READY)

    def _on_state(self, state: VacuumState) -> None:
        self.state = state

    def keep_cleaning(self) -> None:
        """Begin another clean when the last one has ended, or waits for a person."""
        if self.row.times > 0 and not self.has_ended():
            if self.state.phase not in _WAITS:
                return
            self._stop()
            until(self.has_ended, READY)
        self._judge()
        if until(self._is_ready, ENDED) is not None:
            self.may_be_told_otherwise, self._waited = False, ""
            self._client.send_goal(CleanGoal())
            self.row.times += 1
            if until(lambda: self.state.phase == "cleaning" or self.has_ended(), READY) is None:
                self.row.broken.append(f"clean {self.row.times} does not begin: {self.state.phase}")

    def clean(self) -> None:
        """Wait until it sweeps the floor: on its way home it writes too little to the disk."""
        if self.state.phase != "cleaning":
            self.finish()
        self.keep_cleaning()

    def finish(self) -> None:
        """Let the last clean end; one that waits for a person, or takes too long, is stopped."""
        until(lambda: self.has_ended() or self.state.phase in _WAITS, ENDED)
        if not self.has_ended():
            self._stop()
        if until(self.has_ended, READY) is None:
            self.row.broken.append(f"the last one has not ended: {self.state.phase}")
        else:
            self._judge()

    def has_ended(self) -> bool:
        """Whether the newest clean has ended."""
        return bool(self._client.simple_state == SimpleGoalState.DONE)

    def _is_ready(self) -> bool:
        """Whether it can be told to clean; one that waits for a person is told to stop."""
        if self.state.phase in _WAITS:
            self._stop()
        return self.state.phase in ("docked", "idle")

    def _stop(self) -> None:
        self._waited = f"{self.state.phase}: {self.state.message}"
        with contextlib.suppress(rospy.ServiceException):
            rospy.ServiceProxy("/stop", Trigger)()

    def _judge(self) -> None:
        """Note a clean that did not end as it should."""
        if self.may_be_told_otherwise:
            return
        if self.row.times > 0 and self._client.get_state() != GoalStatus.SUCCEEDED:
            said = self._client.get_goal_status_text()
            status = self._client.get_state()
            why = f"{said}, as it waited for a person: {self._waited}" if self._waited else said
            self.row.broken.append(f"clean {self.row.times}: status {status}, {why}")

    def goes_on(self, row: Row) -> None:
        """Note in a row if the clean makes no progress; one that ends meanwhile made some."""
        if self.state.phase != "cleaning":
            return
        before = self.state.covered

        def went_on() -> bool:
            return bool(self.state.covered > before + 0.01) or self.state.phase != "cleaning"

        if until(went_on, GOES_ON) is None:
            row.broken.append(f"the clean does not go on: {self.state.message}")
        elif self.state.phase == "error":
            row.broken.append(f"error: {self.state.message}")
