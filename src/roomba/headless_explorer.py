"""A robot that makes its own map, without ROS: mission and mapper around the simulated world.

The brain gets what the sensors tell and nothing else.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.closed_loop import EVERY, STEP, STEPS_PER_TICK
from roomba.config import RobotConfig
from roomba.errors import RoombaError
from roomba.geometry import STANDSTILL
from roomba.grid import OccupancyMap
from roomba.headless_parts import SafeDrive, senses_of
from roomba.mission.docking_config import DockingConfig
from roomba.mission.exploration import ExploreResult
from roomba.mission.mission import Mission
from roomba.mission.senses import Senses
from roomba.mission.site import Site
from roomba.mission_config import MissionConfig
from roomba.perception.dirt_map import DirtMap
from roomba.perception.estimate import Knowledge
from roomba.perception.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.mapping_config import MappingConfig
from roomba.perception.surface_field import SurfaceField
from roomba.perception.things import ThingLayer
from roomba.world.home import Home
from roomba.world.simulator import Simulator

MAP_PERIOD: Final = 0.5
"""s; so often the map is looked at, whether it makes a difference to the mission."""
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
        robot: RobotConfig | None = None,
        mission: MissionConfig | None = None,
        mapping: MappingConfig | None = None,
        *,
        seed: int = 0,
    ) -> None:
        """Put the robot on its station and let it look around from there."""
        self.robot, self.config = robot or RobotConfig(), mission or MissionConfig()
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
        self._scans = self._version = 0
        self._shown = -np.inf
        self.seen = self.simulator.observe()
        self._sense()
        while not self.mapper.version:
            # It stands on its station until the first scan came.
            self.simulator.advance(STANDSTILL, STEP, STEPS_PER_TICK)
            self.seen = self.simulator.observe()
            self._sense()
        site = self._site(self.mapper.occupancy())
        self._things = ThingLayer(SurfaceField.of(site.occupancy))
        self.mission = Mission(
            site,
            self.robot,
            self.config,
            self._docking,
            self._things,
            DirtMap(site.occupancy),
            self.senses(),
        )
        self._rows: list[tuple[float, ...]] = []
        self._believed: list[tuple[float, ...]] = []

    def explore(self) -> ExploreRecord:
        """Explore to the end; raises CommandRefusedError."""
        began, hits = time.perf_counter(), self.simulator.numbers["hits"]
        self.mission.explore(self.senses())
        start = self.seen.time
        while (result := self.mission.take_exploration()) is None:
            if self.seen.time - start > _LONGEST:
                raise RoombaError("an exploration has no end; that is a fault of the program")
            self.tick()
        occupancy = self.mapper.finish()
        return ExploreRecord(
            result,
            occupancy,
            np.array(self._rows),
            np.array(self._believed),
            int(self.simulator.numbers["hits"] - hits),
            time.perf_counter() - began,
        )

    def tick(self) -> None:
        """Let one tick pass."""
        step = self.mission.tick(self.senses())
        command = self._drive.command(self.seen, step.twist)
        self.simulator.advance(command, STEP, STEPS_PER_TICK)
        self.seen = self.simulator.observe()
        self._sense()
        self._show_map()
        pose, believed = self.seen.pose, self.mapper.pose
        self._rows.append((self.seen.time, pose.x, pose.y, pose.theta))
        self._believed.append((self.seen.time, believed.x, believed.y, believed.theta))

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
        if mapper.estimate.knowledge is Knowledge.KNOWN and self._things is not None:
            self._things.see(self.simulator.ranges, self._beams, mapper.pose)

    def _show_map(self) -> None:
        """Let the mission go on with the map as it is now, if it has grown."""
        is_due = self.seen.time - self._shown >= MAP_PERIOD or self.mission.driver is None
        if not is_due or self.mapper.version == self._version:
            return
        self._shown = self.seen.time
        occupancy = self.mapper.occupancy()
        if not self.mission.wants_map(occupancy):
            return
        self._version = self.mapper.version
        site = self._site(occupancy)
        self._things = ThingLayer(SurfaceField.of(site.occupancy))
        self.mission.use_map(site, self._things, DirtMap(site.occupancy))

    def _site(self, occupancy: OccupancyMap) -> Site:
        return Site(
            occupancy, self._station, self.robot, self.config, self._docking, is_growing=True
        )
