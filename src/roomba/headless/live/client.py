"""A page's view and commands of a live robot."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from roomba.clean_request import CleanRequest
from roomba.client import view
from roomba.client.observed import SPILL, TickTimes
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.configuration.mapping import FloorsConfig
from roomba.errors import RoombaError, RoomsError
from roomba.geometry import STANDSTILL, Point, Pose
from roomba.headless.embodied import Embodied
from roomba.headless.live import playing
from roomba.headless.live.errands import begin_exploring
from roomba.headless.live.floor_plan import FloorPlan
from roomba.headless.live.held_stop import HeldStop
from roomba.headless.live.kept_floor_plan import KeptFloorPlan
from roomba.headless.live.live_home import LiveHome
from roomba.headless.live.robot import LiveRobot
from roomba.headless.live.snapshots import ErrandsEnded, Snapshots
from roomba.mission.phases.machine import Event
from roomba.perception.floors.recognition import FloorRecord
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones
from roomba.vocabulary import Phase, RoomWay
from roomba.world.simulator import Simulator

_Answer = TypeVar("_Answer")
Watcher = Callable[[Embodied, ErrandsEnded], None]
"""A callback that is given the robot, and the errands that ended since its last call."""


class LiveClient:
    """Observes and commands one live robot; its methods may be called from any thread."""

    def __init__(
        self,
        live_home: LiveHome,
        robot: Embodied,
        rooms: Rooms | None,
        speed: float,
        zones: Zones | None = None,
    ) -> None:
        """Start nothing yet; ``rooms`` and ``zones`` are those that the robot goes by."""
        self._live_home, self._robot = live_home, robot
        plan = FloorPlan(rooms, Zones() if zones is None else zones)
        self._snapshots = Snapshots(robot, plan, live_home)
        self._live = LiveRobot(robot, speed, self._observe)
        self._watchers: list[Watcher] = []
        self._stop = HeldStop(self._put, _hold, _release)
        self._kept_plan: KeptFloorPlan | None = None
        body = robot.robot_config.body
        has_camera = live_home.camera is not None
        self._bin_capacity = robot.robot_config.brush.bin_capacity
        self._limits = view.PageLimits(
            body.max_speed,
            body.max_angular_speed,
            camera_angles=view.camera_angles(robot.robot_config.camera.max_pan)
            if has_camera
            else (),
            play=live_home.acts,
        )

    def keep_stop(self, folder: Path) -> None:
        """Keep the emergency stop in ``folder``, and hold the drive if it was held before.

        To be called before :meth:`start`.
        """
        self._stop.keep_in(folder, self._live_home.name, self._robot)

    def keep_plan(self, folder: Path, config: FloorsConfig, tell: Callable[[str], object]) -> None:
        """Keep rooms and zones of the map in ``folder``, and go on with those kept before.

        To be called before :meth:`start`, of a robot that knows its map. ``config`` says when
        another map shows the same floor, ``tell`` is told in a sentence what could not be read.
        Raises ZonesError for zones that cannot be read.
        """
        context = self._robot.mission.context
        floor = FloorRecord(context.occupancy, context.station)
        self._kept_plan = KeptFloorPlan(folder, floor, config, tell)
        self._snapshots.use(self._robot, self._kept_plan.load(self.plan))

    def start(self) -> None:
        """Let the robot live."""
        self._live.start()

    def end(self) -> None:
        """Stop the robot's time."""
        self._live.stop()

    @property
    def plan(self) -> FloorPlan:
        """The rooms and zones that the robot goes by."""
        return self._snapshots.plan

    def watch(self, watcher: Watcher) -> None:
        """Let ``watcher`` be called in the robot's thread, after each frame and each command."""
        self._watchers.append(watcher)

    def ask(self, question: Callable[[Embodied], _Answer], timeout: float = 5.0) -> _Answer:
        """Let the robot's thread answer a question, within ``timeout`` s of wall time.

        Raises RequestRefusedError with the reason, RobotUnavailableError.
        """
        with _refusals():
            return self._live.carry_out(question, timeout)

    def obey(self, command: Callable[[Embodied], None]) -> None:
        """Let the robot obey; raises RequestRefusedError with the robot's reason if it refuses."""
        self.ask(lambda robot: self._obey(robot, command))

    def _put(self, command: Callable[[Embodied], None]) -> Future[None]:
        """Let the robot obey, as :meth:`obey` does, when the command's turn comes; do not wait."""
        return self._live.put(lambda robot: self._obey(robot, command))

    def _obey(self, robot: Embodied, command: Callable[[Embodied], None]) -> None:
        with _refusals():
            command(robot)
        self._snapshots.look(robot)
        self._tell(robot)

    @property
    def bin_capacity(self) -> float:
        """What its dust bin takes, g."""
        return self._bin_capacity

    @property
    def speed(self) -> float:
        """The robot's seconds per second of the wall clock, if the machine keeps up."""
        return self._live.speed

    @property
    def ending(self) -> str:
        """Why the robot's time has stopped; empty while it passes."""
        return self._live.ending

    def tick_times(self) -> TickTimes:
        """Return how long the robot's ticks took to compute."""
        return self._live.tick_times()

    def limits(self) -> view.PageLimits:
        """Return what may be asked for."""
        return self._limits

    def robot(self) -> view.RobotView:
        """Return the newest state."""
        if self.ending:
            raise RobotUnavailableError(f"{self.ending}; start it again")
        return self._snapshots.robot()

    def home(self) -> view.HomeView:
        """Return what seldom changes."""
        return self._snapshots.home()

    def layer(self, name: view.LayerName) -> view.GridLayer | None:
        """Return a copy of a layer as it is now."""
        if name is view.LayerName.MAP:
            return self._snapshots.map()
        if name is view.LayerName.COVERAGE:
            return self._snapshots.coverage()
        if name is view.LayerName.TRUE_DIRT:
            return self._live.carry_out(lambda _: self._live_home.dirt())
        return self._live.carry_out(self._snapshots.dirt)

    def picture(self, degrees: float) -> NDArray[np.uint8]:
        """Return what the camera sees at an angle to the left, uint8 [height, width, 3] RGB."""
        camera = self._live_home.camera
        if camera is None:
            raise RequestRefusedError("this robot has no camera")
        return camera.picture(self._live.carry_out, degrees)

    def clean(self, request: CleanRequest) -> None:
        """Begin a clean."""

        def begin(robot: Embodied) -> None:
            robot.mission.clean(request, robot.senses())
            self._snapshots.begin_coverage()

        self.obey(begin)

    def change_rooms(self, rooms: tuple[str, ...], each: tuple[RoomWay, ...] = ()) -> None:
        """Let the clean of rooms under way go on with these."""
        self.obey(lambda robot: robot.mission.change_rooms(rooms, each))

    def explore(self) -> None:
        """Begin to look at what the map does not show yet."""
        self.obey(begin_exploring)

    def go_to(self, x: float, y: float) -> None:
        """Walk to a point; an errand under way is paused."""

        def walk(robot: Embodied) -> None:
            robot.brain.walk(x, y)

        self.obey(walk)

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

        def stop(robot: Embodied) -> None:
            robot.brain.walking.end()
            robot.mission.command(Event.STOP, robot.senses())

        self.obey(stop)

    def locate(self) -> None:
        """Beep; the page shows it as well."""
        self.obey(lambda robot: robot.body.locate())

    def empty_bin(self) -> None:
        """Empty the bin, and tell the robot."""

        def empty(robot: Embodied) -> None:
            self._live_home.empty_bin()
            robot.mission.command(Event.EMPTIED, robot.senses())

        self.obey(empty)

    def empty_at_station(self) -> None:
        """Let its station empty its bin."""
        self.obey(lambda robot: robot.mission.command(Event.EMPTY, robot.senses()))

    def replace_bag(self) -> None:
        """Put an empty bag into its simulated station."""
        self._play(playing.replace_bag)

    def emergency_stop(self, reason: str) -> None:
        """Hold the drive until it is released; a walk ends, even if the release comes at once.

        If the disk cannot keep the stop, the reason of the hold says so. Raises
        RobotUnavailableError if the robot does not answer in time: it holds as soon as it does.
        """
        self._live.drive(STANDSTILL)
        self._stop.engage(reason)

    def release(self) -> None:
        """Release the emergency stop; raises RequestRefusedError also if the next start holds."""
        self._stop.release()

    def drive(self, linear: float, angular: float) -> None:
        """Drive by hand; refused while the emergency stop holds, or an errand is under way."""
        phase = Phase(self.robot().vacuum.phase)
        if phase is Phase.EMERGENCY:
            raise RequestRefusedError("the emergency stop holds the drive; release it first")
        if phase not in (Phase.IDLE, Phase.DOCKED, Phase.PAUSED, Phase.ERROR):
            raise RequestRefusedError(f"the robot is {phase.value}; pause it to drive by hand")
        self._live.drive(self._limits.clamped(linear, angular))

    def set_top_speed(self, speed: float) -> None:
        """Set how fast it may drive, m/s."""
        self._limits.require_speed(speed)
        self.obey(lambda robot: robot.brain.limit_speed(speed))

    def put_zone(self, zone: view.ZoneView) -> None:
        """Add a zone, or replace the one of the same name."""
        self._edit(lambda plan: plan.with_zone(zone))

    def remove_zone(self, name: str) -> None:
        """Remove a zone."""
        self._edit(lambda plan: plan.without_zone(name))

    def ignore_low_thing(self, x: float, y: float) -> None:
        """Stop offering a zone for the low thing that was felt there."""

        def ignore(robot: Embodied) -> None:
            obstacles = robot.mission.obstacles
            obstacles.low = obstacles.low.ignoring(x, y)

        self.obey(ignore)

    def rename_room(self, name: str, new_name: str) -> None:
        """Give a room another name."""
        self._edit(lambda plan: plan.with_name(name, new_name))

    def join_rooms(self, names: tuple[str, ...]) -> None:
        """Make rooms that touch one."""
        self._edit(lambda plan: plan.with_joined(names))

    def split_room(self, name: str, start: Point, end: Point) -> None:
        """Cut a room along a line."""
        self._edit(lambda plan: plan.with_cut(name, start, end))

    def undo_rooms(self) -> None:
        """Take back the newest edit of the rooms."""
        self._edit(lambda plan: plan.as_before())

    def _edit(self, change: Callable[[FloorPlan], FloorPlan]) -> None:
        """Let the mission go on with changed rooms and zones, once these are on the disk."""

        def edit(robot: Embodied) -> None:
            plan = change(self.plan)
            self._keep(plan)
            self._snapshots.use(robot, plan)

        self.obey(edit)

    def _keep(self, plan: FloorPlan) -> None:
        """Keep a changed plan; raises RequestRefusedError if it cannot be kept."""
        if self._kept_plan is None:
            return
        try:
            self._kept_plan.save(self.plan, plan)
        except (OSError, RoomsError) as error:
            raise RequestRefusedError(
                f"rooms and zones cannot be kept: {error}; nothing was changed"
            ) from error

    def spill_dirt(self, x: float, y: float) -> None:
        """Spill a heap of dirt."""
        self._play(lambda simulator: simulator.spill(x, y, *SPILL))

    def place_chair(self, x: float, y: float) -> None:
        """Put a chair where it stands in the way."""
        self._play(lambda simulator: simulator.place_chair(Pose(x, y, 0.0)))

    def block_station(self) -> None:
        """Put a box before the station."""
        self._play(playing.block_station)

    def clear_away(self) -> None:
        """Take away all that was put down."""
        self._play(lambda simulator: simulator.remove_obstacles())

    def set_door(self, name: str, *, is_shut: bool) -> None:
        """Shut or open a door; it shuts as soon as the robot is out of its way."""
        self._play(lambda simulator: simulator.set_door(name, is_shut=is_shut))

    def lift(self) -> None:
        """Lift the robot: its wheels hang."""
        self._play(playing.lift)

    def put_down(self, x: float, y: float, theta: float) -> None:
        """Put the robot on the floor; refused where it does not fit."""
        self._play(lambda simulator: playing.put_down(simulator, Pose(x, y, theta)))

    def _play(self, act: Callable[[Simulator], None]) -> None:
        self.obey(lambda _: self._live_home.play(act))

    def _command(self, event: Event) -> None:
        self.obey(lambda robot: robot.mission.command(event, robot.senses()))

    def _observe(self, robot: Embodied) -> None:
        self._snapshots.observe(robot)
        self._tell(robot)

    def _tell(self, robot: Embodied) -> None:
        for watcher in self._watchers:
            watcher(robot, self._snapshots.ended)


@contextmanager
def _refusals() -> Iterator[None]:
    """Turn the robot's refusals into RequestRefusedError."""
    try:
        yield
    except (RobotUnavailableError, RequestRefusedError):
        raise
    except (RoombaError, ValueError) as refusal:
        raise RequestRefusedError(str(refusal)) from refusal


def _hold(robot: Embodied, reason: str) -> None:
    """Hold the drive; a walk ends."""
    robot.brain.walking.end()
    robot.mission.command(Event.EMERGENCY, robot.senses(), reason)


def _release(robot: Embodied) -> None:
    robot.mission.command(Event.RELEASE, robot.senses())
