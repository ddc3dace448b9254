"""The action server that walks: goals in, a moving setpoint out."""

from __future__ import annotations

import math
import threading
import time
import uuid
from collections import deque
from dataclasses import dataclass

import rospy
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseActionGoal
from move_base_msgs.msg import MoveBaseGoal as MoveBaseGoalMessage
from nav_msgs.msg import OccupancyGrid, Path
from nav_msgs.srv import GetPlan, GetPlanRequest, GetPlanResponse
from roomba_robot.msg import RobotPosition
from std_msgs.msg import Float32, String

from roomba.errors import RoombaError
from roomba.geometry import Pose, wrap_angle
from roomba.grid import OccupancyMap
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk, WalkState, expected_duration
from roomba.perception.matching.surface_field import SurfaceField
from roomba.planning.path.planner import PathPlanner
from roomba.robot.lookout import Lookout
from roomba.vocabulary import OVERTAKEN
from roomba_ros.convert.common import header, map_of, path_message, pose_in_map
from roomba_ros.convert.values import data_of
from roomba_ros.runtime.action_goal import GoalIdentity, server_of
from roomba_ros.runtime.alone import refuse_second
from roomba_ros.runtime.node import require_master, run_node
from roomba_ros.runtime.parameters import (
    LiveSeedParameters,
    read_mission_config,
    read_nodes_config,
    read_robot_config,
    read_thing_config,
)
from roomba_ros.runtime.senders import SPEED_NODE, OnlyFrom
from roomba_ros.runtime.subscriptions import subscribe
from roomba_ros.senses.senses import HeardSenses
from roomba_ros.walking.walk_goals import MoveBaseGoal, WalkGoal, WalkToPointGoal, checked_goal

NAME = "walk_to_point_action_server_node"
_HEARD = ("odom", "imu", "scan", "bumper", "cliff")


@dataclass
class _Job:
    """A goal being walked."""

    goal: WalkGoal
    walk: Walk
    feedback_period: float
    feedback_due: float
    setpoint: tuple[float, float] | None = None
    """The newest one that was told, m; None before the first."""
    turned_by: float | None = None
    """When it has turned at the goal at the latest; None before it is there."""
    rest_by: float | None = None
    """When a cancelled walk stands at the latest; None while it is wanted."""
    free_at: float | None = None
    """When a cancelled walk leaves the drive to others; None before it stands."""


