"""The robot as its user interfaces see it, over ROS:
:class:`roomba.client.protocol.RobotClient`."""

from __future__ import annotations

import math
import queue
import threading
import time

import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlan
from numpy.typing import NDArray
from roomba_robot.msg import (
    Localization,
    PositionAndDestination,
    RobotPosition,
    WalkToPointAction,
    WalkToPointFeedback,
    WalkToPointGoal,
    WalkToPointResult,
)
from roomba_robot.srv import TurnCamera
from std_msgs.msg import Float32

from roomba.client.protocol import (
    Limits,
    RequestRefusedError,
    RobotState,
    RobotUnavailableError,
    WalkHandle,
    WalkOutcome,
    WalkReport,
)
from roomba.geometry import Pose
from roomba_ros.client.ros_clean import RosVacuum
from roomba_ros.client.ros_errands import SILENCE_DEADLINE, wait_for_server
from roomba_ros.convert.client import doubt_of
from roomba_ros.convert.common import path_of, picture_of, pose_message
from roomba_ros.convert.readings import point_of
from roomba_ros.convert.values import number_of, unchanged
from roomba_ros.runtime.action_client import ActionClient
from roomba_ros.runtime.calls import SERVER_DEADLINE, call_service
from roomba_ros.runtime.parameters import LiveSeedParameters
from roomba_ros.runtime.subscriptions import subscribe

OLDEST_NEWS = 3.0
"""s of wall time; the robot tells its state at least 5 times a second, older news is none."""

_OUTCOMES = {
    GoalStatus.SUCCEEDED: WalkOutcome.ARRIVED,
    GoalStatus.PREEMPTED: WalkOutcome.CANCELLED,
    GoalStatus.RECALLED: WalkOutcome.CANCELLED,
    GoalStatus.REJECTED: WalkOutcome.REFUSED,
    GoalStatus.ABORTED: WalkOutcome.FAILED,
    GoalStatus.LOST: WalkOutcome.DISCONNECTED,
}


class RosRobot(RosVacuum):
    """A robot in this node's namespace, and what :class:`RosVacuum` is.

    Subscribes: ``dirt``, ``position``, ``localization``, ``speed``,
    ``walk_to_point/{feedback,result,status}``.
    Publishes: ``walk_to_point/{goal,cancel}``. Calls: ``make_plan``.
    """

    def __init__(self) -> None:
        """Connect nothing yet."""
        super().__init__()
        self._news = threading.Condition()
        self._values: dict[str, tuple[float, ...]] = {}
        self._heard: dict[str, float] = {}
        self._doubt = ""
        self._travelled = 0.0
        self._status_seen = time.monotonic()

    def start(self) -> None:
        """Connect; raises RoombaError for wrong parameters."""
        self._parameters = LiveSeedParameters()
        super().start()
        self._actions = ActionClient("walk_to_point", WalkToPointAction)
        self._make_plan = rospy.ServiceProxy("make_plan", GetPlan)
        subscribe("dirt", Float32, number_of, self._on_dirt)
        subscribe("speed", Float32, number_of, self._on_speed)
        subscribe("position", RobotPosition, point_of, self._on_position)
        subscribe("localization", Localization, doubt_of, self._on_localization)
        subscribe("walk_to_point/status", GoalStatusArray, unchanged, self._on_status)

    def limits(self) -> Limits:
        """Return the limits in force."""
        values = self._parameters.refresh()
        return Limits(values.min_cordinate, values.max_cordinate, values.robot_max_speed)

    def station(self) -> tuple[float, float]:
        """Return the charging station: where the robot started."""
        values = self._parameters.refresh()
        return values.initial_post_x, values.initial_post_y

    def state(self, timeout: float = 5.0) -> RobotState:
        """Return the newest state; waits up to ``timeout`` s of wall time for what is not new."""
        with self._news:
            if not self._news.wait_for(lambda: not self._not_heard(), timeout):
                raise RobotUnavailableError(
                    f"nothing came on {', '.join(self._not_heard())} within {timeout:g} s; "
                    "is the robot running (`./roomba run`)?"
                )
            x, y = self._values["position"]
            (speed,), (dirt,) = self._values["speed"], self._values["dirt"]
            return RobotState(x, y, speed, dirt, self._doubt)

    def path_length(self, x: float, y: float) -> float:
        """Return the length of the planned way, m."""
        goal = pose_message(rospy.get_time(), Pose(x, y), "map")
        points = path_of(call_service(self._make_plan, PoseStamped(), goal, 0.0).plan)
        if len(points) == 0:
            raise RequestRefusedError(f"there is no way to ({x:.2f}, {y:.2f})")
        return float(np.hypot(*np.diff(points, axis=0).T).sum())

    def walk_to(self, x: float, y: float) -> WalkHandle:
        """Send the goal; raises RobotUnavailableError when no action server answers in time."""
        if not wait_for_server(self._actions.action_client, SERVER_DEADLINE):
            raise RobotUnavailableError(
                f"no action server answers on walk_to_point within {SERVER_DEADLINE:g} s; "
                "is the robot running (`./roomba run`)?"
            )
        with self._news:
            here = self._values.get("position", (0.0, 0.0))
        return _RosWalk(self, self._actions, PositionAndDestination(*here, x, y))

    @property
    def travelled(self) -> float:
        """How far the robot has moved since this client started, m."""
        with self._news:
            return self._travelled

    @property
    def server_silent(self) -> bool:
        """Whether the action server has not told its status for too long."""
        return time.monotonic() - self._status_seen > SILENCE_DEADLINE

    def heard_server(self) -> None:
        """Begin to wait for the server's status anew."""
        self._status_seen = time.monotonic()

    def _not_heard(self) -> list[str]:
        oldest = time.monotonic() - OLDEST_NEWS
        topics = ("dirt", "position", "speed")
        return [topic for topic in topics if self._heard.get(topic, -math.inf) < oldest]

    def _hear(self, topic: str, *values: float) -> None:
        with self._news:
            self._values[topic] = values
            self._heard[topic] = time.monotonic()
            self._news.notify_all()

    def _on_dirt(self, dirt: float) -> None:
        self._hear("dirt", dirt)

    def _on_speed(self, speed: float) -> None:
        self._hear("speed", speed)

    def _on_position(self, point: tuple[float, float]) -> None:
        with self._news:
            self._travelled += math.dist(self._values.get("position", point), point)
        self._hear("position", *point)

    def _on_localization(self, doubt: str) -> None:
        with self._news:
            self._doubt = doubt

    def _on_status(self, message: GoalStatusArray) -> None:
        self._status_seen = time.monotonic()


