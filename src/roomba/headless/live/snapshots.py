"""What a page reads of a live headless robot: snapshots that are taken in the robot's thread."""

from __future__ import annotations

import itertools
import threading
from dataclasses import dataclass, replace

from roomba.client.protocol import CleanReport, ExploreReport, RobotUnavailableError
from roomba.client.view import GridLayer, HomeView, RobotView, exploration_as_clean
from roomba.grid import GridFrame
from roomba.headless.embodied import Embodied
from roomba.headless.live.floor_plan import FloorPlan
from roomba.headless.live.live_home import LiveHome
from roomba.headless.live.views import (
    clean_report,
    dirt_layer,
    exploration_report,
    home_view,
    map_cells,
    robot_view,
)
from roomba.headless.tick_rows import BELIEVED, TIME
from roomba.perception.rooms.rooms import segment
from roomba.perception.swept.visits import Visits


@dataclass(frozen=True, slots=True)
class ErrandsEnded:
    """The reports of errands that ended since the last look."""

    clean: CleanReport | None = None
    exploration: ExploreReport | None = None


class Snapshots:
    """The newest snapshots; they may be read from any thread, all else is for the robot's own."""

    def __init__(self, robot: Embodied, plan: FloorPlan, live_home: LiveHome) -> None:
        """Begin before the first frame."""
        self.plan, self._live_home = plan, live_home
        self._lock = threading.Lock()
        self._versions = itertools.count(1)
        self._view: RobotView | None = None
        self._home_view: HomeView | None = None
        self._last: CleanReport | None = None
        self.ended = ErrandsEnded()
        self._map: GridLayer | None = None
        self._map_of: object = None
        self._felt_of: tuple[object, ...] = ()
        self._visits = Visits(robot.mission.context.occupancy.frame, robot.robot_config.brush.width)
        self._shape = 0

    def robot(self) -> RobotView:
        """Return the newest state; raises RobotUnavailableError before the first one."""
        if self._view is None:
            raise RobotUnavailableError("the robot has not begun to live yet")
        return self._view

    def home(self) -> HomeView:
        """Return what seldom changes; raises RobotUnavailableError before the first frame."""
        if self._home_view is None:
            raise RobotUnavailableError("the robot has not begun to live yet")
        return self._home_view

    def map(self) -> GridLayer | None:
        """Return the newest map."""
        with self._lock:
            return self._map

    def coverage(self) -> GridLayer:
        """Return a copy of how often each cell was swept."""
        with self._lock:
            return GridLayer.over(self._visits.frame, self._visits.counts.copy(), self._shape)

    def dirt(self, robot: Embodied) -> GridLayer:
        """Return where dirt was found."""
        return dirt_layer(robot.dirt, self._shape)

    def observe(self, robot: Embodied) -> None:
        """Take snapshots after a frame."""
        self._follow_sweeps(robot)
        self.look(robot)

    def look(self, robot: Embodied) -> None:
        """Take snapshots after a command."""
        self._take_results(robot)
        if self._home_view is None or self._felt_of != _felt_by(robot):
            self._look_at_home(robot)
        self._follow_map(robot)
        self._view = robot_view(robot, self._last, self._live_home.truth())

    def begin_coverage(self) -> None:
        """Count sweeps anew, from zero."""
        with self._lock:
            self._visits.clear()

    def use(self, robot: Embodied, plan: FloorPlan) -> None:
        """Let the robot go on with other rooms and zones."""
        robot.brain.use_rooms(plan.rooms, plan.zones)
        self.plan = plan
        self._look_at_home(robot)

    def _look_at_home(self, robot: Embodied) -> None:
        self._felt_of = _felt_by(robot)
        version = next(self._versions)
        parts = self._live_home, robot, self.plan.rooms, self.plan.zones
        self._home_view = home_view(version, *parts)

    def _follow_sweeps(self, robot: Embodied) -> None:
        """Count what was swept during the frame."""
        with self._lock:
            if not robot.mission.sweeps:
                self._visits.lift()
                return
            for row in robot.passed[::2].tolist():
                x, y, _ = row[BELIEVED]
                self._visits.sweep(row[TIME], x, y)
            pose = robot.brain.pose
            self._visits.sweep(robot.now.time, pose.x, pose.y)

    def _take_results(self, robot: Embodied) -> None:
        clean, exploration = robot.mission.take_result(), robot.mission.take_exploration()
        self.ended = ended = ErrandsEnded(
            None if clean is None else clean_report(clean),
            None if exploration is None else exploration_report(exploration),
        )
        if ended.clean is not None:
            self._last = ended.clean
        if ended.exploration is not None:
            self._last = exploration_as_clean(ended.exploration)
        if exploration is not None and exploration.is_completed:
            robot.brain.finish_map()

    def _follow_map(self, robot: Embodied) -> None:
        """Take over a map that has changed."""
        occupancy = robot.mission.context.occupancy
        if self._map_of is occupancy:
            return
        self._map_of = occupancy
        with self._lock:
            if not self._lies_alike(occupancy.frame):
                self._shape += 1
                if robot.brain.growing is not None:
                    self._visits.carry(occupancy.frame)
                else:
                    self._visits = Visits(occupancy.frame, robot.robot_config.brush.width)
            cells = map_cells(self._live_home.plan, occupancy)
            self._map = GridLayer.over(occupancy.frame, cells, self._shape)
        if robot.brain.zones != self.plan.zones:
            # The brain turned the zones with the map when that became whole.
            self.plan = replace(self.plan, zones=robot.brain.zones)
        self._find_rooms(robot)
        self._look_at_home(robot)

    def _lies_alike(self, frame: GridFrame) -> bool:
        """Whether the newest map has the same cells as ``frame``."""
        shown = self._map
        if shown is None or shown.cells.shape != frame.shape:
            return False
        return (shown.origin_x, shown.origin_y) == (frame.origin_x, frame.origin_y)

    def _find_rooms(self, robot: Embodied) -> None:
        """As soon as a map that was made is whole, find its rooms."""
        growing = robot.brain.growing
        if growing is not None and growing.is_whole and self.plan.rooms is None:
            rooms = segment(robot.mission.context.occupancy)
            if rooms.names:
                self.use(robot, FloorPlan(rooms, self.plan.zones))


def _felt_by(robot: Embodied) -> tuple[object, ...]:
    """Return what was felt, all of it: low things and carpets."""
    return robot.mission.obstacles.low, robot.mission.carpets.felt
