"""The robot without ROS: the same walking and control code, closed around the simulated world.

The brain gets what the sensors tell and nothing else: where the robot is, it has to find out.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.mission import MissionConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.control.position_loop import PositionLoop
from roomba.control.speed_loop import SpeedLoop
from roomba.errors import RoombaError
from roomba.geometry import Pose, Twist
from roomba.headless.body import readings_of
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.exploring.look_around import SearchDrive
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk, WalkState, WalkStep
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.things.layer import ThingLayer
from roomba.planning.path.planner import PathPlanner
from roomba.robot.readings import senses_of
from roomba.world.home.home import Home
from roomba.world.simulator import Observation, Simulator

_LONGEST_WALK = 3600.0
"""s; a walk that is still under way then is a fault of the program."""


@dataclass(slots=True)
class WalkRecord:
    """What happened on a walk: rows of ``poses`` are t (s), x, y (m), theta (rad), true ones.

    ``believed`` has the same rows, of where the robot took itself to be.
    """

    state: WalkState
    reason: str
    duration: float
    planned: NDArray[np.float64]
    poses: NDArray[np.float64]
    believed: NDArray[np.float64]
    bumps: int
    steps: list[WalkStep] = field(repr=False)

    @property
    def distance(self) -> float:
        """What was travelled, m."""
        return float(np.hypot(*np.diff(self.poses[:, 1:3], axis=0).T).sum())


class HeadlessRobot:
    """One robot in one home, whose time passes only while it does something."""

    def __init__(
        self,
        home: Home,
        config: SimulatedRobotConfig | None = None,
        *,
        seed: int = 0,
        max_speed: float = 0.5,
        start: Pose | None = None,
        mission: MissionConfig | None = None,
    ) -> None:
        """Put the robot at ``start``, or at its station; raises HomeError where it does not fit.

        ``mission`` tells how long what was felt is remembered.
        """
        self.config = config or SimulatedRobotConfig()
        body, walk = self.config.body, self.config.walk
        self.simulator = Simulator(home, self.config, seed=seed, max_speed=max_speed, start=start)
        self.planner = PathPlanner(home.map, body.radius, walk.clearance, walk.tight_clearance)
        lidar = self.config.lidar
        self.localizer = Localizer(
            home.map,
            self.config.localization,
            self.config.gyro,
            body.radius,
            self.simulator.start,
        )
        self._things = ThingLayer(self.localizer.field)
        driving = (mission or MissionConfig()).driving
        self.obstacles = Obstacles(self._things, walk, body, driving)
        self._lidar = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
        self._beams = self._lidar.arrays()
        self._scans = 0
        self._search = SearchDrive(body, self.config.looking_around)
        self._max_speed = max_speed
        self._position_loop = PositionLoop(self.config.control, body)
        self._speed_loop = SpeedLoop(body, max_speed)

    def walk(self, x: float, y: float) -> WalkRecord:
        """Walk to a point of the map frame; raises NoPathError when there is no way."""
        seen = self.simulator.observe()
        walk = Walk(self.planner, self.config.walk, self.obstacles, (x, y), self._sense(seen))
        started, bumps, was_bumped = seen.time, 0, False
        timing = self.config.timing
        steps: list[WalkStep] = []
        poses, believed = [_row(seen.time, seen.pose)], [_row(seen.time, self._pose)]
        while seen.time - started < _LONGEST_WALK:
            step = walk.tick(self._sense(seen), self._max_speed)
            steps.append(step)
            if step.state not in (WalkState.WALKING, WalkState.ASTRAY):
                break
            command = self._control(seen, step)
            for _ in range(timing.steps_per_tick):
                seen = self.simulator.step(command, timing.world_step)
                bumps += seen.bumper.pressed and not was_bumped
                was_bumped = seen.bumper.pressed
            self.localize(seen)
            poses.append(_row(seen.time, seen.pose))
            believed.append(_row(seen.time, self._pose))
        else:
            raise RoombaError(f"a walk to ({x}, {y}) has no end; that is a fault of the program")
        return WalkRecord(
            state=step.state,
            reason=step.reason,
            duration=seen.time - started,
            planned=walk.path.points,
            poses=np.array(poses),
            believed=np.array(believed),
            bumps=bumps,
            steps=steps,
        )

    @property
    def _pose(self) -> Pose:
        return self.localizer.estimate.pose

    def localize(self, seen: Observation) -> None:
        """Take what the sensors tell at a tick: the place, and what stands in the way."""
        self.localizer.lift(seen.wheels.dropped_left and seen.wheels.dropped_right)
        self.localizer.move(seen.time, seen.odometry, seen.angular_velocity)
        if seen.scans != self._scans:
            self._scans = seen.scans
            ranges, knowledge = self.simulator.ranges, self.localizer.estimate.knowledge
            self.localizer.see(seen.time, ranges, self._lidar)
            if knowledge is Knowledge.KNOWN:
                self._things.see(ranges, self._beams, self._pose)

    def _sense(self, seen: Observation) -> Senses:
        return senses_of(readings_of(seen, None), self.localizer.estimate)

    def _control(self, seen: Observation, step: WalkStep) -> Twist:
        touches = seen.bumper.pressed or seen.cliff.any
        wanted = self._search.tick(seen.time, self.localizer, touches)
        if wanted is None and step.state is WalkState.WALKING:
            wanted = self._position_loop.tick(self._pose, step.setpoint, self._max_speed)
        self._speed_loop.set_cruise_speed(step.cruise_speed)
        self._speed_loop.set_bumper(seen.bumper.pressed)
        self._speed_loop.set_cliff(seen.cliff.any)
        self._speed_loop.set_wheel_drop(seen.wheels.dropped)
        self._speed_loop.command(seen.time, wanted or Twist())
        return self._speed_loop.tick(seen.time)[0]


def _row(time: float, pose: Pose) -> tuple[float, float, float, float]:
    return time, pose.x, pose.y, pose.theta
