"""The brain of a robot without a lidar: at each tick it takes readings and returns a command.

It stands in for the mission. It reads no clock and no files, and is given its random numbers.
"""

from __future__ import annotations

import math
from dataclasses import replace
from enum import Enum
from typing import Final

import numpy as np

from roomba.bumping.beam_approach import Approach, BeamApproach
from roomba.bumping.driven_floor import DrivenFloor
from roomba.bumping.felt_floor import FeltFloor
from roomba.bumping.sweeping import BumpAndGo, BumpMove
from roomba.bumping.wall_compass import WallCompass
from roomba.configuration.bumping import BumpingConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.robot import RobotConfig
from roomba.control.speed_loop import SpeedLoop
from roomba.geometry import STANDSTILL, Pose, Twist, wrap_angle
from roomba.mission.inputs.senses import Battery
from roomba.robot.command import Command
from roomba.robot.readings import Readings


class BumpingState(Enum):
    """What the robot is doing."""

    DOCKED = "on its station"
    LEAVING = "leaving its station"
    SWEEPING = "sweeping"
    HOMING = "looking for its station"
    DOCKING = "driving onto its station"
    STANDING = "standing"
    PAUSED = "paused"
    HELD = "held: it touches something wherever it turns; set it free"
    EMERGENCY = "emergency stop"

    @property
    def drives(self) -> bool:
        """Whether the robot moves by itself."""
        return self in _DRIVES


_HOMEWARD: Final = frozenset({BumpingState.HOMING, BumpingState.DOCKING})
"""States whose aim is the station."""
_DRIVES: Final = frozenset({BumpingState.LEAVING, BumpingState.SWEEPING, *_HOMEWARD})
_WAITS: Final = frozenset({BumpingState.PAUSED, BumpingState.HELD})
"""States in which the robot can be told to go on."""