class WalkToPointActionServer:
    """Walks to one goal at a time; a newer goal, of either action, takes over without a halt.

    It takes goals as soon as it knows the map and where the robot is. It remembers what the lidar
    sees besides the map, and walks around that. ``move_base`` is the same walk by the name that
    RViz's 2D Nav Goal and other programs know; there the robot also turns to the heading that was
    asked for.

    Publishes: ``change_position`` (RobotPosition, 20 Hz) and ``change_speed`` (Float32, m/s, at a
    change and 5 Hz) while it walks, ``change_heading`` (Float32, rad, 20 Hz while it turns at the
    end), ``plan`` (Path, latched), ``walk_to_point/{feedback,result,status}``,
    ``move_base/{goal,feedback,result,status}``.
    Subscribes: ``map``, ``walk_to_point/{goal,cancel}``, ``move_base/{goal,cancel}``,
    ``move_base_simple/goal`` (PoseStamped: becomes a goal of ``move_base``), ``emergency_stop``
    (String: while it says a reason no goal is taken, and one under way is given up), and what
    :class:`HeardSenses` hears, of the body ``odom``, ``imu``, ``scan``, ``bumper`` and ``cliff``.
    Services: ``make_plan`` (GetPlan: the path to a point, without walking it).
    Parameters: ``robot_max_speed``, ``min_cordinate``, ``max_cordinate``, ``robot_config``,
    ``nodes_config``, ``mission_config``, ``things_config`` (obstacles are noticed and remembered
    as on a clean).
    """

    period: float

    def start(self) -> None:
        """Read parameters and connect."""
        self._parameters = LiveSeedParameters()
        self._config, self._nodes = read_robot_config(), read_nodes_config()
        self.period = self._config.timing.tick
        self._lookout = Lookout(self._config, read_thing_config())
        things = self._lookout.look_beside(SurfaceField.unknown())
        driving = read_mission_config(self._config).driving
        self._obstacles = Obstacles(things, self._config.walk, self._config.body, driving)
        # Plans are made by ticks and by make_plan, and the planner works on one at a time.
        self._planning = threading.Lock()
        self._planner: PathPlanner | None = None
        self._newer_map: tuple[PathPlanner, SurfaceField] | None = None
        self._senses = HeardSenses(self._config, self._nodes.hearing, *_HEARD)
        self._goals: deque[WalkGoal] = deque()
        self._cancels: deque[GoalIdentity] = deque()
        self._job: _Job | None = None
        self._held = ""
        self._cruise_speed, self._speed_ticks = math.nan, 0
        self._change_position = rospy.Publisher(
            "change_position", RobotPosition, queue_size=1, tcp_nodelay=True
        )
        self._change_speed = rospy.Publisher(
            "change_speed", Float32, queue_size=1, tcp_nodelay=True
        )
        self._change_heading = rospy.Publisher(
            "change_heading", Float32, queue_size=1, tcp_nodelay=True
        )
        self._plan = rospy.Publisher("plan", Path, queue_size=1, latch=True)
        subscribe("map", OccupancyGrid, map_of, self._on_map)
        drive = OnlyFrom(SPEED_NODE)
        subscribe("emergency_stop", String, data_of, self._on_hold, queue_size=10, senders=drive)
        self._senses.start()
        rospy.Service("make_plan", GetPlan, self._on_make_plan)
        self._servers = [
            server_of(kind, self._goals.append, self._cancels.append)
            for kind in (WalkToPointGoal, MoveBaseGoal)
        ]
        self._simple_goals = rospy.Publisher("move_base/goal", MoveBaseActionGoal, queue_size=5)
        subscribe(
            "move_base_simple/goal", PoseStamped, checked_goal, self._on_simple_goal, queue_size=5
        )
        self._serves = False
        self._serves_by = time.monotonic() + self._nodes.deadlines.senses

    def tick(self, now: float) -> None:
        """Look around, take new goals, obey cancels, and walk on."""
        self._parameters.refresh()
        self._use_newer_map()
        senses = self._sense(now)
        self._serve_when_ready(senses)
        self._take_goals(senses)
        self._obey_cancels()
        self._obey_emergency_stop()
        if self._job is not None and senses is not None:
            self._walk_on(self._job, senses)

    def stop(self) -> None:
        """End the goal under way; the robot stops because its setpoint's sender is gone."""
        self._give_up("the action server was told to end")

    def _give_up(self, reason: str) -> None:
        """End the goal under way at once, if there is one."""
        job, self._job = self._job, None
        if job is not None:
            self._change_speed.publish(self._parameters.values.robot_max_speed)
            job.goal.given_up(job.walk.time_spent(rospy.get_time()), reason)

    def _use_newer_map(self) -> None:
        """Plan on the newest map; a walk under way goes on by the one that it was planned on."""
        if self._job is not None and not self._goals:
            return
        with self._planning:
            newer, self._newer_map = self._newer_map, None
            if newer is not None:
                self._planner, field = newer
                self._obstacles.use(self._lookout.look_beside(field), Pose())

    def _sense(self, now: float) -> Senses | None:
        """Return what is sensed, and look for what the map does not show; None without a map."""
        senses = self._senses.at(now)
        with self._planning:
            self._senses.show(self._lookout)
        return None if self._planner is None else senses

    def _serve_when_ready(self, senses: Senses | None) -> None:
        knows = senses is not None and senses.knowledge.is_usable
        ready = knows or time.monotonic() > self._serves_by
        if ready and not self._serves:
            self._serves = True
            # A server that ended in the middle of a walk may have left any cruise speed.
            self._change_speed.publish(self._parameters.values.robot_max_speed)
            for server in self._servers:
                server.start()

    def _take_goals(self, senses: Senses | None) -> None:
        """Begin the newest goal that can be walked; of many at once the older are not planned."""
        has_newer = False
        for goal in reversed([self._goals.popleft() for _ in range(len(self._goals))]):
            if goal.is_recalled or has_newer:
                goal.cancelled(0.0, OVERTAKEN if has_newer else "cancelled before it began")
                continue
            try:
                walk = self._begin(goal.destination, senses)
            except (RoombaError, ValueError) as error:
                rospy.logwarn("goal rejected: %s", error)
                goal.reject(str(error))
                continue
            has_newer = True
            self._replace_job(goal, walk)

    def _begin(self, goal: tuple[float, float], senses: Senses | None) -> Walk:
        self._require_allowed(*goal)
        if self._held:
            raise RoombaError(
                f"the emergency stop holds the drive ({self._held}); release it first"
            )
        if senses is None or self._planner is None:
            raise RoombaError(
                "the robot does not know its map and position yet; is home_sim_node running?"
            )
        if not senses.knowledge.is_usable:
            raise RoombaError(f"the robot does not know where it is: {senses.trouble}")
        with self._planning:
            return Walk(self._planner, self._config.walk, self._obstacles, goal, senses)

    def _require_allowed(self, x: float, y: float) -> None:
        limits = self._parameters.values
        if not (math.isfinite(x) and math.isfinite(y)):
            raise RoombaError(f"expected a destination of finite numbers, got ({x}, {y})")
        if not limits.allows(x, y):
            raise RoombaError(
                f"({x:.2f}, {y:.2f}) is outside the limits: expected x and y from "
                f"{limits.min_cordinate:g} to {limits.max_cordinate:g} m"
            )

    def _replace_job(self, goal: WalkGoal, walk: Walk) -> None:
        now = rospy.get_time()
        old, self._job = self._job, None
        if old is not None:
            old.goal.cancelled(old.walk.time_spent(now), OVERTAKEN)
        duration = expected_duration(walk.path, self._parameters.values.robot_max_speed)
        goal.accept(f"{walk.path.length:.2f} m to walk")
        self._job = _Job(goal, walk, goal.feedback_period(duration), now)
        self._cruise_speed = math.nan
        self._show_plan(now, walk)

    def _obey_cancels(self) -> None:
        while self._cancels:
            cancelled = self._cancels.popleft()
            job = self._job
            if job is not None and job.goal.identity == cancelled:
                job.rest_by = rospy.get_time() + self._nodes.walk_end.longest_braking

    def _obey_emergency_stop(self) -> None:
        """Give the walk under way up: releasing the stop is no order to drive on."""
        if reason := self._held:
            self._give_up(f"the emergency stop holds the drive: {reason}")

    def _walk_on(self, job: _Job, senses: Senses) -> None:
        if job.rest_by is not None:
            self._come_to_rest(job, senses, job.rest_by)
            return
        if job.turned_by is not None:
            self._turn(job, senses, job.turned_by)
            return
        path = job.walk.path
        max_speed = self._parameters.values.robot_max_speed
        with self._planning:
            step = job.walk.tick(senses, max_speed)
        if job.walk.path is not path:
            rospy.loginfo("a new way: %.2f m to walk", job.walk.path.length)
            self._show_plan(senses.now, job.walk)
        self._tell_cruise_speed(step.cruise_speed)
        # While its place is not known the setpoint moves nothing, but tells that the walk goes on.
        job.setpoint = step.setpoint
        self._change_position.publish(RobotPosition(*step.setpoint))
        if step.state is WalkState.ASTRAY:
            return
        if step.state is WalkState.WALKING:
            self._tell_feedback(job, senses, step.distance_left)
            return
        if step.state is WalkState.ARRIVED and job.goal.heading is not None:
            job.turned_by = senses.now + self._nodes.walk_end.longest_turn
            return
        self._job = None
        time_spent = job.walk.time_spent(senses.now)
        if step.state is WalkState.ARRIVED:
            job.goal.arrived(time_spent, "arrived")
        else:
            rospy.logwarn("walk given up: %s", step.reason)
            job.goal.given_up(time_spent, step.reason)

    def _tell_cruise_speed(self, speed: float) -> None:
        """Tell the cruise speed at a change, and now and then: its hearers go by the last one."""
        self._speed_ticks += 1
        is_due = self._speed_ticks >= self._nodes.periods.cruise_speed_ticks
        if speed != self._cruise_speed or is_due:
            self._cruise_speed, self._speed_ticks = speed, 0
            self._change_speed.publish(speed)

    def _turn(self, job: _Job, senses: Senses, turned_by: float) -> None:
        """Turn on the spot to the heading that the goal wants."""
        wanted = job.goal.heading
        assert wanted is not None
        wrong = wrap_angle(wanted - senses.pose.theta)
        end = self._nodes.walk_end
        is_there = abs(wrong) < end.aimed and abs(senses.twist.angular) < end.not_turning
        if not is_there and senses.now < turned_by:
            self._change_heading.publish(wanted)
            self._tell_feedback(job, senses, 0.0)
            return
        self._job = None
        time_spent = job.walk.time_spent(senses.now)
        if is_there:
            job.goal.arrived(time_spent, "arrived")
        else:
            job.goal.given_up(time_spent, f"it is there, but {wrong:.2f} rad were not turned")

    def _come_to_rest(self, job: _Job, senses: Senses, rest_by: float) -> None:
        """Stop a cancelled walk: speed 0 at once, and when it stands its place is the setpoint.

        Until then the last setpoint is told on: a stream that falls silent counts as lost. The
        speed is freed after its own place arrived: else the robot would drive to the old one.
        """
        end = self._nodes.walk_end
        if job.free_at is None:
            self._change_speed.publish(0.0)
            if job.setpoint is not None:
                self._change_position.publish(RobotPosition(*job.setpoint))
            if abs(senses.twist.linear) <= end.standstill or senses.now >= rest_by:
                job.free_at = senses.now + end.heard_by
            return
        if senses.knowledge.is_usable:
            self._change_position.publish(RobotPosition(senses.pose.x, senses.pose.y))
        # By a clock that was set back it is not waited for.
        if job.free_at - end.heard_by <= senses.now < job.free_at:
            return
        self._change_speed.publish(self._parameters.values.robot_max_speed)
        self._job = None
        job.goal.cancelled(job.walk.time_spent(senses.now), "cancelled")

    def _tell_feedback(self, job: _Job, senses: Senses, distance_left: float) -> None:
        now = senses.now
        if now < job.feedback_due - job.feedback_period:
            job.feedback_due = now
        if now >= job.feedback_due:
            job.feedback_due += job.feedback_period
            job.goal.tell(now, distance_left, senses.pose)

    def _show_plan(self, now: float, walk: Walk) -> None:
        self._plan.publish(path_message(now, walk.path.points, "map"))

    def _on_simple_goal(self, message: PoseStamped) -> None:
        # By its own topic and not directly, so that all subscribers see the goal.
        goal = MoveBaseActionGoal(goal=MoveBaseGoalMessage(message))
        goal.header = header(rospy.get_time(), "")
        goal.goal_id.stamp = goal.header.stamp
        goal.goal_id.id = f"{rospy.get_name()}-simple-{uuid.uuid4().hex}"
        self._simple_goals.publish(goal)

    def _on_make_plan(self, request: GetPlanRequest) -> GetPlanResponse:
        try:
            wanted = pose_in_map(request.goal)
            goal = (wanted.x, wanted.y)
            self._require_allowed(*goal)
            pose = self._senses.pose
            if pose is None or self._planner is None:
                raise RoombaError("the robot does not know its map and position yet")
            if request.start.header.frame_id:
                pose = pose_in_map(request.start)
            now = rospy.get_time()
            with self._planning:
                standing = self._obstacles.standing(now)
                path = self._planner.plan((pose.x, pose.y), goal, standing)
        except (RoombaError, ValueError) as error:
            raise rospy.ServiceException(str(error)) from error
        return GetPlanResponse(path_message(now, path.points, "map"))

    def _on_hold(self, reason: str) -> None:
        self._held = reason

    def _on_map(self, occupancy: OccupancyMap) -> None:
        walk = self._config.walk
        planner = PathPlanner(
            occupancy, self._config.body.radius, walk.clearance, walk.tight_clearance
        )
        field = SurfaceField.of(occupancy)
        with self._planning:
            self._newer_map = planner, field


def main() -> None:
    """Run the node, unless another one serves this robot already."""
    require_master()
    refuse_second(NAME, f"{WalkToPointGoal.name}/status")
    run_node(NAME, WalkToPointActionServer)
