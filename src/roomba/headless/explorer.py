"""A robot that makes its own map, without ROS: mission and mapper around the simulated world.

The brain gets what the sensors tell and nothing else.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import RoombaError
from roomba.geometry import STANDSTILL
from roomba.grid import OccupancyMap
from roomba.headless.closed_loop import EVERY, LONGEST_BURST, STEP, STEPS_PER_TICK
from roomba.headless.exploring_loop import ExploringLoop
from roomba.headless.exploring_loop_kernels import BELIEVED, PASSED, TIME, TRUE, Sight
from roomba.headless.parts import SafeDrive, senses_of
from roomba.mission.exploring.exploration import ExploreResult
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission, MissionStep
from roomba.mission.phases.machine import Phase
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.slam.mapper import Mapper
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_AROUND_GOAL: Final = 0.4
"""m; farther from the frontier that it is on its way to nothing tells whether it still is one."""
_BESIDE_SURFACES: Final = 0.3
"""m; what is farther from all that the map shows is a thing wherever it is seen."""
_PLANNING: Final = (Phase.CLEANING, Phase.EXPLORING, Phase.RETURNING)
"""In the others no way is planned: the map may wait."""
_LONGEST: Final = 6 * 3600.0
"""s; an exploration that is still under way then is a fault of the program."""


@dataclass(frozen=True, slots=True, eq=False)
class ExploreRecord:
    """What happened: rows of ``poses`` and ``believed`` are t (s), x, y (m), theta (rad), of each
    tick; the first are true ones, map frame. ``occupancy`` is the map in the end.
    """

    result: ExploreResult
    occupancy: OccupancyMap
    poses: NDArray[np.float64]
    believed: NDArray[np.float64]
    hits: int
    wall: float
    """s of a wall clock that it took."""


class HeadlessExplorer:
    """One robot without a map in one home, on its station; the map's frame is the home's."""

    def __init__(
        self,
        home: Home,
        robot: SimulatedRobotConfig | None = None,
        mission: MissionConfig | None = None,
        mapping: MappingConfig | None = None,
        *,
        seed: int = 0,
        longest_burst: int = LONGEST_BURST,
    ) -> None:
        """Put the robot on its station and let it look around from there.

        ``longest_burst`` is how many ticks pass at most without an ordinary one, while nothing
        comes up.
        """
        self.robot, self.config = robot or SimulatedRobotConfig(), mission or MissionConfig()
        self._docking = DockingConfig()
        self.simulator = Simulator(home, self.robot, seed=seed)
        self._station = self.simulator.start
        lidar = self.robot.lidar
        self.lidar = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
        self._beams = self.lidar.arrays()
        self.mapper = Mapper(
            mapping or MappingConfig(), self.robot.localization, self.robot.gyro, self._station
        )
        self._drive = SafeDrive(self.robot, self.simulator.max_speed)
        self._things: ThingLayer | None = None
        self._scans = self._used = self._looked = 0
        self._shown = -np.inf
        self.seen = self.simulator.observe()
        self._sense()
        while not self.mapper.version:
            # It stands on its station until the first scan came.
            self.simulator.advance(STANDSTILL, STEP, STEPS_PER_TICK)
            self.seen = self.simulator.observe()
            self._sense()
        site = self._site(self.mapper.occupancy())
        self.mission = Mission(
            site,
            self.robot,
            self.config,
            self._docking,
            self._look_beside(site),
            DirtMap(site.occupancy),
            self.senses(),
        )
        self.passed: list[NDArray[np.float64]] = []
        self._loop = ExploringLoop(self, longest_burst)

    def explore(self) -> ExploreRecord:
        """Explore to the end; raises CommandRefusedError."""
        began, hits = time.perf_counter(), self.simulator.numbers["hits"]
        self.mission.explore(self.senses())
        start = self.seen.time
        while (result := self.mission.take_exploration()) is None:
            if self.seen.time - start > _LONGEST:
                raise RoombaError("an exploration has no end; that is a fault of the program")
            self.advance()
        occupancy = self.mapper.finish()
        rows = np.concatenate([np.empty((0, PASSED)), *self.passed])
        return ExploreRecord(
            result,
            occupancy,
            np.column_stack((rows[:, TIME], rows[:, TRUE])),
            np.column_stack((rows[:, TIME], rows[:, BELIEVED])),
            int(self.simulator.numbers["hits"] - hits),
            time.perf_counter() - began,
        )

    def advance(self) -> None:
        """Let time pass: many ticks at once while nothing comes up, else one that looks around."""
        if self._loop.may_run():
            self._loop.run(self._shown + self.robot.timing.map_period if self._has_news else np.inf)
            self._show_map()
        else:
            self.tick()

    def tick(self) -> MissionStep:
        """Let one tick pass, by the ordinary classes; return what the mission wanted."""
        step = self.mission.tick(self.senses())
        command = self._drive.command(self.seen, step.twist)
        self.simulator.advance(command, STEP, STEPS_PER_TICK)
        self.seen = self.simulator.observe()
        self._sense()
        self.passed.append(self.row())
        self._show_map()
        self._loop.was_ticked()
        return step

    def caught_up(self, rows: NDArray[np.float64], points: int, way: float) -> None:
        """Take over after the compiled loop: ``rows`` [n, PASSED] passed, ``way`` m were driven.

        The newest scan is a keyframe if it has so many ``points``.
        """
        self.seen = seen = self.simulator.observe()
        self._scans = seen.scans
        self.mapper.resumed(points)
        if points:
            self._see_things()
        believed = self.mapper.pose
        rows[-1, BELIEVED] = believed.x, believed.y, believed.theta
        self.passed.append(rows)
        self.mission.caught_up(self.senses(), way)

    def senses(self) -> Senses:
        """Return what the robot senses now."""
        return senses_of(self.seen, self.mapper.estimate)

    def _sense(self) -> None:
        seen, mapper = self.seen, self.mapper
        mapper.move(seen.time, seen.odometry, seen.angular_velocity)
        if seen.scans == self._scans:
            return
        self._scans = seen.scans
        if self._scans % EVERY and mapper.version:
            return
        mapper.see(seen.time, self.simulator.ranges, self.lidar)
        if mapper.estimate.knowledge is Knowledge.KNOWN:
            self._see_things()

    def _see_things(self) -> None:
        if self._things is not None:
            self._things.see(self.simulator.ranges, self._beams, self.mapper.pose)

    def row(self) -> NDArray[np.float64]:
        """Return what is so now, as a tick that passed: float64 [1, PASSED]."""
        seen, believed = self.seen, self.mapper.pose
        poses = [(each.x, each.y, each.theta) for each in (seen.pose, believed, seen.odometry)]
        return np.array([[seen.time, *poses[0], *poses[1], *poses[2], seen.angular_velocity]])

    @property
    def _has_news(self) -> bool:
        """Whether the map has grown since it was looked at."""
        return self.mapper.version != self._looked

    def _show_map(self) -> None:
        """Let the mission go on with the map as it is now, if that makes a difference to it."""
        mission, version = self.mission, self.mapper.version
        if mission.driver is None:
            if version == self._used or mission.state.phase not in _PLANNING:
                return
        elif self._has_news and self.seen.time - self._shown >= self.robot.timing.map_period:
            self._shown, self._looked = self.seen.time, version
            if not mission.wants_map(self._around_goal()):
                return
        else:
            return
        self._shown, self._looked, self._used = self.seen.time, version, version
        site = self._site(self.mapper.occupancy())
        mission.use_map(site, self._look_beside(site), DirtMap(site.occupancy))

    def _around_goal(self) -> OccupancyMap:
        """Return the map around the frontier that it is on its way to: all that it asks for."""
        exploration = self.mission.exploration
        goal = None if exploration is None else exploration.goal
        x, y = self.mission.last_place if goal is None else goal.middle
        return self.mapper.occupancy_around(x, y, _AROUND_GOAL)

    def _look_beside(self, site: PlanningContext) -> ThingLayer:
        """Look from now on for what a site's map does not show."""
        field = SurfaceField.near(site.occupancy, _BESIDE_SURFACES)
        self._things = ThingLayer(field)
        self.sight = Sight(self._things.arrays, field.values, field.place)
        return self._things

    def _site(self, occupancy: OccupancyMap, *, is_growing: bool = True) -> PlanningContext:
        parts = self._station, self.robot, self.config, self._docking
        return PlanningContext(occupancy, *parts, is_growing=is_growing)
