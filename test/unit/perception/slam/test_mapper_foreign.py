"""Maps of drives that other robots made: their lidars, their odometry, their clocks."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, Floats, wrong_cells
from numpy.typing import NDArray

from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper

EYE = Eye(FURNISHED)
MOUNT = Pose(0.12, 0.0, 0.0)
RADIUS, SPEED = 1.0, 0.3
"""m, m/s; it drives on a circle around the middle of the room, 21 s each time."""


@dataclass(frozen=True)
class Robot:
    """Another robot: its lidar, how late that is, and how bad its odometry."""

    fan: float = math.pi
    """rad; of the beams, around ahead."""
    step: int = 1
    """deg; between two beams."""
    noise: float = 0.01
    rate: float = 10.0
    no_echo: float = 81.83
    farthest: float = 80.0
    late: float = 0.0
    """s; a scan is of so long before its stamp."""
    turn_error: float = 0.0
    way_error: float = 0.0
    """Shares that odometry is off by."""
    told: float = 20.0
    """Hz; of its odometry."""
    leap: float = 0.0
    """m; by which odometry jumps once, after half of the drive."""


def true_pose(time: float) -> Pose:
    """It stands for two seconds, and then drives around, turning to and fro."""
    time = max(time - 2.0, 0.0)
    angle = SPEED / RADIUS * time + 0.4 * math.sin(0.8 * time) * min(time, 1.0)
    heading = angle + 0.5 * math.pi + 0.3 * math.sin(1.7 * time)
    return Pose(2.5 + RADIUS * math.cos(angle), 2.1 + RADIUS * math.sin(angle), heading)


def mapped(robot: Robot, seconds: float = 45.0) -> tuple[Mapper, float]:
    """Return the mapper after a drive, and the largest error of its pose after 5 s, m."""
    config, generator = RobotConfig(), np.random.default_rng(1)
    angles = np.arange(-robot.fan / 2, robot.fan / 2 + 1e-9, math.radians(robot.step))
    lidar = LidarModel(angles, 0.1, robot.farthest, MOUNT)
    mapper = Mapper(MappingConfig(), config.localization, config.gyro, true_pose(0.0))
    odometry, before, worst = Pose(), true_pose(0.0), 0.0
    ticks = round(seconds * 20.0)
    every = round(20.0 / robot.rate)
    for tick in range(ticks):
        now = 0.05 * tick
        here = true_pose(now)
        step = before.inverse().compose(here)
        before = here
        leap = robot.leap if tick == ticks // 2 else 0.0
        odometry = odometry.compose(
            Pose(
                step.x * (1.0 + robot.way_error) + leap,
                step.y,
                step.theta * (1.0 + robot.turn_error),
            )
        )
        if tick % round(20.0 / robot.told) == 0:
            mapper.move(now, odometry)
        if tick % every == 0 and now >= robot.late:
            mapper.see(now, scan(robot, true_pose(now - robot.late), angles, generator), lidar)
            if now > 5.0:
                off = mapper.at_scan.distance_to(
                    true_pose(now - robot.late).x, true_pose(now - robot.late).y
                )
                worst = max(worst, off)
    return mapper, worst


def scan(
    robot: Robot, at: Pose, angles: Floats, generator: np.random.Generator
) -> NDArray[np.float32]:
    """Return what its lidar tells from a pose: a tenth of the beams have no echo."""
    around = EYE.scan(at.compose(MOUNT))
    beams = np.round(np.degrees(angles)).astype(int) % 360
    ranges = around[beams] + generator.normal(0.0, robot.noise, len(beams)).astype(np.float32)
    ranges[generator.random(len(beams)) < 0.1] = robot.no_echo
    result: NDArray[np.float32] = ranges.astype(np.float32)
    return result


ROBOTS = {
    "a scanner of 180 degrees": Robot(),
    "as noisy as 2.5 cm": Robot(noise=0.025, turn_error=0.05),
    "one beam each 2 degrees all around, twice a second": Robot(
        fan=2 * math.pi - 0.04, step=2, rate=2.0, no_echo=0.0, farthest=6.0
    ),
    "240 degrees up to 4 m": Robot(fan=4.18, noise=0.005, no_echo=math.inf, farthest=4.0),
    "late by 0.15 s": Robot(late=0.15),
    "odometry off by a tenth": Robot(turn_error=0.1, way_error=-0.1),
    "a scan each 2.5 s, and odometry with it alone": Robot(rate=0.4, told=0.4, turn_error=0.05),
    "odometry that leaps by half a metre": Robot(leap=0.5, turn_error=0.03),
}


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS.keys())
def test_it_makes_a_map(robot: Robot) -> None:
    mapper, worst = mapped(robot)
    assert mapper.estimate.knowledge is Knowledge.KNOWN
    # Until it has learned how late they are, late scans lie where the robot is by then.
    assert worst < 0.15 + robot.leap + 0.5 * robot.late
    made = mapper.finish()
    told = round(20.0 / robot.told)
    end = true_pose(0.05 * ((45 * 20 - 1) // told * told))
    assert mapper.pose.distance_to(end.x, end.y) < 0.06 + SPEED * robot.late
    ghosts, holes = wrong_cells(made, FURNISHED)
    assert (ghosts, holes) == (0, 0) or ghosts + holes <= 4


def test_it_does_not_stay_without_a_map_where_nothing_fits() -> None:
    """Put into another room unnoticed: after a while the map goes on there, in its own piece."""
    mapper, _ = mapped(Robot(), 20.0)
    version = mapper.version
    far = Eye(FURNISHED)
    lidar = LidarModel(np.radians(np.arange(-90, 91)), 0.1, 30.0)
    start = mapper.pose
    for tick in range(200):
        here = Pose(0.6 + 0.01 * tick, 0.7, 0.0)
        around = far.scan(here)[np.arange(-90, 91) % 360] * np.float32(1.7)
        now = 21.0 + 0.1 * tick
        odometry = start.compose(Pose(0.01 * tick, 0.0, 0.0))
        mapper.move(now, odometry)
        mapper.see(now, around, lidar)
    assert mapper.estimate.knowledge is Knowledge.KNOWN
    assert mapper.version > version + 5
