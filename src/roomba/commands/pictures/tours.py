"""A tour of a home, recorded: where the robot was, and where it took itself to be by what."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.headless.walker import HeadlessRobot
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.planning.path.planner import NoPathError
from roomba.world.home.home import Home
from roomba.world.simulator import Observation

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Tour:
    """Poses are float64 [n, 3], x, y (m), theta (rad), map frame; ``times`` [n], s."""

    times: Floats
    true: Floats
    believed: Floats
    by_wheels: Floats
    by_gyro: Floats


def tour_of(home: Home, seconds: float, seed: int) -> Tour:
    """Walk to one place after the other, chosen at random, for so long."""
    robot = _ObservedRobot(home, seed)
    random = np.random.default_rng(seed)
    x_min, x_max, y_min, y_max = home.frame.extent
    while robot.simulator.time < seconds:
        try:
            robot.walk(random.uniform(x_min, x_max), random.uniform(y_min, y_max))
        except NoPathError:
            continue
    rows = np.array(robot.rows)
    return Tour(rows[:, 0], rows[:, 1:4], rows[:, 4:7], rows[:, 7:10], rows[:, 10:13])


class _ObservedRobot(HeadlessRobot):
    """Writes down, at each tick, what different ways to know its place come to."""

    def __init__(self, home: Home, seed: int) -> None:
        super().__init__(home, seed=seed)
        self.rows: list[tuple[float, ...]] = []
        self._reckoning = DeadReckoning(self.config.localization, self.config.gyro)

    def localize(self, seen: Observation) -> None:
        super().localize(seen)
        self._reckoning.move(seen.time, seen.odometry, seen.angular_velocity)
        start = self.simulator.start
        by_wheels, by_gyro = start.compose(seen.odometry), start.compose(self._reckoning.pose)
        poses = (seen.pose, self.localizer.estimate.pose, by_wheels, by_gyro)
        self.rows.append((seen.time, *(number for pose in poses for number in _numbers(pose))))


def _numbers(pose: Pose) -> tuple[float, float, float]:
    return pose.x, pose.y, pose.theta
