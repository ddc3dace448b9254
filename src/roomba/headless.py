"""The robot without ROS: the same walking and control code, closed around the simulated world.

It may read the truth and gives it to the loops as their pose: a robot that knows where it is.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from roomba.config import RobotConfig
from roomba.control.position_loop import PositionLoop
from roomba.control.speed_loop import SpeedLoop
from roomba.errors import RoombaError
from roomba.geometry import Pose, Twist
from roomba.mission.unknown_things import UnknownThings
from roomba.mission.walk import Sensed, Walk, WalkState, WalkStep
from roomba.planning.path import PathPlanner
from roomba.world.home import Home
from roomba.world.simulator import Observation, Simulator

_STEP = 0.025
_STEPS_PER_TICK = 2
_LONGEST_WALK = 3600.0
"""s; a walk that is still under way then is a fault of the program."""


@dataclass(slots=True)
class WalkRecord:
    """What happened on a walk: rows of ``poses`` are t (s), x, y (m), theta (rad), true ones."""

    state: WalkState
    reason: str
    duration: float
    planned: NDArray[np.float64]
    poses: NDArray[np.float64]
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
        config: RobotConfig | None = None,
        *,
        seed: int = 0,
        max_speed: float = 0.5,
        start: Pose | None = None,
    ) -> None:
        """Put the robot at ``start``, or at its station; raises HomeError where it does not fit."""
        self.config = config or RobotConfig()
        body, walk = self.config.body, self.config.walk
        self.simulator = Simulator(home, self.config, seed=seed, max_speed=max_speed, start=start)
        self.things = UnknownThings(walk, body)
        self.planner = PathPlanner(home.map, body.radius, walk.clearance, walk.tight_clearance)
        self._max_speed = max_speed
        self._position_loop = PositionLoop(self.config.control, body)
        self._speed_loop = SpeedLoop(body.command_timeout, max_speed, body.max_angular_speed)

    def walk(self, x: float, y: float) -> WalkRecord:
        """Walk to a point of the map frame; raises NoPathError when there is no way."""
        seen = self.simulator.observe()
        walk = Walk(
            self.planner,
            self.config.walk,
            self.config.body,
            self.things,
            (x, y),
            self._sense(seen),
        )
        started, bumps, was_bumped = seen.time, 0, False
        steps: list[WalkStep] = []
        poses = [(seen.time, seen.pose.x, seen.pose.y, seen.pose.theta)]
        while seen.time - started < _LONGEST_WALK:
            step = walk.tick(self._sense(seen), self._max_speed)
            steps.append(step)
            if step.state is not WalkState.WALKING:
                break
            command = self._control(seen, step)
            for _ in range(_STEPS_PER_TICK):
                seen = self.simulator.step(command, _STEP)
                bumps += seen.bumper.pressed and not was_bumped
                was_bumped = seen.bumper.pressed
            poses.append((seen.time, seen.pose.x, seen.pose.y, seen.pose.theta))
        else:
            raise RoombaError(f"a walk to ({x}, {y}) has no end; that is a fault of the program")
        return WalkRecord(
            state=step.state,
            reason=step.reason,
            duration=seen.time - started,
            planned=walk.path.points,
            poses=np.array(poses),
            bumps=bumps,
            steps=steps,
        )

    def _sense(self, seen: Observation) -> Sensed:
        cliff = seen.cliff
        return Sensed(
            seen.time,
            seen.pose,
            seen.twist.linear,
            seen.bumper.left,
            seen.bumper.right,
            cliff.left or cliff.front_left,
            cliff.right or cliff.front_right,
        )

    def _control(self, seen: Observation, step: WalkStep) -> Twist:
        wanted = self._position_loop.tick(seen.pose, step.setpoint, self._max_speed)
        self._speed_loop.set_cruise_speed(step.cruise_speed)
        self._speed_loop.set_bumper(seen.bumper.pressed)
        self._speed_loop.set_cliff(seen.cliff.any)
        self._speed_loop.set_wheel_drop(seen.wheels.dropped)
        self._speed_loop.command(seen.time, wanted)
        return self._speed_loop.tick(seen.time)[0]
