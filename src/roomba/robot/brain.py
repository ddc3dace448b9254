"""The brain: all of the robot but its body, put together.

No clock, no files, no ROS: it is ticked with what a body tells, and answers with what it wants of
that body. The body may be simulated, on a serial line, or played back.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Final

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.nodes import PlacingConfig
from roomba.configuration.robot import RobotConfig
from roomba.control.speed_loop import Hazards, SpeedLoop
from roomba.errors import RoombaError
from roomba.geometry import STANDSTILL, Pose, Twist, old_in_new
from roomba.grid import OccupancyMap
from roomba.mission.commands import CommandRefusedError
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Errand, Event, next_state
from roomba.mission.walking.walk import Walk
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.floors.carry_over import moved
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones
from roomba.perception.slam.mapper import Mapper
from roomba.perception.things.layer import ThingLayer
from roomba.planning.coverage.planner import UNWATCHED
from roomba.planning.coverage.stages import OUR_STAGES, CoverageStages
from roomba.planning.path.polyline import Path
from roomba.robot.command import Command
from roomba.robot.growing_map import GrowingMap
from roomba.robot.mapped_mission import MappedMission, fan_of
from roomba.robot.place import Place, PlaceKeeper
from roomba.robot.readings import Readings, senses_of
from roomba.robot.walking import Walking
from roomba.vocabulary import Phase

_BESIDE_SURFACES: Final = 0.3
"""m; what is seen farther than this from all surfaces of a growing map is a thing."""


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
        stages: CoverageStages = OUR_STAGES,
        plan_watch: AbstractContextManager[object] = UNWATCHED,
    ) -> None:
        """Begin at ``start``, map frame, or docked at ``station``.

        ``known`` is the map, or says how one is made. ``max_speed`` is the robot's top speed, m/s:
        by default the body's. ``stages`` are those of planning coverage. ``plan_watch`` is entered
        for each plan of coverage. Raises ConfigError for speeds that the robot cannot do.
        """
        mission.require_possible(robot.body)
        self.robot_config, self.config, self._docking = robot, mission, docking
        self._known, self._station, self._rooms, self._zones = known, station, rooms, zones
        self._stages, self._plan_watch = stages, plan_watch
        self._max_speed = robot.body.max_speed if max_speed is None else max_speed
        self.localizer: Localizer | None = None
        self.mapper: Mapper | None = None
        self.growing: GrowingMap | None = None
        self.keeper = PlaceKeeper(self._place(start or robot.body.docked_at(station)), robot)
        self.keeper.place.belief["calibration"]["base"] = robot.body.wheel_separation
        self._mapped = MappedMission(robot, mission, docking, self._max_speed)
        self.walking = Walking(robot)
        self._drive = SpeedLoop(robot.body, self._max_speed)
        self._readings: Readings | None = None

    def _place(self, start: Pose) -> Place:
        """Return the localizer or mapper that knows the robot's place, beginning at ``start``."""
        robot, belief = self.robot_config, (self.robot_config.localization, self.robot_config.gyro)
        if isinstance(self._known, MappingConfig):
            self.mapper = Mapper(self._known, *belief, start)
            self.growing = GrowingMap(self.mapper, robot.timing)
            return self.mapper
        self.localizer = Localizer(
            self._known, *belief, robot.body.radius, start, stride=robot.scan_stride
        )
        return self.localizer

    def tick(self, readings: Readings) -> Command:
        """Take what the body tells, and return what is wanted of it."""
        self.sense(readings)
        return self.decide()

    def sense(self, readings: Readings) -> None:
        """Find out where the robot is, what stands in its way, and what its map is by now."""
        self._readings = readings
        if self.keeper.follow(readings) is not None:
            self.look()
        self.use_newer_map()

    def decide(self) -> Command:
        """Return what is wanted: what walk or mission want, as far as that is safe."""
        mission = self._mapped.mission
        if mission is None:
            return Command()
        senses = self.senses()
        step = mission.tick(senses)
        if step.wants_whole_map:
            self.finish_map()
        if mission.state.drives or mission.state.phase is Phase.EMERGENCY:
            # The newer command counts: it ends the walk.
            self.walking.end()
        is_driving = mission.state.drives or step.twist != STANDSTILL
        wanted = step.twist if is_driving else None
        cruise, looks_around = self._max_speed, step.looks_around
        if self.walking.is_under_way:
            wanted, cruise = self.walking.tick(senses, self._max_speed)
            looks_around = True
        if looks_around:
            wanted = self.keeper.look_around(senses.now, touches=any(senses.touches)) or wanted
        level = fan_of(mission)
        fan = None if level is None else self.robot_config.fan.duty_at(level)
        return Command(self._safely(wanted, cruise), fan, empties=step.empties)

    def steer(self, twist: Twist) -> Command:
        """Return what is wanted when the robot is steered by hand, as far as that is safe."""
        return Command(self._safely(twist, self._max_speed))

    def walk(self, x: float, y: float) -> Walk:
        """Walk to a point of the map, m; an errand under way is paused.

        Raises NoPathError when there is no way, CommandRefusedError while the emergency stop holds,
        RoombaError while there is no map.
        """
        mission, senses = self.mission, self.senses()
        if mission.state.phase is Phase.EMERGENCY:
            raise CommandRefusedError(
                f"the emergency stop holds the drive ({mission.message}); release it first"
            )
        if mission.state.errand is Errand.NONE:
            mission.obstacles.begin_errand()
        walk = self.walking.begin((x, y), mission.context.occupancy, mission.obstacles, senses)
        if next_state(mission.state, Event.PAUSE) is not None:
            mission.command(Event.PAUSE, senses)
        return walk

    def way_to(self, x: float, y: float) -> Path:
        """Return the way that a walk to a point of the map, m, would begin with.

        Raises NoPathError when there is none, RoombaError while there is no map.
        """
        mission, senses = self.mission, self.senses()
        home = mission.context.occupancy, mission.obstacles
        return self.walking.planned((x, y), *home, senses).path

    def look(self) -> None:
        """Look in the newest scan for things that the map does not show."""
        place = self.keeper.place
        here = place.estimate
        self._mapped.lookout.look(place.placed, here.knowledge, here.position_deviation)

    def use_newer_map(self) -> None:
        """Begin a mission on the first map, or let it go on with a newer one."""
        mission, newer = self._mapped.mission, None
        if self.growing is not None:
            newer = self.growing.newer(self.readings.time, mission)
        elif mission is None and isinstance(self._known, OccupancyMap):
            newer = self._known
        if newer is None:
            return
        if mission is None:
            self._begin(newer)
        else:
            self._use(newer)

    def use_rooms(self, rooms: Rooms | None, zones: Zones) -> None:
        """Go on with other rooms and zones; raises RoombaError while there is no map."""
        self._rooms, self._zones = rooms, zones
        self.mission.use_context(self._context(self.mission.context.occupancy))

    @property
    def zones(self) -> Zones:
        """The zones that it goes by, in the frame of its map."""
        return self._zones or Zones()

    def _begin(self, occupancy: OccupancyMap) -> None:
        """Begin the mission on the first map."""
        context = self._context(occupancy)
        self._mapped.begin(context, self._surfaces(context), self.senses())

    def _use(self, occupancy: OccupancyMap) -> None:
        """Let the mission go on with another map."""
        context = self._context(occupancy)
        self._mapped.go_on(context, self._surfaces(context))

    def finish_map(self) -> None:
        """Finish the map that is being made, and go on with it, by a localizer."""
        growing, mapper = self.growing, self.mapper
        if growing is None or mapper is None or growing.is_whole:
            return
        growing.is_whole = True
        occupancy = mapper.finish()
        # Finishing turned the map a little; the robot began docked, so the map's start is the
        # station.
        before, self._station = self._station, self.robot_config.body.docked_at(mapper.start)
        self._zones = moved(self.zones, old_in_new(before, self._station))
        self._localize_on(occupancy, mapper.pose)
        self._use(occupancy)

    def _localize_on(self, occupancy: OccupancyMap, here: Pose) -> None:
        """Let a localizer know the place from now on, which is ``here`` on its map."""
        robot, readings = self.robot_config, self.readings
        belief = robot.localization, robot.gyro, robot.body.radius, here
        localizer = Localizer(None, *belief, stride=robot.scan_stride)
        Calibration.of(self.keeper.place.belief).take_up(localizer.belief)
        localizer.move(readings.time, readings.odometry, readings.turning)
        localizer.go_on(occupancy, (here, PlacingConfig().on_finished))
        self.localizer = self.keeper.place = localizer

    def _safely(self, twist: Twist | None, cruise: float) -> Twist:
        """Return what the wheels get when a twist is wanted, at ``cruise`` m/s at most.

        Without a wanted twist (None), and under the emergency stop, the wheels stand still. The
        speed loop then does not back away from a cliff: a dirty sensor must not move a docked
        robot.
        """
        now, mission = self.readings.time, self._mapped.mission
        self._drive.emergency = mission is not None and mission.state.phase is Phase.EMERGENCY
        self._drive.set_hazards(self.readings.hazards)
        self._drive.set_cruise_speed(cruise)
        if twist is None:
            self._drive.forget_commands()
        else:
            self._drive.command(now, twist)
        return self._drive.tick(now)[0]

    @property
    def mission(self) -> Mission:
        """The robot's mission; raises RoombaError while there is no map yet."""
        if self._mapped.mission is None:
            raise RoombaError("the robot has no map yet: let it stand until its first scan came")
        return self._mapped.mission

    @mission.setter
    def mission(self, mission: Mission) -> None:
        """Replace the mission by another one with the same map and the same layer of things."""
        self._mapped.mission = mission

    @property
    def is_ready(self) -> bool:
        """Whether there is a map, and so a mission."""
        return self._mapped.mission is not None

    @property
    def readings(self) -> Readings:
        """What the body told last; raises RoombaError before it told anything."""
        if self._readings is None:
            raise RoombaError("nothing was told to the robot yet: call sense() first")
        return self._readings

    @property
    def things(self) -> ThingLayer:
        """What stands about besides the map; raises RoombaError while there is no map yet."""
        if self._mapped.lookout.things is None:
            raise RoombaError("the robot has no map yet: let it stand until its first scan came")
        return self._mapped.lookout.things

    @property
    def pose(self) -> Pose:
        """Where it takes itself to be, map frame."""
        return self.keeper.place.estimate.pose

    def senses(self) -> Senses:
        """Return what the mission senses now."""
        estimate = self.keeper.place.estimate
        return senses_of(
            self.readings,
            estimate.pose,
            estimate.knowledge,
            trouble=estimate.reason,
            unsure=estimate.position_deviation,
        )

    @property
    def max_speed(self) -> float:
        """The robot's top speed, m/s."""
        return self._max_speed

    def limit_speed(self, max_speed: float) -> None:
        """Set the robot's top speed, m/s."""
        self._max_speed = max_speed
        self._drive.set_max_speed(max_speed)
        self._mapped.limit_speed(max_speed)

    def told(self, readings: Readings) -> None:
        """Take readings without acting on them, when no time has passed since."""
        self._readings = readings

    def drove_on(self, readings: Readings) -> None:
        """Take the readings at the end of steady ticks, in which nothing held the drive.

        Compiled code computed these ticks on the parts' own arrays.
        """
        self._drive.set_hazards(Hazards())
        self._readings = readings

    def beams_of(self, lidar: LidarModel) -> LidarBeams:
        """Return a lidar in the form that compiled kernels take."""
        return self._mapped.lookout.beams_of(lidar)

    def _context(self, occupancy: OccupancyMap) -> PlanningContext:
        is_growing = self.growing is not None and not self.growing.is_whole
        parts = self._station, self.robot_config, self.config, self._docking
        return PlanningContext(
            occupancy,
            *parts,
            self._rooms,
            self._zones,
            is_growing=is_growing,
            stages=self._stages,
            plan_watch=self._plan_watch,
        )

    def _surfaces(self, context: PlanningContext) -> SurfaceField:
        """Return the surfaces beside which things are looked for."""
        if self.localizer is not None:
            return self.localizer.field
        return SurfaceField.near(context.occupancy, _BESIDE_SURFACES)