class _RosWalk:
    """A goal under way; feedback and end arrive through a queue."""

    def __init__(
        self,
        robot: RosRobot,
        actions: ActionClient,
        destination: PositionAndDestination,
    ) -> None:
        self._robot = robot
        self._actions = actions
        self._feedback: queue.SimpleQueue[float] = queue.SimpleQueue()
        self._ended = threading.Event()
        self._report: WalkReport | None = None
        self._travelled_before = robot.travelled
        self._started = rospy.get_time()
        robot.heard_server()
        actions.send_goal(
            WalkToPointGoal(destination), done_cb=self._on_done, feedback_cb=self._on_feedback
        )

    def next_feedback(self, timeout: float) -> float | None:
        deadline = time.monotonic() + timeout
        while self.report() is None:
            left = deadline - time.monotonic()
            if left <= 0.0:
                return None
            try:
                return self._feedback.get(timeout=min(left, 0.1))
            except queue.Empty:
                continue
        return None

    def report(self) -> WalkReport | None:
        if not self._ended.is_set() and self._robot.server_silent:
            # Should it wake up, it must not walk on unseen.
            self._actions.cancel_goal()
            self._end(
                WalkOutcome.DISCONNECTED,
                rospy.get_time() - self._started,
                f"the action server has been silent for {SILENCE_DEADLINE:g} s",
            )
        return self._report if self._ended.is_set() else None

    def cancel(self) -> None:
        self._actions.cancel_goal()

    def _on_feedback(self, message: WalkToPointFeedback) -> None:
        self._feedback.put(message.distance)

    def _on_done(self, status: int, result: WalkToPointResult | None) -> None:
        spent = result.time_spent if result is not None else rospy.get_time() - self._started
        text = self._actions.get_goal_status_text()
        self._end(_OUTCOMES.get(status, WalkOutcome.FAILED), spent, text)

    def _end(self, outcome: WalkOutcome, duration: float, message: str) -> None:
        if self._ended.is_set():
            return
        travelled = self._robot.travelled - self._travelled_before
        self._report = WalkReport(outcome, travelled, duration, message)
        self._ended.set()


class RosCamera:
    """The camera service of a robot in this node's namespace; calls ``turn_camera``."""

    def __init__(self) -> None:
        """Connect nothing yet."""
        self._turn_camera = rospy.ServiceProxy("turn_camera", TurnCamera)

    def picture(self, degrees: float) -> NDArray[np.uint8]:
        """Return the picture nearest to an angle."""
        try:
            return picture_of(call_service(self._turn_camera, degrees).image)
        except ValueError as error:
            raise RequestRefusedError(f"turn_camera answered with no picture: {error}") from error
