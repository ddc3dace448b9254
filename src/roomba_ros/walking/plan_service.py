"""Paths on the newest map, for walks and for the service make_plan."""

from __future__ import annotations

import math
import threading

import rospy
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetPlan, GetPlanRequest, GetPlanResponse

from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk
from roomba.perception.matching.surface_field import SurfaceField
from roomba.planning.path.planner import PathPlanner
from roomba.robot.lookout import Lookout
from roomba_ros.convert.common import map_of, path_message, pose_in_map
from roomba_ros.runtime.parameters import (
    LiveSeedParameters,
    read_mission_config,
    read_thing_config,
)
from roomba_ros.runtime.subscriptions import subscribe
from roomba_ros.senses.senses import HeardSenses


class PlanService:
    """Plans around what the map shows and what the lidar sees besides it.

    Subscribes: ``map``.
    Services: ``make_plan`` (GetPlan: the path to a point, without walking it).
    Parameters: ``mission_config``, ``things_config``.
    """

    def __init__(
        self, config: RobotConfig, parameters: LiveSeedParameters, senses: HeardSenses
    ) -> None:
        """Connect nothing yet."""
        self._config, self._parameters, self._senses = config, parameters, senses
        self._lookout = Lookout(config, read_thing_config())
        things = self._lookout.look_beside(SurfaceField.unknown())
        driving = read_mission_config(config).driving
        self._obstacles = Obstacles(things, config.walk, config.body, driving)
        self.lock = threading.Lock()
        """Held while planning: ticks and make_plan plan on different threads, and the planner is
        one."""
        self._planner: PathPlanner | None = None
        self._newer_map: tuple[PathPlanner, SurfaceField] | None = None

    def start(self) -> None:
        """Connect."""
        subscribe("map", OccupancyGrid, map_of, self._on_map)
        rospy.Service("make_plan", GetPlan, self._on_make_plan)

    @property
    def knows_map(self) -> bool:
        """Whether there is a map to plan on."""
        return self._planner is not None

    def use_newer_map(self) -> None:
        """Plan on the newest map from now on, if one came."""
        with self.lock:
            newer, self._newer_map = self._newer_map, None
            if newer is not None:
                self._planner, field = newer
                self._obstacles.use(self._lookout.look_beside(field), Pose())

    def look(self) -> None:
        """Look in the newest scan for things that the map does not show."""
        with self.lock:
            self._senses.show(self._lookout)

    def walk_to(self, goal: tuple[float, float], senses: Senses) -> Walk:
        """Return a walk to a place, m; raises RoombaError where none leads."""
        if self._planner is None:
            raise RoombaError("the robot does not know its map yet; wait for it")
        with self.lock:
            self._obstacles.begin_errand()
            return Walk(self._planner, self._config.walk, self._obstacles, goal, senses)

    def require_allowed(self, x: float, y: float) -> None:
        """Raise RoombaError for a place, m, to which the limits do not let the robot go."""
        limits = self._parameters.values
        if not (math.isfinite(x) and math.isfinite(y)):
            raise RoombaError(f"expected a destination of finite numbers, got ({x}, {y})")
        if not limits.allows(x, y):
            raise RoombaError(
                f"({x:.2f}, {y:.2f}) is outside the limits: expected x and y from "
                f"{limits.min_cordinate:g} to {limits.max_cordinate:g} m"
            )

    def _on_make_plan(self, request: GetPlanRequest) -> GetPlanResponse:
        try:
            wanted = pose_in_map(request.goal)
            goal = (wanted.x, wanted.y)
            self.require_allowed(*goal)
            pose = self._senses.pose
            if pose is None or self._planner is None:
                raise RoombaError("the robot does not know its map and position yet")
            if request.start.header.frame_id:
                pose = pose_in_map(request.start)
            now = rospy.get_time()
            with self.lock:
                standing = self._obstacles.standing(now)
                path = self._planner.plan((pose.x, pose.y), goal, standing)
        except (RoombaError, ValueError) as error:
            raise rospy.ServiceException(str(error)) from error
        return GetPlanResponse(path_message(now, path.points, "map"))

    def _on_map(self, occupancy: OccupancyMap) -> None:
        walk = self._config.walk
        planner = PathPlanner(
            occupancy, self._config.body.radius, walk.clearance, walk.tight_clearance
        )
        field = SurfaceField.of(occupancy)
        with self.lock:
            self._newer_map = planner, field
