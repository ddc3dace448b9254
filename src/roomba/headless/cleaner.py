"""The whole robot without ROS: its mission, its loops and its localizer around the simulated world.

Time passes only in :meth:`HeadlessMission.tick` and :meth:`HeadlessMission.run`. The brain gets
what the sensors tell and nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import STANDSTILL, Pose, Twist
from roomba.grid import OccupancyMap
from roomba.headless.closed_loop import LONGEST_BURST, STEP, STEPS_PER_TICK, ClosedLoop
from roomba.headless.parts import SafeDrive, require_end, senses_of
from roomba.mission.cleaning.request import CleanRequest, CleanResult
from roomba.mission.exploring.look_around import SearchDrive
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Phase
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_TICKS_PER_LOOK: Final = 4
_MOST_LOOKS: Final = 5
"""While it charges the mission has its turn after so many looks of so many ticks: each second."""


@dataclass(frozen=True, slots=True, eq=False)
class CleanRecord:
    """What happened on a clean.

    ``poses`` has rows of t (s), x, y (m), theta (rad), true ones, map frame; ``truth`` is the floor
    that the tool really passed over; ``planning`` what all ``plans`` took, s of a wall clock.
    """

    result: CleanResult
    poses: NDArray[np.float64]
    truth: CoverageMap
    hits: int
    distance: float
    turning: float
    planning: float
    plans: int


class HeadlessMission:
    """One robot with its mission in one home."""

    def __init__(
        self,
        home: Home,
        robot: SimulatedRobotConfig | None = None,
        mission: MissionConfig | None = None,
        docking: DockingConfig | None = None,
        *,
        seed: int = 0,
        rooms: Rooms | None = None,
        zones: Zones | None = None,
        start: Pose | None = None,
        longest_burst: int = LONGEST_BURST,
        known: OccupancyMap | None = None,
    ) -> None:
        """Put the robot on its station, or at ``start``.

        ``longest_burst`` is how many ticks pass at once at most, while nothing comes up. ``known``
        is the map that it goes by, in the home's frame; the home's own one by default.
        """
        self.robot = robot or SimulatedRobotConfig()
        self.config = mission or MissionConfig()
        docking = docking or DockingConfig()
        known = known or home.map
        body, lidar = self.robot.body, self.robot.lidar
        self.simulator = Simulator(home, self.robot, seed=seed, start=start)
        self.localizer = Localizer(
            known, self.robot.localization, self.robot.gyro, body.radius, self.simulator.start
        )
        self.lidar = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
        self._beams = self.lidar.arrays()
        self.things = ThingLayer(self.localizer.field)
        self.dirt = DirtMap(known)
        self.site = PlanningContext(
            known, home.station, self.robot, self.config, docking, rooms, zones
        )
        self._drive = SafeDrive(self.robot, self.simulator.max_speed)
        self._search = SearchDrive(body)
        self._scans = 0
        self.seen = self.simulator.observe()
        self._localize()
        self.mission = Mission(
            self.site, self.robot, self.config, docking, self.things, self.dirt, self.senses()
        )
        frame = self.site.frame
        self.truth = CoverageMap(frame, np.ones(frame.shape, np.bool_), self.site.tool_width)
        self.rows: list[NDArray[np.float64]] = []
        self._longest_burst = longest_burst
        self._loop = ClosedLoop(self, longest_burst)

    def clean(self, request: CleanRequest | None = None) -> CleanRecord:
        """Clean to the end; raises CleanRefusedError."""
        request = request or CleanRequest()
        self.mission.clean(request, self.senses())
        self.simulator.set_power(fan=request.fan.value)
        return self.run()

    def run(self) -> CleanRecord:
        """Let time pass until the clean under way has a result."""
        began, hits = self.seen.time, self.simulator.numbers["hits"]
        distance, turning = self._driven()
        while (result := self.mission.take_result()) is None:
            require_end(self.seen.time - began, self.simulator.home)
            self.advance()
        now_distance, now_turning = self._driven()
        return CleanRecord(
            result,
            np.concatenate(self.rows) if self.rows else np.zeros((0, 4)),
            self.truth,
            int(self.simulator.numbers["hits"] - hits),
            now_distance - distance,
            now_turning - turning,
            self.site.planning_time,
            self.site.plans,
        )

    def advance(self) -> None:
        """Let some ticks pass: many at once while nothing comes up, then one that looks around."""
        if self._loop.may_run():
            self._loop.run()
        elif self.mission.state.phase is Phase.CHARGING and self.seen.battery.is_docked:
            self._stand()
        self.tick()

    def tick(self) -> None:
        """Let one tick pass, by the ordinary classes."""
        senses = self.senses()
        step = self.mission.tick(senses)
        command = self._command(senses, step.twist, step.looks_around)
        for _ in range(STEPS_PER_TICK):
            self.simulator.advance(command, STEP, 1)
        self._look()

    def _look(self) -> None:
        self.seen = self.simulator.observe()
        self._localize()
        pose = self.seen.pose
        self.truth.sweep(pose.x, pose.y)
        self.rows.append(np.array([[self.seen.time, pose.x, pose.y, pose.theta]]))

    def _stand(self) -> None:
        """Let time pass in which the robot stands at its station without an errand."""
        for _ in range(min(_MOST_LOOKS, self._longest_burst // _TICKS_PER_LOOK)):
            self.simulator.advance(STANDSTILL, STEP, STEPS_PER_TICK * _TICKS_PER_LOOK)
            self._look()

    def senses(self) -> Senses:
        """Return what the robot senses now."""
        return senses_of(self.seen, self.localizer.estimate)

    def _localize(self) -> None:
        seen = self.seen
        self.localizer.lift(seen.wheels.dropped_left and seen.wheels.dropped_right)
        self.localizer.move(seen.time, seen.odometry, seen.angular_velocity)
        if seen.scans != self._scans:
            self._scans = seen.scans
            ranges, estimate = self.simulator.ranges, self.localizer.estimate
            self.localizer.see(seen.time, ranges, self.lidar)
            if estimate.knowledge is Knowledge.KNOWN:
                self.things.see(ranges, self._beams, self.localizer.estimate.pose)

    def caught_up(self, scanned: float, way: float) -> None:
        """Take over after the compiled loop: ``way`` m were driven, the last scan was at a time, s.

        Without a scan that time is negative.
        """
        self.seen = seen = self.simulator.observe()
        self._scans = seen.scans
        self.localizer.resumed(seen.time, scanned, self.simulator.ranges, self.lidar)
        self.mission.caught_up(self.senses(), way)

    def _command(self, senses: Senses, twist: Twist, looks_around: bool) -> Twist:
        if looks_around:
            touches = senses.is_disturbed
            twist = self._search.tick(senses.now, self.localizer, touches) or twist
        return self._drive.command(self.seen, twist)

    def _driven(self) -> tuple[float, float]:
        numbers = self.simulator.numbers
        return numbers["distance"], numbers["turned"]

    @property
    def is_home(self) -> bool:
        """Whether it stands on its station."""
        return self.mission.state.phase is Phase.DOCKED
