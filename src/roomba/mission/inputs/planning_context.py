"""The planning context: map, zones, rooms and station, with the planners over them."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Point, Pose, RoundObstacle
from roomba.grid import GridFrame, OccupancyMap
from roomba.mission.docking.docking import staging_pose
from roomba.mission.inputs.gaps import closed_gaps
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones
from roomba.planning.coverage.floor.floor import CoverageFloor
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.coverage.planner import UNWATCHED, CoveragePlanner
from roomba.planning.coverage.stages import OUR_STAGES, CoverageStages
from roomba.planning.path.careful import CarefulPathPlanner
from roomba.planning.path.new_walls import is_walled
from roomba.planning.path.planner import NoPathError, NoPathReason, PathPlanner

_NEARER: Final = 0.02
"""m by which the staging place is moved towards the station, again until there is room."""


@dataclass(frozen=True, eq=False)
class NarrowFloor:
    """Where the robot's middle can be, as near to walls as it cleans.

    ``places``, bool over the map's grid ``frame``, are the cells in which the middle can be at some
    point; ``fine``, over the ``fine_frame``, is exact.
    """

    frame: GridFrame
    fine_frame: GridFrame
    places: Mask
    fine: Mask

    def place_near(self, there: Point) -> Point:
        """Return the point of the cell of ``places`` around ``there`` that is nearest to it, m.

        Around the robot itself there may be no such point: then the nearest of all points is
        returned, of which there must be some.
        """
        row, column = self.frame.cell_of(*there)
        parts = self.fine_frame.rows // self.frame.rows
        window = self.fine[row * parts : (row + 1) * parts, column * parts : (column + 1) * parts]
        cells = np.argwhere(window) + np.array((row * parts, column * parts))
        if len(cells) == 0:
            cells = np.argwhere(self.fine)
        x, y = self.fine_frame.centres(cells[:, 0], cells[:, 1])
        nearest = int(np.argmin(np.hypot(x - there[0], y - there[1])))
        return float(x[nearest]), float(y[nearest])


class PlanningContext:
    """What all planning uses: map, zones, rooms, station; an edit of them makes a new one."""

    def __init__(
        self,
        occupancy: OccupancyMap,
        station: Pose,
        robot: RobotConfig,
        mission: MissionConfig,
        docking: DockingConfig,
        rooms: Rooms | None = None,
        zones: Zones | None = None,
        *,
        is_growing: bool = False,
        stages: CoverageStages = OUR_STAGES,
        plan_watch: AbstractContextManager[object] = UNWATCHED,
    ) -> None:
        """Make the planners; ``station`` is where the docked robot stands, map frame.

        In a map that ``is_growing`` paths keep the distances of exploring. ``stages`` are those of
        planning coverage. ``plan_watch`` is entered for each plan of its coverage planners, and may
        count them.
        """
        self.occupancy, self.station = occupancy, station
        self.rooms, self.zones = rooms, zones or Zones()
        self.known = self.zones.kept_out(occupancy)
        driving, radius = mission.driving, robot.body.radius
        self.reach, self._gap_spare = radius + driving.clearance, driving.gap_spare
        self._growing_reach = radius + mission.exploring.cleaning_clearance
        self.staging_tolerance = docking.place_tolerance
        self.spot_size = mission.cleaning.spot_size
        self.tool_width, self._sharp_corner = robot.brush.width, robot.tracking.sharp_corner
        self._coverage_config, self._stages = mission.coverage, stages
        self._plan_watch = plan_watch
        self.body_radius, self.is_growing = radius, is_growing
        # Paths may come as near to walls as swaths do, so that they can join them.
        self._clearance, self._least = driving.way_clearance, driving.tight_clearance
        if is_growing:
            exploring = mission.exploring
            self._clearance, self._least = exploring.clearance, exploring.tight_clearance
            clearances = exploring.clearance, exploring.careful_clearance, self._least
            self.paths: PathPlanner = CarefulPathPlanner(self.known, radius, *clearances)
        else:
            self.paths = PathPlanner(self.known, radius, self._clearance, self._least)
        self.staging = self._staging(docking)

    def _staging(self, docking: DockingConfig) -> Pose:
        """Return the place before the station, nearer to it where a wall is behind the robot.

        A map that is growing does not show such walls for sure: there the place is not moved.
        """
        far = staging_pose(self.station, docking.staging_distance)
        if self.is_growing:
            return far
        for distance in np.arange(docking.staging_distance, docking.shortest_way, -_NEARER):
            place = staging_pose(self.station, float(distance))
            if self.paths.is_free(np.array([[place.x, place.y]] * 2)):
                return place
        return far

    @cached_property
    def coverage(self) -> CoveragePlanner:
        """The planner of ways over the floor; made when it is first asked for: that takes time."""
        return self._coverage_planner(self.reach)

    @cached_property
    def growing_coverage(self) -> CoveragePlanner:
        """The same for a growing map: farther from walls, as they and the pose may be off."""
        return self._coverage_planner(self._growing_reach)

    def _coverage_planner(self, reach: float) -> CoveragePlanner:
        return CoveragePlanner(
            self.known,
            reach,
            self.tool_width,
            self._sharp_corner,
            self._coverage_config,
            self._stages,
            self._plan_watch,
        )

    @cached_property
    def longest_way(self) -> float:
        """An upper bound for shortest ways over the map, m: such a way sweeps no floor twice."""
        return self.occupancy.free_area / (2.0 * self.body_radius)

    @property
    def floor(self) -> CoverageFloor:
        """The floor on the fine grid."""
        return self.coverage.floor

    def plan_coverage(
        self,
        here: Point,
        todo: Mask,
        obstacles: Sequence[RoundObstacle],
        *,
        edges_only: bool,
        end: Point | None = None,
    ) -> CoveragePlan:
        """Plan to sweep ``todo``, bool over ``frame``, from ``here``, and on to an ``end``.

        The end is the staging place where none is given, or no way leads to ``end``. Raises
        NoPathError when the robot cannot move.
        """
        home = (self.staging.x, self.staging.y)
        if end is not None:
            with contextlib.suppress(NoPathError):
                return self.coverage.plan(here, end, todo, obstacles, edges_only=edges_only)
        return self.coverage.plan(here, home, todo, obstacles, edges_only=edges_only)

    def with_closed_gaps(self, obstacles: Sequence[RoundObstacle]) -> list[RoundObstacle]:
        """Return the obstacles, and what closes gaps between them that are too narrow."""
        return [*obstacles, *closed_gaps(obstacles, self.reach, self._gap_spare)]

    def reachable(self, here: Point, obstacles: Sequence[RoundObstacle]) -> Mask:
        """Return the floor that can be cleaned from ``here``, bool over ``frame``.

        All gaps between ``obstacles`` that the body fits through count as open: see
        with_closed_gaps.
        """
        return self.floor.with_obstacles(obstacles).coverable(here)

    def has_new_on(self, points: NDArray[np.float64], occupancy: OccupancyMap) -> bool:
        """Whether a newer map shows something new on a way, float64 [n, 2], m, through this one."""
        return is_walled(points, occupancy, self.occupancy, self.body_radius, self._least)

    def squeeze(
        self, here: Point, there: Point, obstacles: Sequence[RoundObstacle]
    ) -> NDArray[np.float64]:
        """Return a way, float64 [n, 2], m, through gaps that are too narrow for :attr:`paths`.

        It ends so near to ``there`` that at its end the robot has arrived, even if that is the
        staging place. Raises NoPathError when there is none, as where the body does not fit there.
        """
        nothing = np.zeros(self.frame.shape, np.bool_)
        points = self.coverage.plan(here, there, nothing, obstacles).points
        # The other half of the tolerance is for how near to its end the robot drives.
        if math.dist(points[-1], there) > self.staging_tolerance / 2:
            last = (float(points[-1, 0]), float(points[-1, 1]))
            raise NoPathError(there, NoPathReason.GOAL_IN_OBSTACLE, last)
        return points

    def narrow_floor(self, here: Point, obstacles: Sequence[RoundObstacle]) -> NarrowFloor:
        """Return where the robot's middle can get to through all gaps that a clean passes."""
        fine = self.floor.with_obstacles(obstacles).middles(here)
        parts = self.frame.rows // self.known.frame.rows
        rows, columns = self.known.frame.shape
        places = fine.reshape(rows, parts, columns, parts).any(axis=(1, 3))
        return NarrowFloor(self.known.frame, self.frame, places, fine)

    def is_in_zone(self, here: Point) -> bool:
        """Whether a robot at a point touches a zone where it must not go."""
        frame, reach = self.known.frame, self.body_radius
        row, column = frame.cell_of(here[0] - reach, here[1] - reach)
        last_row, last_column = frame.cell_of(here[0] + reach, here[1] + reach)
        rows = slice(max(row, 0), max(last_row + 1, 0))
        columns = slice(max(column, 0), max(last_column + 1, 0))
        zone = (self.known.values != self.occupancy.values)[rows, columns]
        found = np.argwhere(zone)
        x, y = frame.centres(found[:, 0] + rows.start, found[:, 1] + columns.start)
        return bool((np.hypot(x - here[0], y - here[1]) < reach).any())

    def way_out_of_zone(
        self, here: Point, obstacles: Sequence[RoundObstacle]
    ) -> NDArray[np.float64]:
        """Return the shortest way, float64 [n, 2], m, out of the zones to where it may be.

        The way itself goes through zones. Raises NoPathError when there is none.
        """
        planner = PathPlanner(self.occupancy, self.body_radius, self._clearance, self._least)
        allowed = self.paths.reachable((self.staging.x, self.staging.y))
        places = np.argwhere(allowed & planner.reachable(here, obstacles))
        if not len(places):
            raise NoPathError(here, NoPathReason.GOAL_UNREACHABLE, None)
        x, y = self.known.frame.centres(places[:, 0], places[:, 1])
        nearest = int(np.argmin(np.hypot(x - here[0], y - here[1])))
        return planner.plan(here, (float(x[nearest]), float(y[nearest])), obstacles).points

    @cached_property
    def carpets(self) -> Mask:
        """The floor below carpets that are drawn on the map, bool over ``frame``."""
        return self.fine(self.zones.carpets(self.occupancy.frame))

    def is_on_carpet(self, x: float, y: float) -> bool:
        """Whether a carpet that is drawn on the map lies at a point, m."""
        return self.zones.is_carpet_at(x, y)

    @property
    def frame(self) -> GridFrame:
        """The fine grid that coverage is counted on."""
        return self.floor.frame

    def coverable(self, here: Pose | None = None) -> Mask:
        """Return the floor that can be cleaned from the station, bool over ``frame``.

        Where no way leads from there to ``here``, the floor around that counts as well: a robot
        that was carried beyond a step or a virtual wall can clean there. A map that grows shows
        only the floor that the robot saw from its station.
        """
        floor = self.floor.coverable((self.staging.x, self.staging.y))
        if here is None or self.is_growing or self._is_at_station(here):
            return floor
        if self.frame.contains(here.x, here.y) and floor[self.frame.cell_of(here.x, here.y)]:
            return floor
        return floor | self.floor.coverable((here.x, here.y))

    def _is_at_station(self, here: Pose) -> bool:
        """Whether a pose is no farther from the station than where the robot begins to dock."""
        reach = self.station.distance_to(self.staging.x, self.staging.y)
        return here.distance_to(self.station.x, self.station.y) <= reach

    def in_room(self, name: str) -> Mask:
        """Return a room's cells over ``frame``; raises RoomsError for an unknown name."""
        assert self.rooms is not None
        label = self.rooms.label_of(name)
        return self.fine(self.rooms.labels == label)

    def fine(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return values over the map's grid as those over ``frame``."""
        factor = self.frame.rows // self.known.frame.rows
        return np.repeat(np.repeat(values, factor, axis=0), factor, axis=1)

    def room_at(self, x: float, y: float) -> str:
        """Return the name of the room at a point, or nothing."""
        if self.rooms is None:
            return ""
        label = self.rooms.at(x, y)
        return self.rooms.names[label - 1] if label else ""
