"""A page's view and commands of a robot without a lidar."""

from __future__ import annotations

import itertools
import math
import threading
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

from roomba.bumping.brain import BumpingState
from roomba.clean_request import CleanRequest
from roomba.client import view
from roomba.client.protocol import (
    CleanReport,
    ErrandOutcome,
    RequestRefusedError,
    RobotUnavailableError,
)
from roomba.geometry import STANDSTILL, Pose
from roomba.headless.live.bumping.robot import BumpingRobot
from roomba.headless.live.bumping.view import BY_WHEELS, FeltLayers, home_of_bumping, view_of
from roomba.headless.live.held_stop import HeldStop
from roomba.headless.live.robot import LiveRobot
from roomba.headless.live.without_map import WithoutMap
from roomba.vocabulary import CleanMode

_NO_MAP = "it has no lidar, so it makes no map: it sweeps all that it bumps along"


class BumpingClient(WithoutMap):
    """Observes and commands one robot; its methods may be called from any thread."""

    no_map = _NO_MAP

    def __init__(self, name: str, robot: BumpingRobot, speed: float = 1.0) -> None:
        """Start nothing yet; ``name`` is that of the home, ``speed`` as of :class:`LiveRobot`."""
        self._name, self._robot = name, robot
        self._live = LiveRobot(robot, speed, self._observe)
        self._lock = threading.Lock()
        self._versions, self._layers = itertools.count(1), FeltLayers()
        self._view: view.RobotView | None = None
        self._home: view.HomeView | None = None
        self._home_of: Pose | None = None
        self._last: CleanReport | None = None
        self._clean: _CleanUnderWay | None = None
        self._stop = HeldStop(self._put, _hold, _release)
        body = robot.robot_config.body
        self._top_speed = body.max_speed
        self._limits = view.PageLimits(
            body.max_speed,
            body.max_angular_speed,
            most_passes=1,
            most_zones=0,
            each_room=False,
            explores=False,
            modes=(CleanMode.WHOLE.value,),
        )

    def keep_stop(self, folder: Path) -> None:
        """Keep the emergency stop in ``folder``, and hold the drive if it was held before.

        To be called before :meth:`start`.
        """
        self._stop.keep_in(folder, self._name, self._robot)

    def start(self) -> None:
        """Let the robot live."""
        self._live.start()

    def end(self) -> None:
        """Stop the robot's time."""
        self._live.stop()

    @property
    def bin_capacity(self) -> float:
        """What its dust bin takes, g."""
        return self._robot.robot_config.brush.bin_capacity

    @property
    def ending(self) -> str:
        """Why the robot's time has stopped; empty while it passes."""
        return self._live.ending

    def limits(self) -> view.PageLimits:
        """Return what may be asked for."""
        return self._limits

    def robot(self) -> view.RobotView:
        """Return the newest state."""
        if self.ending:
            raise RobotUnavailableError(f"{self.ending}; start it again")
        if self._view is None:
            raise RobotUnavailableError("the robot has not begun to live yet")
        return self._view

    def home(self) -> view.HomeView:
        """Return what seldom changes."""
        if self._home is None:
            raise RobotUnavailableError("the robot has not begun to live yet")
        return self._home

    def layer(self, name: view.LayerName) -> view.GridLayer | None:
        """Return a layer as it is now."""
        with self._lock:
            return self._layers.layer(self._robot.brain.floor, name)

    def clean(self, request: CleanRequest) -> None:
        """Begin to sweep; it ends when the battery is low, or when it is told to go home."""
        if request.mode is not CleanMode.WHOLE:
            raise RequestRefusedError(_NO_MAP)

        def begin(robot: BumpingRobot) -> None:
            self._require_free(robot)
            robot.brain.clean()
            self._clean = _CleanUnderWay(robot)

        self._obey(begin)

    def dock(self) -> None:
        """Go to the charging station."""

        def dock(robot: BumpingRobot) -> None:
            self._require_free(robot)
            robot.brain.dock()

        self._obey(dock)

    def pause(self) -> None:
        """Stand until told to go on."""
        self._obey(lambda robot: robot.brain.pause())

    def resume(self) -> None:
        """Go on."""
        self._obey(lambda robot: robot.brain.resume())

    def stop(self) -> None:
        """End what it does, and stay."""
        self._obey(lambda robot: robot.brain.stop())

    def locate(self) -> None:
        """Beep."""
        self._obey(lambda robot: robot.body.locate())

    def empty_bin(self) -> None:
        """Do nothing: the robot does not know how full its bin is; the household keeps count."""

    def emergency_stop(self, reason: str) -> None:
        """Hold the drive until it is released.

        If the disk cannot keep the stop, the reason of the hold says so. Raises
        RobotUnavailableError if the robot does not answer in time: it holds as soon as it does.
        """
        self._live.drive(STANDSTILL)
        self._stop.engage(reason)

    def release(self) -> None:
        """Release the emergency stop; raises RequestRefusedError also if the next start holds."""
        self._stop.release()

    def drive(self, linear: float, angular: float) -> None:
        """Drive by hand; refused while the emergency stop holds, or the robot drives by itself."""
        state = self._robot.brain.state
        if state.drives or state is BumpingState.EMERGENCY:
            raise RequestRefusedError(f"the robot is {state.value}; stop it to drive by hand")
        self._live.drive(self._limits.clamped(linear, angular))

    def set_top_speed(self, speed: float) -> None:
        """Set how fast it may drive, m/s."""
        self._limits.require_speed(speed)
        self._top_speed = speed
        self._obey(lambda robot: robot.brain.limit_speed(speed))

    def go_to(self, x: float, y: float) -> None:
        """Refuse it: the robot does not know its pose."""
        raise RequestRefusedError(BY_WHEELS)

    def _require_free(self, robot: BumpingRobot) -> None:
        """Refuse what would drive as soon as the emergency stop is released."""
        if robot.brain.state is BumpingState.EMERGENCY:
            raise RequestRefusedError(
                f"the emergency stop holds the drive ({self._stop.reason}); release it first"
            )

    def _obey(self, command: Callable[[BumpingRobot], None]) -> None:
        self._live.carry_out(self._observed(command))

    def _put(self, command: Callable[[BumpingRobot], None]) -> Future[None]:
        """Let the robot obey when the command's turn comes; do not wait."""
        return self._live.put(self._observed(command))

    def _observed(self, command: Callable[[BumpingRobot], None]) -> Callable[[BumpingRobot], None]:
        """Return a command that takes snapshots after the given one."""

        def obey(robot: BumpingRobot) -> None:
            command(robot)
            self._observe(robot)

        return obey

    def _observe(self, robot: BumpingRobot) -> None:
        """Take snapshots after a frame, or a command."""
        if self._clean is not None:
            self._last, self._clean = self._clean.look(robot, self._last)
        self._view = view_of(robot, self._last, self._top_speed, self._stop.reason)
        if self._home is None or self._home_of is not robot.brain.station:
            self._home_of = robot.brain.station
            self._home = home_of_bumping(next(self._versions), self._name, robot)


def _hold(robot: BumpingRobot, _reason: str) -> None:
    robot.brain.hold()


def _release(robot: BumpingRobot) -> None:
    robot.brain.release()


class _CleanUnderWay:
    """Counts one clean, which ends on the station or where the robot was stopped."""

    def __init__(self, robot: BumpingRobot) -> None:
        """Begin."""
        self._began, self._way, self._at = robot.now.time, 0.0, robot.now.odometry

    def look(
        self, robot: BumpingRobot, last: CleanReport | None
    ) -> tuple[CleanReport | None, _CleanUnderWay | None]:
        """Follow the clean; return the last report, and this object unless the clean ended."""
        now, state = robot.now, robot.brain.state
        self._way += self._at.distance_to(now.odometry.x, now.odometry.y)
        self._at = now.odometry
        if state not in (BumpingState.DOCKED, BumpingState.STANDING):
            return last, self
        is_home = state is BumpingState.DOCKED
        outcome = ErrandOutcome.COMPLETED if is_home else ErrandOutcome.STOPPED
        swept = robot.brain.floor.coverage.swept_area
        took = now.time - self._began
        report = CleanReport(outcome, BY_WHEELS, swept, swept, math.nan, self._way, took, math.nan)
        return report, None
