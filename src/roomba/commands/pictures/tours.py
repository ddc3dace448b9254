"""A recorded tour of a home: the true poses, and the poses by each way to know them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from roomba.arrays import Floats
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.headless.tick_rows import BELIEVED, GYRO, ODOMETRY, TIME, TRUE
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.planning.path.planner import NoPathError
from roomba.world.home.home import Home


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
    robot = HeadlessMission(home, seed=seed)
    random = np.random.default_rng(seed)
    x_min, x_max, y_min, y_max = home.frame.extent
    while robot.seen.time < seconds:
        try:
            robot.walk(random.uniform(x_min, x_max), random.uniform(y_min, y_max))
        except NoPathError:
            continue
    rows, start = robot.passed, robot.simulator.start
    by_wheels, by_gyro = _from(start, rows[:, ODOMETRY]), _from(start, _reckoned(robot, rows))
    return Tour(rows[:, TIME], rows[:, TRUE], rows[:, BELIEVED], by_wheels, by_gyro)


def _reckoned(robot: HeadlessMission, rows: Floats) -> Floats:
    """Return where the robot was by wheels and gyro, float64 [n, 3], odometry's frame."""
    reckoning, poses = DeadReckoning(robot.robot_config.localization, robot.robot_config.gyro), []
    for row in rows.tolist():
        reckoning.move(row[TIME], Pose(*row[ODOMETRY]), row[GYRO])
        poses.append((reckoning.pose.x, reckoning.pose.y, reckoning.pose.theta))
    return np.array(poses)


def _from(start: Pose, poses: Floats) -> Floats:
    """Return poses of a frame that lies at ``start``, float64 [n, 3], in the map's."""
    composed = (start.compose(Pose(*pose)) for pose in poses.tolist())
    return np.array([(pose.x, pose.y, pose.theta) for pose in composed])