class BumpingBrain:
    """Sweeps by bump and go until the battery is low or it is told to go home.

    ``state`` is what the robot is doing; ``floor`` what odometry says was swept; ``station`` the
    pose of the docked robot in the frame of the odometry, or None if it was never docked.
    """

    def __init__(
        self,
        robot: RobotConfig,
        config: BumpingConfig,
        docking: DockingConfig,
        max_speed: float,
        rng: np.random.Generator,
    ) -> None:
        """Stand, until it is told to clean; ``max_speed``, m/s, is the fastest that it drives."""
        self.robot_config, self._config, self._docking_config, self._rng = (
            robot,
            config,
            docking,
            rng,
        )
        self.state = BumpingState.STANDING
        self.floor = FeltFloor(config, robot.brush.width)
        self.compass = WallCompass(config)
        self._driven, self._led_at = DrivenFloor(config), -math.inf
        self.station: Pose | None = None
        self.readings: Readings | None = None
        self._drive = SpeedLoop(robot.body, max_speed)
        self._sweeping: BumpAndGo | None = None
        self._approach: BeamApproach | None = None
        self._paused: BumpingState | None = None
        self._blind_until = -math.inf
        self._reach = config.near_home
        self._homing_since: float | None = None
        self._left: tuple[Pose, float] | None = None

    def clean(self) -> None:
        """Sweep, from here or out of the station."""
        self.floor.forget()
        self._driven.forget()
        self._enter(BumpingState.LEAVING)

    def dock(self) -> None:
        """Go home; a robot that is on its station stays there."""
        if self.state is not BumpingState.DOCKED:
            self._enter(BumpingState.HOMING)

    def stop(self) -> None:
        """Stand still and drop what it was doing; an emergency stop stays in force."""
        if self.state is BumpingState.EMERGENCY:
            self._paused = None
        elif self.state.drives or self.state in _WAITS:
            self._enter(BumpingState.STANDING)

    def pause(self) -> None:
        """Stand until it is told to go on."""
        if self.state.drives:
            self._paused = self.state
            self._enter(BumpingState.PAUSED)

    def resume(self) -> None:
        """Go on after a pause or after being set free; leave the station before sweeping."""
        if self.state in _WAITS and self._paused is not None:
            is_docked = self.readings is not None and self.readings.battery.is_docked
            leaves = is_docked and self._paused is BumpingState.SWEEPING
            self._enter(BumpingState.LEAVING if leaves else self._paused)

    def hold(self) -> None:
        """Stand until the emergency stop is released; what the robot was doing is paused."""
        self._drive.emergency = True
        if self.state.drives:
            self._paused = self.state
        elif self.state not in (*_WAITS, BumpingState.EMERGENCY):
            self._paused = None
        self._enter(BumpingState.EMERGENCY)

    def release(self) -> None:
        """Release the emergency stop; it stands until it is told to go on."""
        self._drive.emergency = False
        if self.state is BumpingState.EMERGENCY:
            self._enter(BumpingState.STANDING if self._paused is None else BumpingState.PAUSED)

    def _enter(self, state: BumpingState) -> None:
        self.state = state
        self._sweeping = self._approach = self._left = None
        if state not in _HOMEWARD:
            self._homing_since, self._reach = None, self._config.near_home
        self.floor.coverage.lift()

    @property
    def move(self) -> BumpMove | None:
        """The move of a robot that sweeps or looks for its station; None otherwise."""
        return None if self._sweeping is None else self._sweeping.move

    def limit_speed(self, speed: float) -> None:
        """Set the fastest that it drives, m/s."""
        self._drive.set_max_speed(speed)

    def tick(self, readings: Readings) -> Command:
        """Take the readings of a tick; return the wanted command, as far as it is safe."""
        self.readings = readings = self._placed(readings)
        self._notice(readings)
        wanted = self._act(readings)
        sweeps = self.state in (BumpingState.SWEEPING, BumpingState.HOMING)
        if sweeps:
            self.floor.sweep(readings.odometry)
        if self.state.drives:
            self._driven.drive(readings.odometry)
        rests = None if sweeps else 0.0
        return Command(self._safely(wanted, readings), rests, rests)

    def steer(self, twist: Twist, readings: Readings) -> Command:
        """Return the command for a robot that is steered by hand, as far as it is safe."""
        self.readings = readings = self._placed(readings)
        return Command(self._safely(twist, readings), 0.0, 0.0)

    def _placed(self, readings: Readings) -> Readings:
        """Return the readings with the pose that the wall compass has corrected."""
        sweeping = self._sweeping
        is_along = sweeping is not None and sweeping.is_along(readings)
        self.compass.take(readings.odometry, is_along=is_along)
        return replace(readings, odometry=self.compass.pose)

    def _safely(self, wanted: Twist, readings: Readings) -> Twist:
        self._drive.set_hazards(readings.hazards)
        self._drive.command(readings.time, wanted)
        return self._drive.tick(readings.time)[0]

    def _notice(self, readings: Readings) -> None:
        """Change the state if the robot docked, was taken off, runs low, or is held."""
        if readings.battery.is_docked:
            self._remember_station(readings.odometry)
            is_done = self.state in _WAITS and self._paused in _HOMEWARD
            if is_done or self.state in (BumpingState.STANDING, BumpingState.HOMING):
                self._enter(BumpingState.DOCKED)
        elif self.state is BumpingState.DOCKED:
            self._enter(BumpingState.STANDING)
        if self.state is BumpingState.SWEEPING and self._is_low(readings.battery):
            self._enter(BumpingState.HOMING)
        if self._sweeping is not None and self._sweeping.is_held:
            self._paused = self.state
            self._enter(BumpingState.HELD)

    def _remember_station(self, pose: Pose) -> None:
        if self.station is None:
            self.station = pose
            self.compass.stand_square()
        elif self.state is not BumpingState.LEAVING:
            self.compass.stand_at(self.station)

    def _is_low(self, battery: Battery) -> bool:
        return battery.level < self._config.home_level

    def _act(self, readings: Readings) -> Twist:
        match self.state:
            case BumpingState.LEAVING:
                return self._leave(readings)
            case BumpingState.SWEEPING:
                self._sweeping = self._sweeping or self._bump_and_go(None)
                self._sweeping.wants_wall = self.compass.is_due
                return self._sweeping.tick(readings)
            case BumpingState.HOMING:
                return self._go_home(readings)
            case BumpingState.DOCKING:
                return self._dock(readings)
            case _:
                return STANDSTILL

    def _bump_and_go(
        self, goal: tuple[float, float] | None, *, stays_at_walls: bool = False
    ) -> BumpAndGo:
        parts = self._config, self.robot_config.body.radius, self.floor, self._rng, goal
        return BumpAndGo(*parts, stays_at_walls=stays_at_walls)

    def _leave(self, readings: Readings) -> Twist:
        """Back out of the station, and turn away from it."""
        pose, config = readings.odometry, self._docking_config
        if self._left is None:
            if not readings.battery.is_docked:
                self._enter(BumpingState.SWEEPING)
                return STANDSTILL
            turn = self._config.leaving_turn * float(self._rng.choice((-1.0, 1.0)))
            self._left = pose, wrap_angle(pose.theta + turn)
        began, heading = self._left
        if began.distance_to(pose.x, pose.y) < config.undock_distance:
            return Twist(-config.undock_speed, 0.0)
        wrong = wrap_angle(heading - pose.theta)
        if abs(wrong) <= self._config.aimed:
            self._enter(BumpingState.SWEEPING)
            return STANDSTILL
        return Twist(0.0, math.copysign(self._config.turning_speed, wrong))

    def _go_home(self, readings: Readings) -> Twist:
        """Go to where odometry says that the station is; look for its beams around there."""
        beams = readings.beams
        if beams.leads and readings.time >= self._blind_until:
            self._enter(BumpingState.DOCKING)
            return STANDSTILL
        self._homing_since = readings.time if self._homing_since is None else self._homing_since
        # Following walls leads past the station even where odometry is far off.
        looks = (readings.time - self._homing_since) % (2.0 * self._config.home_time)
        is_at_walls = self.station is None or looks > self._config.home_time
        if self._sweeping is None or is_at_walls is not (self._sweeping.goal is None):
            goal = None if is_at_walls else self._place_to_look()
            self._sweeping = self._bump_and_go(goal, stays_at_walls=is_at_walls)
        if not is_at_walls:
            self._sweeping.goal = self._next_on_the_way(readings, self._sweeping.goal)
        return self._sweeping.tick(readings)

    def _next_on_the_way(
        self, readings: Readings, goal: tuple[float, float] | None
    ) -> tuple[float, float] | None:
        """Return where to go: back over driven floor, then from place to place near the station."""
        if self.station is None:
            return None
        pose, now = readings.odometry, readings.time
        before = self._before_station(self.station)
        if pose.distance_to(before.x, before.y) > self._config.driven_ahead + self._reach:
            if now - self._led_at > self._config.driven_again:
                self._driven.lead_to(before.x, before.y)
                self._led_at = now
            return self._driven.next_from(pose) or (before.x, before.y)
        if goal is None or pose.distance_to(*goal) < self._config.near_home:
            self._reach += self._config.search_growth
            return self._place_to_look()
        return goal

    def _before_station(self, station: Pose) -> Pose:
        return station.compose(Pose(-self._config.before_home, 0.0, 0.0))

    def _place_to_look(self) -> tuple[float, float] | None:
        """Return a random place before the station: farther away the longer the search lasts."""
        if self.station is None:
            return None
        before = self._before_station(self.station)
        off_x, off_y = self._rng.normal(0.0, self._reach, 2).tolist()
        return before.x + off_x, before.y + off_y

    def _dock(self, readings: Readings) -> Twist:
        if self._approach is None:
            self._approach = BeamApproach(self._config)
        twist = self._approach.tick(readings)
        if self._approach.state is Approach.DOCKED:
            self._enter(BumpingState.DOCKED)
        elif self._approach.state is Approach.LOST:
            self._blind_until = readings.time + self._config.blind_time
            self._enter(BumpingState.HOMING)
        return twist
