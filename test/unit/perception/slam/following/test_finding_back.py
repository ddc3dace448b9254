"""Finding back where scans stop to fit because dead reckoning is wrong."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import Eye

from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper

CUPBOARDS = (
    (1.5, 0.0, 2.1, 0.4),
    (3.6, 2.0, 4.5, 2.4),
    (6.0, 0.0, 6.3, 0.5),
    (7.7, 1.9, 8.6, 2.4),
    (9.4, 0.0, 10.6, 0.3),
    (12.0, 2.1, 12.4, 2.4),
)
EYE = Eye(room_home(16.0, 2.4, CUPBOARDS))
SPEED, PERIOD = 1.0, 0.2
"""m/s, s; a quick robot whose lidar is slow."""
ANGLES = np.radians(np.arange(-90.0, 91.0))
LIDAR = LidarModel(ANGLES, 0.1, 12.0, Pose())


def true_pose(time: float) -> Pose:
    """It drives along a hall, a little to and fro."""
    return Pose(1.0 + SPEED * time, 1.2 + 0.2 * math.sin(time), 0.2 * math.cos(time))


def driven(frozen: float, leaps: bool) -> tuple[Mapper, list[float]]:
    """Return the mapper and its errors after each scan, m.

    After 5 s odometry stands still for some time; then it leaps to where the robot is, or not.
    """
    config, random = RobotConfig(), np.random.default_rng(2)
    mapper = Mapper(MappingConfig(), config.localization, config.gyro, true_pose(0.0))
    errors, lost, shown = [], Pose(), true_pose(0.0)
    for tick in range(round(12.0 / PERIOD)):
        now = tick * PERIOD
        here = true_pose(now)
        if not 5.0 < now < 5.0 + frozen:
            shown = lost.compose(here)
        elif not leaps:
            lost = shown.compose(here.inverse())
        mapper.move(now, shown)
        beams = np.round(np.degrees(ANGLES)).astype(int) % 360
        noise = random.normal(0.0, 0.01, len(beams))
        ranges = (EYE.scan(here)[beams] + noise).astype(np.float32)
        mapper.see(now, ranges, LIDAR)
        errors.append(mapper.at_scan.distance_to(here.x, here.y))
    return mapper, errors


@pytest.mark.parametrize("leaps", [True, False], ids=["leaps after it", "goes on from there"])
@pytest.mark.parametrize("frozen", [0.7, 1.5, 3.0])
def test_odometry_that_stands_still_for_a_while_does_not_carry_it_away(
    frozen: float, leaps: bool
) -> None:
    """Scans tell that the robot goes on, though its wheels say that it stands."""
    mapper, errors = driven(frozen, leaps)
    assert mapper.estimate.knowledge is Knowledge.KNOWN
    assert max(errors) < 0.9
    assert max(errors[-15:]) < 0.25
    mapper.finish()
    end = true_pose(12.0 - PERIOD)
    assert mapper.at_scan.distance_to(end.x, end.y) < 0.25
