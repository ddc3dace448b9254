"""The action server that walks: goals in, a moving setpoint out."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from dataclasses import dataclass

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from nav_msgs.srv import GetPlan, GetPlanRequest, GetPlanResponse
from roomba_robot.msg import (
    Bumper,
    Cliff,
    Localization,
    RobotPosition,
    WalkToPointAction,
    WalkToPointFeedback,
    WalkToPointResult,
)
from std_msgs.msg import Float32

from roomba.errors import RoombaError
from roomba.geometry import Pose
from roomba.mission.unknown_things import UnknownThings
from roomba.mission.walk import Sensed, Walk, WalkState, expected_duration, feedback_period
from roomba.perception.estimate import Knowledge
from roomba.planning.path import PathPlanner
from roomba_ros.alone import refuse_second
from roomba_ros.convert import cliff_of, map_of, path_message, pose_of, twist_of
from roomba_ros.convert_localization import knowledge_of
from roomba_ros.node import require_master, run_node
from roomba_ros.parameters import LiveSeedParameters, read_robot_config

NAME = "walk_to_point_action_server_node"
ACTION = "walk_to_point"
SENSES_DEADLINE = 6.0
"""s of wall time after which goals are taken, and rejected, though map and pose are not there."""
_STANDSTILL = 0.02
"""m/s; a cancelled walk has ended when the robot is slower than this."""
_LONGEST_BRAKING = 1.0
"""s; a cancelled walk has ended after this, whatever the odometry says."""


@dataclass
class _Job:
    """A goal being walked."""

    handle: actionlib.ServerGoalHandle
    walk: Walk
    feedback_period: float
    feedback_due: float
    rest_by: float | None = None
    """When a cancelled walk has ended at the latest; None while it is wanted."""


class WalkToPointActionServer:
    """Walks to one goal at a time; a newer goal takes over without a halt.

    It takes goals as soon as it knows the map and where the robot is.

    Publishes: ``change_position`` (RobotPosition) and ``change_speed`` (Float32, m/s) at 20 Hz
    while it walks, ``plan`` (Path, latched), ``walk_to_point/{feedback,result,status}``.
    Subscribes: ``pose``, ``localization``, ``odom``, ``bumper``, ``cliff``, ``map``,
    ``walk_to_point/{goal,cancel}``.
    Services: ``make_plan`` (GetPlan: the path to a point, without walking it).
    Parameters: ``robot_max_speed``, ``min_cordinate``, ``max_cordinate``.
    """

    period = 0.05

    def start(self) -> None:
        """Read parameters and connect."""
        self._parameters = LiveSeedParameters()
        self._config = read_robot_config()
        self._things = UnknownThings(self._config.walk, self._config.body)
        # Plans are made by ticks and by make_plan, and the planner works on one at a time.
        self._planning = threading.Lock()
        self._planner: PathPlanner | None = None
        self._pose: Pose | None = None
        self._knowledge, self._trouble = Knowledge.KNOWN, ""
        self._speed = 0.0
        self._bumper = (False, False)
        self._cliff = (False, False)
        self._goals: deque[actionlib.ServerGoalHandle] = deque()
        self._cancels: deque[str] = deque()
        self._job: _Job | None = None
        self._change_position = rospy.Publisher(
            "change_position", RobotPosition, queue_size=1, tcp_nodelay=True
        )
        self._change_speed = rospy.Publisher(
            "change_speed", Float32, queue_size=1, tcp_nodelay=True
        )
        self._plan = rospy.Publisher("plan", Path, queue_size=1, latch=True)
        rospy.Subscriber("map", OccupancyGrid, self._on_map, queue_size=1)
        rospy.Subscriber("localization", Localization, self._on_localization, queue_size=1)
        rospy.Subscriber("pose", PoseStamped, self._on_pose, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber("odom", Odometry, self._on_odometry, queue_size=1)
        rospy.Subscriber("bumper", Bumper, self._on_bumper, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber("cliff", Cliff, self._on_cliff, queue_size=1, tcp_nodelay=True)
        rospy.Service("make_plan", GetPlan, self._on_make_plan)
        self._server = actionlib.ActionServer(
            ACTION, WalkToPointAction, self._goals.append, self._on_cancel, auto_start=False
        )
        self._serves = False
        self._serves_by = time.monotonic() + SENSES_DEADLINE

    def tick(self, now: float) -> None:
        """Take new goals, obey cancels, and walk on."""
        self._parameters.refresh()
        sensed = self._sense(now)
        self._serve_when_ready(sensed)
        self._take_goals(sensed)
        self._obey_cancels()
        if self._job is not None and sensed is not None:
            self._walk_on(self._job, sensed)

    def stop(self) -> None:
        """End the goal under way; the robot stops because its setpoint's sender is gone."""
        job, self._job = self._job, None
        if job is not None:
            self._change_speed.publish(self._parameters.values.robot_max_speed)
            result = WalkToPointResult(job.walk.time_spent(rospy.get_time()))
            job.handle.set_aborted(result, "the action server was told to end")

    def _sense(self, now: float) -> Sensed | None:
        if self._pose is None or self._planner is None:
            return None
        return Sensed(
            now,
            self._pose,
            self._speed,
            *self._bumper,
            *self._cliff,
            self._knowledge,
            self._trouble,
        )

    def _serve_when_ready(self, sensed: Sensed | None) -> None:
        knows = sensed is not None and sensed.knowledge.is_usable
        ready = knows or time.monotonic() > self._serves_by
        if ready and not self._serves:
            self._serves = True
            # A server that ended in the middle of a walk may have left any cruise speed.
            self._change_speed.publish(self._parameters.values.robot_max_speed)
            self._server.start()

    def _take_goals(self, sensed: Sensed | None) -> None:
        while self._goals:
            handle = self._goals.popleft()
            if handle.get_goal_status().status == GoalStatus.RECALLING:
                handle.set_canceled(WalkToPointResult(0.0), "cancelled before it began")
                continue
            try:
                walk = self._begin(handle, sensed)
            except (RoombaError, ValueError) as error:
                rospy.logwarn("goal rejected: %s", error)
                handle.set_rejected(WalkToPointResult(0.0), str(error))
                continue
            self._replace_job(handle, walk)

    def _begin(self, handle: actionlib.ServerGoalHandle, sensed: Sensed | None) -> Walk:
        destination = handle.get_goal().destin
        goal = (destination.dest_x, destination.dest_y)
        self._require_allowed(*goal)
        if sensed is None or self._planner is None:
            raise RoombaError(
                "the robot does not know its map and position yet; is home_sim_node running?"
            )
        if not sensed.knowledge.is_usable:
            raise RoombaError(f"the robot does not know where it is: {sensed.trouble}")
        config = self._config
        with self._planning:
            return Walk(self._planner, config.walk, config.body, self._things, goal, sensed)

    def _require_allowed(self, x: float, y: float) -> None:
        limits = self._parameters.values
        if not (math.isfinite(x) and math.isfinite(y)):
            raise RoombaError(f"expected a destination of finite numbers, got ({x}, {y})")
        if not limits.allows(x, y):
            raise RoombaError(
                f"({x:.2f}, {y:.2f}) is outside the limits: expected x and y from "
                f"{limits.min_cordinate:g} to {limits.max_cordinate:g} m"
            )

    def _replace_job(self, handle: actionlib.ServerGoalHandle, walk: Walk) -> None:
        now = rospy.get_time()
        old, self._job = self._job, None
        if old is not None:
            result = WalkToPointResult(old.walk.time_spent(now))
            old.handle.set_canceled(result, "a newer goal took over")
        duration = expected_duration(walk.path, self._parameters.values.robot_max_speed)
        handle.set_accepted(f"{walk.path.length:.2f} m to walk")
        self._job = _Job(handle, walk, feedback_period(duration), now)
        self._show_plan(now, walk)

    def _obey_cancels(self) -> None:
        while self._cancels:
            cancelled = self._cancels.popleft()
            job = self._job
            if job is not None and job.handle.get_goal_id().id == cancelled:
                job.rest_by = rospy.get_time() + _LONGEST_BRAKING

    def _walk_on(self, job: _Job, sensed: Sensed) -> None:
        if job.rest_by is not None:
            self._come_to_rest(job, sensed, job.rest_by)
            return
        path = job.walk.path
        max_speed = self._parameters.values.robot_max_speed
        with self._planning:
            step = job.walk.tick(sensed, max_speed)
        if job.walk.path is not path:
            rospy.loginfo("a new way: %.2f m to walk", job.walk.path.length)
            self._show_plan(sensed.now, job.walk)
        self._change_speed.publish(step.cruise_speed)
        # While it is astray nobody drives there, but it says that somebody still wants to go.
        self._change_position.publish(RobotPosition(*step.setpoint))
        if step.state is WalkState.ASTRAY:
            return
        if step.state is WalkState.WALKING:
            self._tell_feedback(job, sensed.now, step.distance_left)
            return
        self._job = None
        result = WalkToPointResult(job.walk.time_spent(sensed.now))
        if step.state is WalkState.ARRIVED:
            job.handle.set_succeeded(result, "arrived")
        else:
            rospy.logwarn("walk given up: %s", step.reason)
            job.handle.set_aborted(result, step.reason)

    def _come_to_rest(self, job: _Job, sensed: Sensed, rest_by: float) -> None:
        """Stop a cancelled walk: speed 0 at once, then the place where it stands is the wish."""
        if abs(sensed.speed) > _STANDSTILL and sensed.now < rest_by:
            self._change_speed.publish(0.0)
            return
        if sensed.knowledge.is_usable:
            self._change_position.publish(RobotPosition(sensed.pose.x, sensed.pose.y))
        self._change_speed.publish(self._parameters.values.robot_max_speed)
        self._job = None
        job.handle.set_canceled(WalkToPointResult(job.walk.time_spent(sensed.now)), "cancelled")

    def _tell_feedback(self, job: _Job, now: float, distance_left: float) -> None:
        if now < job.feedback_due - job.feedback_period:
            job.feedback_due = now
        if now >= job.feedback_due:
            job.feedback_due += job.feedback_period
            job.handle.publish_feedback(WalkToPointFeedback(distance_left))

    def _show_plan(self, now: float, walk: Walk) -> None:
        self._plan.publish(path_message(now, walk.path.points, "map"))

    def _on_cancel(self, handle: actionlib.ServerGoalHandle) -> None:
        self._cancels.append(handle.get_goal_id().id)

    def _on_make_plan(self, request: GetPlanRequest) -> GetPlanResponse:
        try:
            wanted = _in_map(request.goal)
            goal = (wanted.x, wanted.y)
            self._require_allowed(*goal)
            pose = self._pose
            if pose is None or self._planner is None:
                raise RoombaError("the robot does not know its map and position yet")
            if request.start.header.frame_id:
                pose = _in_map(request.start)
            now = rospy.get_time()
            with self._planning:
                path = self._planner.plan((pose.x, pose.y), goal, self._things.at(now))
        except (RoombaError, ValueError) as error:
            raise rospy.ServiceException(str(error)) from error
        return GetPlanResponse(path_message(now, path.points, "map"))

    def _on_map(self, message: OccupancyGrid) -> None:
        walk = self._config.walk
        try:
            occupancy = map_of(message)
        except ValueError as error:
            rospy.logwarn("map refused: %s", error)
            return
        self._planner = PathPlanner(
            occupancy, self._config.body.radius, walk.clearance, walk.tight_clearance
        )

    def _on_pose(self, message: PoseStamped) -> None:
        self._pose = pose_of(message)

    def _on_localization(self, message: Localization) -> None:
        self._knowledge, self._trouble = knowledge_of(message), message.message

    def _on_odometry(self, message: Odometry) -> None:
        self._speed = twist_of(message.twist.twist).linear

    def _on_bumper(self, message: Bumper) -> None:
        self._bumper = (message.is_left_pressed, message.is_right_pressed)

    def _on_cliff(self, message: Cliff) -> None:
        self._cliff = cliff_of(message)


def _in_map(message: PoseStamped) -> Pose:
    """Return a pose of the map frame, which no frame stands for, too; raises RoombaError."""
    if message.header.frame_id not in ("", "map"):
        raise RoombaError(
            f"expected a pose in the frame 'map', got one in {message.header.frame_id!r}; "
            "transform it first"
        )
    return pose_of(message)


def main() -> None:
    """Run the node, unless another one serves this robot already."""
    require_master()
    refuse_second(NAME, f"{ACTION}/status")
    run_node(NAME, WalkToPointActionServer)
