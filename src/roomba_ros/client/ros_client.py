"""The robot as its user interfaces see it, over ROS:
:class:`roomba.client.protocol.RobotClient`."""

from __future__ import annotations

import math
import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlan
from numpy.typing import NDArray
from roomba_robot.msg import (
    Localization,
    PositionAndDestination,
    RobotPosition,
    WalkToPointAction,
    WalkToPointGoal,
)
from roomba_robot.srv import TurnCamera
from std_msgs.msg import Float32

from roomba.client.protocol import (
    Limits,
    RequestRefusedError,
    RobotState,
    RobotUnavailableError,
    WalkHandle,
)
from roomba.geometry import Pose
from roomba_ros.client.ros_clean import RosVacuum
from roomba_ros.client.ros_errands import RosWalk, Server
from roomba_ros.convert.client import doubt_of
from roomba_ros.convert.common import path_of, picture_of, pose_in_map, pose_message
from roomba_ros.convert.readings import point_of
from roomba_ros.convert.values import number_of
from roomba_ros.runtime.calls import call_service
from roomba_ros.runtime.parameters import LiveSeedParameters
from roomba_ros.runtime.subscriptions import subscribe

OLDEST_NEWS = 3.0
"""s of wall time; the robot tells its state at least 5 times a second, older news is none."""
_REST_WITHIN = 1.0
"""s of wall time after the first position; the speed and dirt are not waited for any longer."""


class RosRobot(RosVacuum):
    """The robot in this node's namespace: a :class:`RosVacuum` that also walks."""

    def __init__(self) -> None:
        """Connect nothing yet."""
        super().__init__()
        self._news = threading.Condition()
        self._values: dict[str, tuple[float, ...]] = {}
        self._heard: dict[str, float] = {}
        self._doubt = ""
        self._travelled = 0.0
        self._located = math.inf
        """When the first position came."""
        self._station: Pose | None = None

    def start(self) -> None:
        """Connect; raises RoombaError for wrong parameters."""
        self._parameters = LiveSeedParameters()
        super().start()
        self._walks = Server("walk_to_point", WalkToPointAction)
        self._make_plan = rospy.ServiceProxy("make_plan", GetPlan)
        subscribe("dirt", Float32, number_of, self._on_dirt)
        subscribe("speed", Float32, number_of, self._on_speed)
        subscribe("position", RobotPosition, point_of, self._on_position)
        subscribe("localization", Localization, doubt_of, self._on_localization)
        subscribe("station_pose", PoseStamped, pose_in_map, self._on_station)

    def limits(self) -> Limits:
        """Return the limits in force."""
        values = self._parameters.refresh()
        return Limits(values.min_cordinate, values.max_cordinate, values.robot_max_speed)

    def station(self) -> tuple[float, float]:
        """Return the charging station; until the robot told where that is, where it started."""
        with self._news:
            station = self._station
        if station is not None:
            return station.x, station.y
        values = self._parameters.refresh()
        return values.initial_post_x, values.initial_post_y

    def state(self, timeout: float = 5.0) -> RobotState:
        """Return the newest state; waits up to ``timeout`` s of wall time for what is not new.

        Speed and dirt are NaN for a robot that does not tell them.
        """
        with self._news:
            self._news.wait_for(self._is_told, timeout)
            if not self._is_new("position"):
                raise RobotUnavailableError(
                    f"nothing came on position within {timeout:g} s; "
                    "is the robot running (`./roomba run`)?"
                )
            x, y = self._values["position"]
            return RobotState(x, y, self._newest("speed"), self._newest("dirt"), self._doubt)

    def path_length(self, x: float, y: float) -> float:
        """Return the length of the planned way, m."""
        goal = pose_message(rospy.get_time(), Pose(x, y), "map")
        points = path_of(call_service(self._make_plan, PoseStamped(), goal, 0.0).plan)
        if len(points) == 0:
            raise RequestRefusedError(f"there is no way to ({x:.2f}, {y:.2f})")
        return float(np.hypot(*np.diff(points, axis=0).T).sum())

    def walk_to(self, x: float, y: float) -> WalkHandle:
        """Send the goal; raises RobotUnavailableError when no action server answers in time."""
        with self._news:
            here = self._values.get("position", (0.0, 0.0))
        goal = WalkToPointGoal(PositionAndDestination(*here, x, y))
        return RosWalk(self._walks, goal, lambda: self.travelled)

    @property
    def travelled(self) -> float:
        """How far the robot has moved since this client started, m."""
        with self._news:
            return self._travelled

    def _is_told(self) -> bool:
        """Whether position, speed and dirt are new, or speed and dirt were waited for enough."""
        if not self._is_new("position"):
            return False
        is_over = time.monotonic() - self._located > _REST_WITHIN
        return is_over or (self._is_new("speed") and self._is_new("dirt"))

    def _is_new(self, topic: str) -> bool:
        return time.monotonic() - self._heard.get(topic, -math.inf) <= OLDEST_NEWS

    def _newest(self, topic: str) -> float:
        """Return the number that a topic told; NaN if none is new."""
        return self._values[topic][0] if self._is_new(topic) else math.nan

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
            self._located = min(self._located, time.monotonic())
            self._travelled += math.dist(self._values.get("position", point), point)
        self._hear("position", *point)

    def _on_localization(self, doubt: str) -> None:
        with self._news:
            self._doubt = doubt

    def _on_station(self, pose: Pose) -> None:
        with self._news:
            self._station = pose


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
