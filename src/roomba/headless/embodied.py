"""The robot without ROS: a brain in a body, simulated or real, tick by tick."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError
from roomba.geometry import Pose, Twist
from roomba.headless.tick_rows import PASSED
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.perception.swept.dirt_map import DirtMap
from roomba.robot.body import Body
from roomba.robot.brain import Brain
from roomba.robot.command import Command
from roomba.robot.readings import Readings

_FIRST_MAP: Final = 1200
"""Ticks, one minute: how long to wait for a scan that a map can begin with. A robot whose scans
show too little for so long has no room around it."""
_UNKNOWN: Final = (math.nan, math.nan, math.nan)
"""The true pose of a robot that is not simulated."""


class Embodied:
    """One robot, whose time passes only while it is ticked.

    ``rows`` are the ticks that passed, as of :mod:`roomba.headless.tick_rows`, in pieces.
    """

    body: Body

    def __init__(self, body: Body, brain: Brain, robot_config: RobotConfig) -> None:
        """Put a brain in a body, and stand until the brain has a map, which needs a scan.

        Raises RoombaError when there is no map after a minute of ticks.
        """
        self.body, self.brain, self.robot_config = body, brain, robot_config
        self.rows: list[NDArray[np.float64]] = []
        self._way, self._last = 0.0, Pose()
        self._sense()
        for _ in range(_FIRST_MAP):
            if self.brain.is_ready:
                return
            self.body.act(self.brain.decide())
            self._sense()
            self.rows.append(self.row())
        raise RoombaError(
            self.body.trouble.text
            or "expected a scan that a map can begin with, got none: put the robot on its station, "
            "with room before it, and see whether its lidar turns"
        )

    def advance(self) -> None:
        """Let a tick pass; while its body cannot be reached, the brain waits."""
        if self._reaches_body():
            self.tick()

    def tick(self) -> None:
        """Let one tick pass, by what the brain wants."""
        self._pass(self.brain.decide())

    def forget_rows(self) -> None:
        """Forget the ticks that passed: a robot that lives on for days keeps none."""
        self.rows.clear()

    def steer(self, twist: Twist) -> None:
        """Let one tick pass, driven by hand as far as that is safe; the mission stands."""
        if self._reaches_body():
            self._pass(self.brain.steer(twist))

    def _reaches_body(self) -> bool:
        """Whether the body can be reached; if not, let the body try for a tick."""
        if self.body.trouble:
            self.body.act(Command())
        return not self.body.trouble

    def _pass(self, command: Command) -> None:
        self.body.act(command)
        self._sense()
        self.rows.append(self.row())

    def _sense(self) -> None:
        readings = self.readings()
        self.brain.sense(readings)
        self._way += self._last.distance_to(readings.odometry.x, readings.odometry.y)
        self._last = readings.odometry

    def readings(self) -> Readings:
        """Return what the body tells now."""
        return self.body.read()

    @property
    def now(self) -> Readings:
        """What the body told last."""
        return self.brain.readings

    @property
    def mission(self) -> Mission:
        """The robot's mission; another one may replace it, as after its process was killed."""
        return self.brain.mission

    @mission.setter
    def mission(self, mission: Mission) -> None:
        self.brain.mission = mission

    @property
    def dirt(self) -> DirtMap:
        """Where the robot found dirt."""
        return self.mission.dirt

    @property
    def distance(self) -> float:
        """Length of the way that the robot drove, m."""
        return self._way

    @property
    def battery_change(self) -> float:
        """Change of the battery's charge as a share of its capacity, 1/s; NaN if not known."""
        return math.nan

    @property
    def dirt_under(self) -> float:
        """The dirt on the floor under the robot, g; NaN if not known."""
        return math.nan

    @property
    def passed(self) -> NDArray[np.float64]:
        """All ticks that passed, float64 [n, PASSED], as of :mod:`roomba.headless.tick_rows`."""
        return np.concatenate([np.empty((0, PASSED)), *self.rows])

    def senses(self) -> Senses:
        """Return what the robot senses now."""
        return self.brain.senses()

    def row(self) -> NDArray[np.float64]:
        """Return the present state as the row of a tick: float64 [1, PASSED]."""
        now, believed = self.now, self.brain.pose
        poses = [(each.x, each.y, each.theta) for each in (believed, now.odometry)]
        turning = now.twist.angular if now.turning is None else now.turning
        bias = self.brain.keeper.gyro_bias
        return np.array([[now.time, *_UNKNOWN, *poses[0], *poses[1], turning, bias]])
