"""Walking to a point: a walk, and the position loop that drives to its setpoint."""

from __future__ import annotations

from roomba.configuration.robot import RobotConfig
from roomba.control.position_loop import PositionLoop
from roomba.errors import RoombaError
from roomba.geometry import STANDSTILL, Twist
from roomba.grid import OccupancyMap
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk, WalkState, WalkStep
from roomba.planning.path.planner import PathPlanner

_UNDER_WAY = (WalkState.WALKING, WalkState.ASTRAY)


class Walking:
    """One walk at a time."""

    def __init__(self, robot: RobotConfig) -> None:
        """Begin standing."""
        self._robot = robot
        self._loop = PositionLoop(robot.control, robot.body)
        self._planner: tuple[OccupancyMap, PathPlanner] | None = None
        self._walk: Walk | None = None
        self._step: WalkStep | None = None
        self.ended: WalkStep | None = None
        """The last step of the newest walk: None while it lasts, or if something else ended it."""

    @property
    def is_under_way(self) -> bool:
        """Whether a walk is to be ticked."""
        return self._walk is not None

    @property
    def newest(self) -> WalkStep:
        """What a walk wanted last; raises RoombaError before the first one."""
        if self._step is None:
            raise RoombaError("expected a walk that was ticked, there was none")
        return self._step

    def begin(
        self,
        goal: tuple[float, float],
        occupancy: OccupancyMap,
        obstacles: Obstacles,
        senses: Senses,
    ) -> Walk:
        """Walk to a point of a map, m; raises NoPathError when there is no way."""
        self._walk = self.planned(goal, occupancy, obstacles, senses)
        self.ended = None
        return self._walk

    def planned(
        self,
        goal: tuple[float, float],
        occupancy: OccupancyMap,
        obstacles: Obstacles,
        senses: Senses,
    ) -> Walk:
        """Return a walk to a point of a map, m, and begin none; raises NoPathError."""
        return Walk(self.planner(occupancy), self._robot.walk, obstacles, goal, senses)

    def end(self) -> None:
        """End the walk under way, if there is one."""
        self._walk = None

    def tick(self, senses: Senses, max_speed: float) -> tuple[Twist, float]:
        """Return the wanted twist, and the cruise speed, m/s; there must be a walk."""
        assert self._walk is not None
        self._step = step = self._walk.tick(senses, max_speed)
        if step.state not in _UNDER_WAY:
            self._walk, self.ended = None, step
        if step.state is not WalkState.WALKING:
            return STANDSTILL, step.cruise_speed
        return self._loop.tick(senses.pose, step.setpoint, max_speed), step.cruise_speed

    def planner(self, occupancy: OccupancyMap) -> PathPlanner:
        """Return the planner of walks over a map."""
        if self._planner is None or self._planner[0] is not occupancy:
            walk, radius = self._robot.walk, self._robot.body.radius
            planner = PathPlanner(occupancy, radius, walk.clearance, walk.tight_clearance)
            self._planner = occupancy, planner
        return self._planner[1]
