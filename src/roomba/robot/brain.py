"""The brain: all of the robot but its body, put together.

No clock, no files, no ROS: it is ticked with what a body tells, and answers with what it wants of
that body. The body may be simulated, on a serial line, or played back.
"""

from __future__ import annotations

from typing import Final

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError
from roomba.geometry import Pose, Twist
from roomba.grid import OccupancyMap
from roomba.mission.exploring.look_around import SearchDrive
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission, MissionStep
from roomba.mission.phases.machine import Phase
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones
from roomba.perception.slam.mapper import Mapper
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.robot.command import Command
from roomba.robot.growing_map import GrowingMap
from roomba.robot.place import PlaceKeeper
from roomba.robot.readings import Readings, ScanReading, senses_of
from roomba.robot.safe_drive import SafeDrive

_BESIDE_SURFACES: Final = 0.3
"""m; what is farther from all that a growing map shows is a thing wherever it is seen."""


class Brain:
    """The brain of one robot, on a map that it is given or on one that it makes.

    Tick it 20 times a second (``robot.timing.tick``). Errands are given to its ``mission``, with
    :meth:`senses`; there is one as soon as there is a map: with the first scan at the latest.
    A program that looks at the robot between sensing and deciding calls :meth:`sense` and
    :meth:`decide` one after the other instead.
    """

    def __init__(
        self,
        known: OccupancyMap | MappingConfig,
        station: Pose,
        robot: RobotConfig,
        mission: MissionConfig,
        docking: DockingConfig,
        *,
        rooms: Rooms | None = None,
        zones: Zones | None = None,
        start: Pose | None = None,
        max_speed: float | None = None,
    ) -> None:
        """Begin at ``start``, map frame, or docked at ``station``.

        ``known`` is the map, or says how one is made. ``max_speed`` is the robot's top speed, m/s:
        by default the body's. Raises ConfigError for speeds that the robot cannot do.
        """
        mission.require_possible(robot.body)
        self.robot, self.config, self._docking = robot, mission, docking
        self._station, self._rooms, self._zones = station, rooms, zones
        self._max_speed = robot.body.max_speed if max_speed is None else max_speed
        self.localizer: Localizer | None = None
        self.mapper: Mapper | None = None
        self.growing: GrowingMap | None = None
        start, belief = start or station, (robot.localization, robot.gyro)
        if isinstance(known, MappingConfig):
            self.mapper = place = Mapper(known, *belief, start)
            self.growing = GrowingMap(place, robot.timing.map_period)
            self.keeper = PlaceKeeper(place, robot.timing)
        else:
            self.localizer = localizer = Localizer(
                known, *belief, robot.body.radius, start, stride=robot.scan_stride
            )
            self.keeper = PlaceKeeper(localizer, robot.timing)
        self._known = known
        self._search = SearchDrive(robot.body, robot.looking_around)
        self._drive = SafeDrive(robot.body, self._max_speed)
        self._mission: Mission | None = None
        self._things: ThingLayer | None = None
        self._readings: Readings | None = None
        self._beams: tuple[LidarModel, LidarBeams] | None = None

    # ---------------------------------------------------------------- ticks

    def tick(self, readings: Readings) -> Command:
        """Take what the body tells, and return what is wanted of it."""
        self.sense(readings)
        return self.decide()

    def sense(self, readings: Readings) -> None:
        """Find out where the robot is, what stands in its way, and what its map is by now."""
        self._readings = readings
        self.look(self.keeper.follow(readings))
        self.use_newer_map()

    def decide(self) -> Command:
        """Return what is wanted: what the mission wants, as far as that is safe."""
        if self._mission is None:
            return Command()
        senses = self.senses()
        step = self._mission.tick(senses)
        self._finish_map(step)
        twist = self._drive.command(self.readings, self._looking_around(step, senses))
        return Command(twist, self._fan())

    def look(self, scan: ScanReading | None) -> None:
        """Look in a scan, if there is one, for things that the map does not show."""
        if scan is None or self._things is None:
            return
        estimate = self.keeper.place.estimate
        if estimate.knowledge is Knowledge.KNOWN:
            beams = self.beams_of(scan.lidar)
            self._things.see(scan.ranges, beams, estimate.pose, self.robot.scan_stride)

    def use_newer_map(self) -> None:
        """Begin a mission on the first map, or let it go on with a newer one."""
        if self._mission is None:
            self._begin()
        elif self.growing is not None:
            newer = self.growing.newer(self.readings.time, self._mission)
            if newer is not None:
                self._use(newer)

    def _begin(self) -> None:
        """Begin the mission, as soon as there is a map."""
        if not isinstance(self._known, MappingConfig):
            context = self._context(self._known)
        elif self.mapper is not None and self.mapper.version:
            context = self._context(self.mapper.occupancy())
        else:
            return
        self._mission = Mission(
            context,
            self.robot,
            self.config,
            self._docking,
            self._look_beside(context),
            DirtMap(context.occupancy),
            self.senses(),
            self._max_speed,
        )

    def _use(self, occupancy: OccupancyMap) -> None:
        """Let the mission go on with another map."""
        context = self._context(occupancy)
        self.mission.use_map(context, self._look_beside(context), DirtMap(occupancy))

    def _finish_map(self, step: MissionStep) -> None:
        """When all was seen go on with the whole map."""
        if step.wants_whole_map and self.growing is not None and not self.growing.is_whole:
            assert self.mapper is not None
            occupancy = self.growing.finish()
            # To be whole the map was turned a little.
            self._station = self.mapper.start
            self._use(occupancy)

    def _looking_around(self, step: MissionStep, senses: Senses) -> Twist:
        """Return what the mission wants, or what helps to find the place."""
        if not step.looks_around or self.localizer is None:
            return step.twist
        touches = senses.is_disturbed
        return self._search.tick(senses.now, self.localizer, touches) or step.twist

    def _fan(self) -> float | None:
        """Return the fan's duty that a clean asks for."""
        cleaning = self.mission.cleaning
        if cleaning is None or self.mission.state.phase is Phase.ERROR:
            return None
        return self.robot.fan.duty_at(cleaning.request.fan)

    # ---------------------------------------------------------------- what others may look at

    @property
    def mission(self) -> Mission:
        """What the robot is at; raises RoombaError while there is no map yet."""
        if self._mission is None:
            raise RoombaError("the robot has no map yet: let it stand until its first scan came")
        return self._mission

    @mission.setter
    def mission(self, mission: Mission) -> None:
        """Replace the mission by another one with the same map and the same layer of things."""
        self._mission = mission

    @property
    def is_ready(self) -> bool:
        """Whether there is a map, and so a mission."""
        return self._mission is not None

    @property
    def readings(self) -> Readings:
        """What the body told last; raises RoombaError before it told anything."""
        if self._readings is None:
            raise RoombaError("nothing was told to the robot yet: call sense() first")
        return self._readings

    @property
    def things(self) -> ThingLayer:
        """What stands about besides the map; raises RoombaError while there is no map yet."""
        if self._things is None:
            raise RoombaError("the robot has no map yet: let it stand until its first scan came")
        return self._things

    @property
    def pose(self) -> Pose:
        """Where it takes itself to be, map frame."""
        return self.keeper.place.estimate.pose

    def senses(self) -> Senses:
        """Return what the mission senses now."""
        return senses_of(self.readings, self.keeper.place.estimate)

    def limit_speed(self, max_speed: float) -> None:
        """Set the robot's top speed, m/s."""
        self._max_speed = max_speed
        self._drive.limit(max_speed)
        if self._mission is not None:
            self._mission.max_speed = max_speed

    def told(self, readings: Readings) -> None:
        """Take readings without acting on them.

        This is for steady ticks that compiled code computed on the parts' own arrays, and for
        readings after which no time passed.
        """
        self._readings = readings

    # ---------------------------------------------------------------- parts

    def beams_of(self, lidar: LidarModel) -> LidarBeams:
        """Return a lidar as kernels know it, made anew only when it is another one."""
        if self._beams is None or self._beams[0] is not lidar:
            self._beams = lidar, lidar.arrays()
        return self._beams[1]

    def _context(self, occupancy: OccupancyMap) -> PlanningContext:
        is_growing = self.growing is not None and not self.growing.is_whole
        parts = self._station, self.robot, self.config, self._docking
        return PlanningContext(occupancy, *parts, self._rooms, self._zones, is_growing=is_growing)

    def _look_beside(self, context: PlanningContext) -> ThingLayer:
        """Look from now on for what a planning context's map does not show."""
        if self.localizer is not None:
            field = self.localizer.field
        else:
            field = SurfaceField.near(context.occupancy, _BESIDE_SURFACES)
        self._things = ThingLayer(field)
        return self._things
