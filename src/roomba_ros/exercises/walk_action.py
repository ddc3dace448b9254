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

from roomba.commands.exercise.verdict import expect, judged
from roomba_ros.exercises.graph import OwnGraph, wait_for

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


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    with OwnGraph() as graph:
        robot, feedback = ToyRobot(), list[float]()
        graph.run_answer(file, "walk_to_point_action_server_node")
        walk = actionlib.SimpleActionClient("walk_to_point", WalkToPointAction)
        expect(walk.wait_for_server(rospy.Duration(10.0)), "expected an action walk_to_point")

        def hear(told: WalkToPointFeedback) -> None:
            feedback.append(told.distance)

        def send(x: float, y: float) -> None:
            goal = WalkToPointGoal(PositionAndDestination(dest_x=x, dest_y=y))
            walk.send_goal(goal, feedback_cb=hear)

        send(0.8, 0.6)
        _ends(walk, GoalStatus.SUCCEEDED, _LONG, "a walk of 1 m")
        _stands_at(robot, 0.8, 0.6)
        took = walk.get_result().time_spent
        expect(1.0 < took < _LONG, f"1 m at 0.5 m/s takes 2 s, time_spent is {took:.2f}")
        expect(len(feedback) >= 3, f"expected feedback twice a second, got {len(feedback)}")
        expect(0.5 < feedback[0] < 1.1, f"expected 1 m left at first, got {feedback[0]:.2f}")
        expect(feedback == sorted(feedback, reverse=True), "the distance left grew on the way")
        send(5.0, 0.6)
        wait_for(lambda: robot.place[0] > 1.1, 5.0, "the robot on its way to (5, 0.6)")
        walk.cancel_goal()
        _ends(walk, GoalStatus.PREEMPTED, _CANCELLED, "a walk that was cancelled")
        time.sleep(2.0 * _SILENCE)
        stood = robot.place
        time.sleep(2.0 * _SILENCE)
        expect(robot.place == stood, "the robot drove on after the walk was cancelled")
        send(stood[0], 0.2)
        _ends(walk, GoalStatus.SUCCEEDED, _LONG, "a walk after one that was cancelled")
        _stands_at(robot, stood[0], 0.2)
    return f"1 m in {took:.1f} s, a cancel that is obeyed, and a walk after it"


def _ends(walk: actionlib.SimpleActionClient, status: int, seconds: float, what: str) -> None:
    """Raise NotYetError unless a walk ends in time with this status."""
    wait_for(lambda: _over(walk), seconds, f"{what} to end")
    came = walk.get_state()
    expect(came == status, f"{what}: expected {_NAMES[status]}, got {_NAMES[came]}")


def _over(walk: actionlib.SimpleActionClient) -> bool:
    return walk.get_state() not in (GoalStatus.PENDING, GoalStatus.ACTIVE)


def _stands_at(robot: ToyRobot, x: float, y: float) -> None:
    off = math.hypot(robot.place[0] - x, robot.place[1] - y)
    expect(off <= _NEAR, f"the robot is {off:.2f} m from ({x:.1f}, {y:.1f}), where it was to go")


if __name__ == "__main__":
    sys.exit(judged(check))
