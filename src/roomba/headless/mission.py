"""The robot without ROS: its brain in a simulated body, in one home.

Time passes only while the robot is told to do something. The brain gets the sensors' readings and
nothing else. It cleans, explores and walks on the home's map, on another one, or on its own.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import RoombaError
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.headless.body import SimulatedBody
from roomba.headless.burst import LONGEST_BURST, Burst
from roomba.headless.embodied import Embodied
from roomba.headless.plan_watch import PlanWatch
from roomba.headless.records import (
    CleanRecord,
    ExploreRecord,
    WalkRecord,
    longest_errand,
    require_end,
)
from roomba.headless.tick_rows import BELIEVED, POSES, TIME
from roomba.mission.phases.at_station import why_not_emptied
from roomba.mission.phases.machine import Event
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones
from roomba.perception.slam.mapper import Mapper
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.perception.things.layer import ThingLayer
from roomba.planning.coverage.floor.floor import fine_frame
from roomba.planning.coverage.stages import OUR_STAGES, CoverageStages
from roomba.robot.brain import Brain
from roomba.vocabulary import Phase
from roomba.world.home.home import Home
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator


class HeadlessMission(Embodied):
    """One robot in one home.

    ``truth`` is the floor that its tool really passed over, with room in its bin; ``rows`` are the
    ticks that passed, as of :mod:`roomba.headless.tick_rows`, in pieces; ``context`` is the
    planning context at the start; ``emptied`` is what was taken out of the dust bin by hand each
    time, g; ``is_emptied_at_station``: its station empties the bin as soon as that is full.
    """

    body: SimulatedBody
    robot_config: SimulatedRobotConfig

    def __init__(
        self,
        home: Home,
        robot: SimulatedRobotConfig | None = None,
        mission: MissionConfig | None = None,
        docking: DockingConfig | None = None,
        *,
        seed: int = 0,
        known: OccupancyMap | MappingConfig | None = None,
        rooms: Rooms | None = None,
        zones: Zones | None = None,
        start: Pose | None = None,
        max_speed: float | None = None,
        longest_burst: int = LONGEST_BURST,
        empties_bin_after: float = 120.0,
        stages: CoverageStages = OUR_STAGES,
    ) -> None:
        """Put the robot on its station, or at ``start``.

        ``known`` is the map that the robot goes by, in the home's frame, or the configuration by
        which it makes one from its station; by default the home's own map. ``max_speed``, m/s, is
        its top speed, by default its body's. ``longest_burst`` is the most ticks of a burst. A full
        dust bin is emptied ``empties_bin_after`` s after the robot said that it is full.
        ``stages`` are those of planning coverage.
        """
        robot, self.config = robot or SimulatedRobotConfig(), mission or MissionConfig()
        known = known or home.map
        body = SimulatedBody(home, robot, seed, max_speed, start)
        self._planned = PlanWatch()
        brain = Brain(
            known,
            home.station,
            robot,
            self.config,
            docking or DockingConfig(),
            rooms=rooms,
            zones=zones,
            start=start,
            max_speed=max_speed,
            stages=stages,
            plan_watch=self._planned,
        )
        super().__init__(body, brain, robot)
        self.whole_at: float | None = None
        self.emptied: list[float] = []
        self._empties_bin_after = empties_bin_after
        self._full_since: float | None = None
        self.is_emptied_at_station = robot.station.empties
        self._longest = longest_errand(home)
        self.context = self.mission.context
        frame = home.map.frame if isinstance(known, MappingConfig) else known.frame
        fine = fine_frame(frame, self.config.coverage.cell)
        self.truth = CoverageMap(fine, np.ones(fine.shape, np.bool_), self.context.tool_width)
        self._burst = Burst(self.body, self.brain, self.truth, longest_burst)

    def clean(self, request: CleanRequest | None = None) -> CleanRecord:
        """Clean to the end; raises CleanRefusedError."""
        self.mission.clean(request or CleanRequest(), self.senses())
        return self.run()

    def run(self) -> CleanRecord:
        """Let time pass until the clean under way has a result."""
        began, hits = self.seen.time, self._hits
        distance, turning = self._driven
        plans, planning = self._planned.plans, self._planned.seconds
        while (result := self.mission.take_result()) is None:
            require_end(self.seen.time - began, self._longest)
            self.advance()
        now_distance, now_turning = self._driven
        return CleanRecord(
            result=result,
            poses=self.passed[:, POSES],
            truth=self.truth,
            hits=self._hits - hits,
            distance=now_distance - distance,
            turning=now_turning - turning,
            planning=self._planned.seconds - planning,
            plans=self._planned.plans - plans,
            occupancy=self.mission.context.occupancy,
            whole_at=self.seen.time if self.whole_at is None else self.whole_at,
        )

    def explore(self) -> ExploreRecord:
        """Explore to the end, and make the map whole.

        Raises CommandRefusedError, and RoombaError on a known map.
        """
        mapper = self.mapper
        began, hits, start = time.perf_counter(), self._hits, self.seen.time
        self.mission.explore(self.senses())
        while (result := self.mission.take_exploration()) is None:
            require_end(self.seen.time - start, self._longest)
            self.advance()
        occupancy, rows = mapper.finish(), self.passed
        return ExploreRecord(
            result,
            occupancy,
            rows[:, POSES],
            np.column_stack((rows[:, TIME], rows[:, BELIEVED])),
            self._hits - hits,
            time.perf_counter() - began,
        )

    def walk(self, x: float, y: float) -> WalkRecord:
        """Walk to a point, m, map frame, until the robot is there or gives up.

        Raises NoPathError when there is no way.
        """
        walking, walk, start = self.brain.walking, self.brain.walk(x, y), self.seen.time
        rows, steps = [self.row()], []
        bumps, was_bumped = 0, self.seen.bumper.pressed
        while walking.is_under_way:
            require_end(self.seen.time - start, self._longest)
            self.tick()
            rows.append(self.rows[-1])
            steps.append(walking.newest)
            bumps += self.seen.bumper.pressed and not was_bumped
            was_bumped = self.seen.bumper.pressed
        last, passed = steps[-1], np.concatenate(rows)
        return WalkRecord(
            last.state,
            last.reason,
            self.seen.time - start,
            walk.path.points,
            passed[:, POSES],
            np.column_stack((passed[:, TIME], passed[:, BELIEVED])),
            bumps,
            steps,
        )

    def advance(self) -> None:
        """Let time pass: a burst of steady ticks if the next ones are steady, else one tick."""
        rows = self._burst.run()
        if len(rows):
            self.rows.append(rows)
        else:
            self.tick()

    def tick(self) -> None:
        """Let one tick pass, by the ordinary classes and not in a burst."""
        growing = self.brain.growing
        was_whole = growing is None or growing.is_whole
        self._empty_bin_in_time()
        super().tick()
        pose = self.seen.pose
        if self.seen.in_bin < self.robot_config.brush.bin_capacity:
            self.truth.sweep(pose.x, pose.y)
        else:
            self.truth.lift()
        if growing is not None and growing.is_whole and not was_whole:
            self.whole_at = self.seen.time

    def look(self) -> None:
        """Give the brain new readings, after the world was changed while no time passed."""
        self.brain.told(self.readings())

    def _empty_bin_in_time(self) -> None:
        """Empty the dust bin, as a person does some time after the robot said that it is full."""
        if self.mission.state.phase is not Phase.BIN_FULL:
            self._full_since = None
            return
        if self.is_emptied_at_station and not why_not_emptied(self.now.emptying):
            self.mission.command(Event.EMPTY, self.senses())
            return
        if self._full_since is None:
            self._full_since = self.seen.time
        if self.seen.time - self._full_since >= self._empties_bin_after:
            self.emptied.append(self.simulator.empty_bin())
            self.look()

    @property
    def seen(self) -> Observation:
        """The newest observation: the truth, and what the sensors tell."""
        return self.body.seen

    @property
    def simulator(self) -> Simulator:
        """The world with the body in it."""
        return self.body.simulator

    @property
    def lidar(self) -> LidarModel:
        """The body's lidar."""
        return self.body.lidar

    @property
    def localizer(self) -> Localizer:
        """The localizer, which needs a known or whole map; raises RoombaError without one."""
        if self.brain.localizer is None:
            raise RoombaError("a robot that makes its map has a mapper, no localizer")
        return self.brain.localizer

    @property
    def mapper(self) -> Mapper:
        """The mapper of a robot that makes its map; raises RoombaError on a known one."""
        if self.brain.mapper is None:
            raise RoombaError("only a robot that makes its map has a mapper: give a MappingConfig")
        return self.brain.mapper

    @property
    def things(self) -> ThingLayer:
        """What the robot sees that its map does not show."""
        return self.brain.things

    @property
    def is_home(self) -> bool:
        """Whether the robot stands on its station."""
        return self.mission.state.phase is Phase.DOCKED

    @property
    def distance(self) -> float:
        """Length of the way that the robot really drove, m."""
        return self.simulator.numbers["distance"]

    @property
    def battery_change(self) -> float:
        """Change of the battery's charge as a share of its capacity, 1/s."""
        battery = self.seen.battery
        return battery.current * (battery.voltage / (3600.0 * battery.capacity))

    @property
    def dirt_under(self) -> float:
        """The dirt on the floor under the robot, g."""
        return self.seen.dirt_under

    def row(self) -> NDArray[np.float64]:
        """Return the present state as the row of a tick: float64 [1, PASSED]."""
        seen, believed = self.seen, self.brain.pose
        poses = [(each.x, each.y, each.theta) for each in (seen.pose, believed, seen.odometry)]
        turning = seen.angular_velocity, self.brain.keeper.gyro_bias
        return np.array([[seen.time, *poses[0], *poses[1], *poses[2], *turning]])

    @property
    def _hits(self) -> int:
        return int(self.simulator.numbers["hits"])

    @property
    def _driven(self) -> tuple[float, float]:
        numbers = self.simulator.numbers
        return numbers["distance"], numbers["turned"]
