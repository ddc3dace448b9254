"""The action server that walks: goals in, a moving setpoint out."""

from __future__ import annotations

import time
import uuid
from collections import deque

import rospy
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseActionGoal
from move_base_msgs.msg import MoveBaseGoal as MoveBaseGoalMessage

from roomba.errors import RoombaError
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk
from roomba.vocabulary import OVERTAKEN
from roomba_ros.convert.common import header
from roomba_ros.runtime.action_goal import GoalIdentity, server_of
from roomba_ros.runtime.graph.alone import refuse_second
from roomba_ros.runtime.held_drive import HeldDrive
from roomba_ros.runtime.node import require_master, run_node
from roomba_ros.runtime.parameters import (
    LiveSeedParameters,
    read_nodes_config,
    read_robot_config,
)
from roomba_ros.runtime.subscriptions import subscribe
from roomba_ros.senses.senses import HeardSenses
from roomba_ros.walking.plan_service import PlanService
from roomba_ros.walking.walk_goals import MoveBaseGoal, WalkGoal, WalkToPointGoal, checked_goal
from roomba_ros.walking.walk_job import WalkJob
from roomba_ros.walking.walk_topics import WalkTopics

NAME = "walk_to_point_action_server_node"
_HEARD = ("odom", "imu", "scan", "bumper", "cliff")


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
        self._senses = HeardSenses(self._config, self._nodes.hearing, *_HEARD)
        self._plans = PlanService(self._config, self._parameters, self._senses)
        self._goals: deque[WalkGoal] = deque()
        self._cancels: deque[GoalIdentity] = deque()
        self._job: WalkJob | None = None
        self._held = HeldDrive()
        self._topics = WalkTopics()
        self._topics.start()
        self._held.start()
        self._senses.start()
        self._plans.start()
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
        if self._job is None or self._goals:
            # A walk under way stays on the map that it was planned on.
            self._plans.use_newer_map()
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
        if job is not None and not job.is_over:
            self._topics.drive_at(self._parameters.values.robot_max_speed)
            job.give_up(rospy.get_time(), reason)

    def _sense(self, now: float) -> Senses | None:
        """Return what is sensed, and look for what the map does not show; None without a map."""
        senses = self._senses.at(now)
        self._plans.look()
        return senses if self._plans.knows_map else None

    def _serve_when_ready(self, senses: Senses | None) -> None:
        knows = senses is not None and senses.knowledge.is_usable
        ready = knows or time.monotonic() > self._serves_by
        if ready and not self._serves:
            self._serves = True
            # A server that ended during a walk may have left any cruise speed.
            self._topics.drive_at(self._parameters.values.robot_max_speed)
            for server in self._servers:
                server.start()

    def _take_goals(self, senses: Senses | None) -> None:
        """Begin the newest goal that can be walked; of many at once the others are not planned."""
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
        self._plans.require_allowed(*goal)
        if held := self._held.reason:
            raise RoombaError(f"the emergency stop holds the drive ({held}); release it first")
        if senses is None:
            raise RoombaError(
                "the robot does not know its map and position yet; is home_sim_node running?"
            )
        if not senses.knowledge.is_usable:
            raise RoombaError(f"the robot does not know where it is: {senses.trouble}")
        return self._plans.walk_to(goal, senses)

    def _replace_job(self, goal: WalkGoal, walk: Walk) -> None:
        now = rospy.get_time()
        old, self._job = self._job, None
        if old is not None:
            old.replaced(now, OVERTAKEN)
        job = WalkJob(goal, walk, self._topics, self._nodes, self._plans.lock)
        job.begin(now, self._parameters.values.robot_max_speed)
        self._job = job

    def _obey_cancels(self) -> None:
        while self._cancels:
            cancelled = self._cancels.popleft()
            job = self._job
            if job is not None and job.goal.identity == cancelled:
                job.cancel(rospy.get_time())

    def _obey_emergency_stop(self) -> None:
        """Give up the walk under way: to release the stop is no order to drive on."""
        if reason := self._held.reason:
            self._give_up(f"the emergency stop holds the drive: {reason}")

    def _walk_on(self, job: WalkJob, senses: Senses) -> None:
        job.tick(senses, self._parameters.values.robot_max_speed)
        if job.is_over:
            self._job = None

    def _on_simple_goal(self, message: PoseStamped) -> None:
        # By its own topic and not by a call, so that all subscribers see the goal.
        goal = MoveBaseActionGoal(goal=MoveBaseGoalMessage(message))
        goal.header = header(rospy.get_time(), "")
        goal.goal_id.stamp = goal.header.stamp
        goal.goal_id.id = f"{rospy.get_name()}-simple-{uuid.uuid4().hex}"
        self._simple_goals.publish(goal)


def main() -> None:
    """Run the node, unless another one serves this robot already."""
    require_master()
    refuse_second(NAME, f"{WalkToPointGoal.name}/status")
    run_node(NAME, WalkToPointActionServer)
