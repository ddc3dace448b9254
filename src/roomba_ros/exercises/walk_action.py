"""Checks the server of walks: one to its end, one that is cancelled, and one after it."""

from __future__ import annotations

import contextlib
import math
import sys
import threading
import time
from pathlib import Path
from typing import Final

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from roomba_robot.msg import (
    PositionAndDestination,
    RobotPosition,
    WalkToPointAction,
    WalkToPointFeedback,
    WalkToPointGoal,
)

from roomba.commands.exercise.verdict import NotYetError, expect, judged
from roomba_ros.exercises.graph import OwnGraph

_SPEED: Final = 0.5
"""m/s of the robot."""
_TICK: Final = 0.05
"""s of the robot."""
_SILENCE: Final = 0.2
"""s after which it stands if no setpoint comes."""
_NEAR: Final = 0.06
"""m from the goal."""
_LONG: Final = 12.0
"""s that a walk of 1 m may take."""
_HEARD: Final = 2.0
"""s in which a node that subscribes at its start must hear the robot's position."""
_OFF_TIME: Final = 0.5
"""s by which time_spent may be off."""
_OFF_DISTANCE: Final = 0.2
"""m by which distance may be off: the robot drives on while it is told."""
_LEAST: Final = 3
"""Feedback messages that a walk of 2 s must send at least."""
_CANCELLED: Final = 1.0
"""s in which a walk that is cancelled is to be over; half a second is asked for."""
_NAMES: Final = {
    getattr(GoalStatus, name): name
    for name in ("PENDING", "ACTIVE", "PREEMPTED", "SUCCEEDED", "ABORTED", "REJECTED", "LOST")
}


class ToyRobot:
    """A point that drives straight to its setpoint while setpoints come, and tells where it is."""

    def __init__(self) -> None:
        """Stand at (0, 0); setpoints are obeyed from now on."""
        self.place = (0.0, 0.0)
        self._setpoint: tuple[float, float, float] | None = None
        self._told = rospy.Publisher("position", RobotPosition, queue_size=1)
        rospy.Subscriber("change_position", RobotPosition, self._on_setpoint, queue_size=1)
        threading.Thread(target=self._live, daemon=True).start()

    def is_heard(self) -> bool:
        """Return whether a node listens where the robot is."""
        return bool(self._told.get_num_connections() > 0)

    def away_from(self, x: float, y: float) -> float:
        """Return how far it is from a place, m."""
        return math.hypot(self.place[0] - x, self.place[1] - y)

    def _on_setpoint(self, wish: RobotPosition) -> None:
        self._setpoint = (wish.pos_x, wish.pos_y, time.monotonic())

    def _live(self) -> None:
        while not rospy.is_shutdown():
            setpoint = self._setpoint
            if setpoint is not None and time.monotonic() - setpoint[2] < _SILENCE:
                right, up = setpoint[0] - self.place[0], setpoint[1] - self.place[1]
                share = min(1.0, _SPEED * _TICK / max(math.hypot(right, up), 1e-9))
                self.place = (self.place[0] + share * right, self.place[1] + share * up)
            # The check may end meanwhile.
            with contextlib.suppress(rospy.ROSException):
                self._told.publish(*self.place)
            time.sleep(_TICK)


class Walks:
    """The client: sends goals, and keeps the feedback and result of the newest one."""

    def __init__(self, graph: OwnGraph, robot: ToyRobot) -> None:
        """Connect; ``robot`` tells the true distance that is left."""
        self._graph, self._robot = graph, robot
        self._client = actionlib.SimpleActionClient("walk_to_point", WalkToPointAction)
        graph.wait_for(self._has_server, 10.0, "an action walk_to_point")

    def send(self, x: float, y: float) -> None:
        """Begin a walk to (x, y)."""
        told: list[tuple[float, float]] = []

        def hear(feedback: WalkToPointFeedback) -> None:
            told.append((feedback.distance, self._robot.away_from(x, y)))

        self.told, self._goal, self._began = told, (x, y), time.monotonic()
        goal = WalkToPointGoal(PositionAndDestination(dest_x=x, dest_y=y))
        self._client.send_goal(goal, feedback_cb=hear)

    def cancel(self) -> None:
        """Cancel the walk."""
        self._client.cancel_goal()

    def arrives(self, what: str) -> float:
        """Return the s that the walk took; raises NotYetError if it does not come to its goal."""
        self.ends(GoalStatus.SUCCEEDED, _LONG, what)
        took = time.monotonic() - self._began
        x, y = self._goal
        off = self._robot.away_from(x, y)
        expect(
            off <= _NEAR, f"the robot is {off:.2f} m from ({x:.1f}, {y:.1f}), where it was to go"
        )
        expect_time(what, took, self._client.get_result().time_spent)
        return took

    def ends(self, status: int, seconds: float, what: str) -> None:
        """Raise NotYetError unless the walk ends in time with this status."""
        self._graph.wait_for(self._is_over, seconds, f"{what} to end")
        came = self._client.get_state()
        why = self._client.get_goal_status_text() or "without a reason"
        expect(came == status, f"{what}: expected {_NAMES[status]}, got {_NAMES[came]}: {why}")

    def _has_server(self) -> bool:
        return bool(self._client.wait_for_server(rospy.Duration(0.01)))

    def _is_over(self) -> bool:
        return self._client.get_state() not in (GoalStatus.PENDING, GoalStatus.ACTIVE)


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    with OwnGraph() as graph:
        robot = ToyRobot()
        graph.run_answer(file, "walk_to_point_action_server_node")
        walk = Walks(graph, robot)
        # A goal comes when the robot was heard. A server may also listen from its goal on.
        with contextlib.suppress(NotYetError):
            graph.wait_for(robot.is_heard, _HEARD, "your node to hear position")
        time.sleep(_SILENCE)
        walk.send(0.8, 0.6)
        took = walk.arrives("a walk of 1 m")
        expect_distances(walk.told)
        walk.send(5.0, 0.6)
        graph.wait_for(lambda: robot.place[0] > 1.1, 5.0, "the robot on its way to (5, 0.6)")
        walk.cancel()
        walk.ends(GoalStatus.PREEMPTED, _CANCELLED, "a walk that was cancelled")
        time.sleep(2.0 * _SILENCE)
        stood = robot.place
        time.sleep(2.0 * _SILENCE)
        expect(robot.place == stood, "the robot drove on after the walk was cancelled")
        walk.send(stood[0], 0.2)
        walk.arrives("a walk after one that was cancelled")
    return f"1 m in {took:.1f} s, a cancel that is obeyed, and a walk after it"


def expect_time(what: str, took: float, told: float) -> None:
    """Raise NotYetError unless a walk took the s that its result told."""
    expect(abs(told - took) <= _OFF_TIME, f"{what} took {took:.1f} s, time_spent is {told:.2f}")


def expect_distances(told: list[tuple[float, float]]) -> None:
    """Raise NotYetError unless feedback came, and told what was left: pairs of both, m."""
    expect(len(told) >= _LEAST, f"expected feedback twice a second, got {len(told)}")
    distance, left = max(told, key=lambda pair: abs(pair[0] - pair[1]))
    off = abs(distance - left)
    expect(off <= _OFF_DISTANCE, f"{left:.2f} m were left, distance told {distance:.2f}")


if __name__ == "__main__":
    sys.exit(judged(check))
