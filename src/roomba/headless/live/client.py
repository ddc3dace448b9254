"""A page's view and commands of a live headless robot."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from typing import Final, TypeVar

from roomba.client.protocol import CleanReport, RequestRefusedError, RobotUnavailableError
from roomba.client.view import (
    MOST_ZONES,
    CleanOrder,
    GridLayer,
    HomeView,
    LayerName,
    PageLimits,
    Point,
    RobotView,
    ZoneView,
)
from roomba.errors import RoombaError
from roomba.geometry import Pose, Twist
from roomba.headless.cleaner import HeadlessMission
from roomba.headless.live.robot import LiveRobot
from roomba.headless.live.views import (
    clean_report,
    dirt_layer,
    exploration_report,
    home_view,
    map_cells,
    robot_view,
)
from roomba.headless.live.visits import Visits
from roomba.mission.cleaning.request import CleanRequest
from roomba.mission.phases.machine import Event, Phase
from roomba.perception.rooms.rooms import Rooms, segment
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.vocabulary import CleanMode, FanLevel
from roomba.world.home.home import Home

_SPILL: Final = (0.25, 6.0)
"""m and g of a heap of dirt."""

_Value = TypeVar("_Value")


class LiveClient:
    """Observes and commands one headless robot; its methods may be called from any thread."""

    def __init__(
        self,
        home: Home,
        robot: HeadlessMission,
        rooms: Rooms | None,
        speed: float,
    ) -> None:
        """Start nothing yet."""
        self._home = home
        self._rooms, self._zones = rooms, Zones()
        self._lock = threading.Lock()
        self._versions = itertools.count(1)
        self._live = LiveRobot(robot, speed, self._observe)
        self._view: RobotView | None = None
        self._home_view: HomeView | None = None
        self._last: CleanReport | None = None
        self._map: GridLayer | None = None
        self._map_of: object = None
        self._visits = Visits(robot.mission.context.occupancy.frame, robot.robot.brush.width)
        self._shape = 0
        self._limits = PageLimits(
            max_speed=robot.robot.body.max_speed,
            max_angular_speed=robot.robot.body.max_angular_speed,
        )

    def start(self) -> None:
        """Let the robot live."""
        self._live.start()

    def end(self) -> None:
        """Let its time stop."""
        self._live.stop()

    # ---------------------------------------------------------------- what a page reads

    def limits(self) -> PageLimits:
        """Return what may be asked for."""
        return self._limits

    def robot(self) -> RobotView:
        """Return the newest state."""
        if self._view is None:
            raise RobotUnavailableError("the robot has not begun to live yet")
        return self._view

    def home(self) -> HomeView:
        """Return what seldom changes."""
        if self._home_view is None:
            raise RobotUnavailableError("the robot has not begun to live yet")
        return self._home_view

    def layer(self, name: LayerName) -> GridLayer | None:
        """Return a copy of a layer as it is now."""
        with self._lock:
            if name is LayerName.MAP:
                return self._map
            if name is LayerName.COVERAGE:
                frame = self._visits.frame
                return GridLayer(
                    self._shape,
                    frame.resolution,
                    frame.origin_x,
                    frame.origin_y,
                    self._visits.counts.copy(),
                )
        shape = self._shape
        return self._live.carry_out(lambda robot: dirt_layer(robot.dirt, shape))

    # ---------------------------------------------------------------- commands

    def clean(self, order: CleanOrder) -> None:
        """Begin a clean."""
        request = _request_of(order)

        def begin(robot: HeadlessMission) -> None:
            robot.mission.clean(request, robot.senses())
            with self._lock:
                self._visits.clear()

        self._obey(begin)

    def explore(self) -> None:
        """Begin to look at what the map does not show yet."""

        def begin(robot: HeadlessMission) -> None:
            if robot.brain.mapper is None:
                raise RequestRefusedError(
                    "the robot was given a map of this home, so there is nothing to explore; "
                    "start it with --map none"
                )
            robot.mission.explore(robot.senses())

        self._obey(begin)

    def go_to(self, x: float, y: float) -> None:
        """Walk to a point; an errand under way is paused."""
        self._obey(lambda robot: _ignored(robot.brain.walk(x, y)))

    def dock(self) -> None:
        """Go to the charging station."""
        self._command(Event.DOCK)

    def pause(self) -> None:
        """Stand until told to go on."""
        self._command(Event.PAUSE)

    def resume(self) -> None:
        """Go on."""
        self._command(Event.RESUME)

    def stop(self) -> None:
        """End the errand, or the walk, and stay."""

        def stop(robot: HeadlessMission) -> None:
            robot.brain.walking.end()
            robot.mission.command(Event.STOP, robot.senses())

        self._obey(stop)

    def locate(self) -> None:
        """Beep: a simulated robot has no speaker, the page shows it."""

    def empty_bin(self) -> None:
        """Empty the bin, and tell the robot."""

        def empty(robot: HeadlessMission) -> None:
            robot.simulator.empty_bin()
            robot.look()
            robot.mission.empty_bin(robot.senses())

        self._obey(empty)

    def emergency_stop(self, reason: str) -> None:
        """Hold the drive until it is released."""
        self._live.drive(Twist())
        self._command(Event.EMERGENCY, reason)

    def release(self) -> None:
        """Release the emergency stop."""
        self._command(Event.RELEASE)

    def drive(self, linear: float, angular: float) -> None:
        """Drive by hand; refused while the emergency stop holds, or an errand is under way."""
        phase = Phase(self.robot().vacuum.phase)
        if phase is Phase.EMERGENCY:
            raise RequestRefusedError("the emergency stop holds the drive; release it first")
        if phase not in (Phase.IDLE, Phase.DOCKED, Phase.PAUSED, Phase.ERROR):
            raise RequestRefusedError(f"the robot is {phase.value}; pause it to drive by hand")
        limits = self._limits
        self._live.drive(
            Twist(
                min(max(linear, -limits.max_speed), limits.max_speed),
                min(max(angular, -limits.max_angular_speed), limits.max_angular_speed),
            )
        )

    # ---------------------------------------------------------------- rooms and zones

    def put_zone(self, zone: ZoneView) -> None:
        """Add a zone, or replace the one of the same name."""
        if len(self._zones.all) >= MOST_ZONES and zone.name not in self._zones.names:
            raise RequestRefusedError(f"expected at most {MOST_ZONES} zones; remove one first")
        added = _made(lambda: Zone(zone.name, ZoneKind(zone.kind), zone.points))
        self._edit(lambda: (self._rooms, self._zones.with_zone(added)))

    def remove_zone(self, name: str) -> None:
        """Remove a zone."""
        self._edit(lambda: (self._rooms, self._zones.without(name)))

    def rename_room(self, name: str, new_name: str) -> None:
        """Give a room another name."""
        self._edit(lambda: (self._known_rooms.renamed(name, new_name), self._zones))

    def join_rooms(self, names: tuple[str, ...]) -> None:
        """Make rooms that touch one."""
        self._edit(lambda: (self._known_rooms.joined(*names), self._zones))

    def split_room(self, name: str, start: Point, end: Point) -> None:
        """Cut a room along a line."""
        self._edit(lambda: (self._known_rooms.split(name, start, end), self._zones))

    @property
    def _known_rooms(self) -> Rooms:
        if self._rooms is None:
            raise RequestRefusedError("there are no rooms yet: explore the home first")
        return self._rooms

    def _edit(self, change: Callable[[], tuple[Rooms | None, Zones]]) -> None:
        """Let the mission go on with other rooms and zones."""

        def use(robot: HeadlessMission) -> None:
            self._use(robot, *change())
            self._home_view = self._new_home_view(robot)

        self._obey(use)

    def _use(self, robot: HeadlessMission, rooms: Rooms | None, zones: Zones) -> None:
        robot.brain.use_rooms(rooms, zones)
        self._rooms, self._zones = rooms, zones

    # ---------------------------------------------------------------- to play with

    def spill_dirt(self, x: float, y: float) -> None:
        """Spill a heap of dirt."""
        self._obey(lambda robot: robot.simulator.spill(x, y, *_SPILL))

    def place_chair(self, x: float, y: float) -> None:
        """Put a chair where it stands in the way."""
        self._obey(lambda robot: robot.simulator.place_chair(Pose(x, y, 0.0)))

    # ---------------------------------------------------------------- in the robot's thread

    def _command(self, event: Event, reason: str = "") -> None:
        self._obey(lambda robot: robot.mission.command(event, robot.senses(), reason))

    def _obey(self, command: Callable[[HeadlessMission], None]) -> None:
        """Let the robot obey; what it refuses is RequestRefusedError with its reason."""

        def obey(robot: HeadlessMission) -> None:
            command(robot)
            self._take_results(robot)
            self._look(robot)

        try:
            self._live.carry_out(obey)
        except (RobotUnavailableError, RequestRefusedError):
            raise
        except (RoombaError, ValueError) as refusal:
            raise RequestRefusedError(str(refusal)) from refusal

    def _observe(self, robot: HeadlessMission) -> None:
        """Take snapshots after a frame."""
        self._follow_sweeps(robot)
        self._take_results(robot)
        self._look(robot)

    def _look(self, robot: HeadlessMission) -> None:
        if self._home_view is None:
            self._home_view = self._new_home_view(robot)
        self._follow_map(robot)
        self._view = robot_view(robot, self._last)

    def _follow_sweeps(self, robot: HeadlessMission) -> None:
        """Count what was swept during the frame."""
        with self._lock:
            if not robot.mission.sweeps:
                self._visits.lift()
                return
            for row in robot.passed[::2]:
                self._visits.sweep(float(row[0]), float(row[4]), float(row[5]))
            pose = robot.brain.pose
            self._visits.sweep(robot.seen.time, pose.x, pose.y)

    def _take_results(self, robot: HeadlessMission) -> None:
        clean = robot.mission.take_result()
        if clean is not None:
            self._last = clean_report(clean)
        exploration = robot.mission.take_exploration()
        if exploration is not None:
            self._last = exploration_report(exploration)
            robot.brain.finish_map()

    def _follow_map(self, robot: HeadlessMission) -> None:
        """Take over a map that has changed."""
        occupancy = robot.mission.context.occupancy
        if self._map_of is occupancy:
            return
        self._map_of = occupancy
        with self._lock:
            if self._map is None or self._map.cells.shape != occupancy.frame.shape:
                self._shape += 1
                self._visits = Visits(occupancy.frame, robot.robot.brush.width)
            frame = occupancy.frame
            self._map = GridLayer(
                self._shape,
                frame.resolution,
                frame.origin_x,
                frame.origin_y,
                map_cells(occupancy),
            )
        self._find_rooms(robot)
        self._home_view = self._new_home_view(robot)

    def _find_rooms(self, robot: HeadlessMission) -> None:
        """As soon as a map that was made is whole, find its rooms."""
        growing = robot.brain.growing
        if growing is not None and growing.is_whole and self._rooms is None:
            rooms = segment(robot.mission.context.occupancy)
            if rooms.names:
                self._use(robot, rooms, self._zones)

    def _new_home_view(self, robot: HeadlessMission) -> HomeView:
        return home_view(next(self._versions), self._home, robot, self._rooms, self._zones)


def _request_of(order: CleanOrder) -> CleanRequest:
    """Return a request; raises RequestRefusedError."""
    return _made(
        lambda: CleanRequest(
            CleanMode(order.mode),
            order.rooms,
            order.zones,
            order.spot,
            order.passes,
            FanLevel[order.fan.upper()],
            order.in_order,
        )
    )


def _ignored(_: object) -> None:
    """Take a value that is not needed."""


def _made(make: Callable[[], _Value]) -> _Value:
    try:
        return make()
    except (RoombaError, ValueError, KeyError) as refusal:
        raise RequestRefusedError(str(refusal)) from refusal
