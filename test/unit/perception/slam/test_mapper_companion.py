"""Making a map while something moves along beside the robot: a cart, or people who walk with it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper

BEAMS = 480
ANGLES = np.radians(np.linspace(-120.0, 120.0, BEAMS))
LIDAR = LidarModel(ANGLES, 0.02, 5.6)
NOISE = 0.003
LEFT, RIGHT, NICHE = 1.5, -0.9, 0.3
"""m; the walls of a corridor, and how deep its niches are."""
EDGES = np.cumsum(np.random.default_rng(5).uniform(0.3, 1.6, 60)) - 8.0
"""m along the corridor; from the first to the second are niches, and so on."""
SPEED, PERIOD = 0.5, 0.1
"""m/s, s."""
BESIDE = (8.0, 13.0)
"""s; from when to when something is beside the robot."""


def corridor_from(x: float) -> NDArray[np.float64]:
    """Return what the lidar would measure, m, at a place along the corridor."""
    ranges = np.full(BEAMS, np.inf)
    for wall in (LEFT, RIGHT):
        away = wall / np.sin(ANGLES)
        met = x + away * np.cos(ANGLES)
        is_niche = np.searchsorted(EDGES, met) % 2 == 1
        away = np.where(is_niche, (wall + math.copysign(NICHE, wall)) / np.sin(ANGLES), away)
        ranges = np.minimum(ranges, np.where(away > 0.0, away, np.inf))
    return ranges


def companion(share: float) -> NDArray[np.float64]:
    """Return the ranges, m, of what hides a share of the beams: folds, 4 to 6 cm deep."""
    beams = np.arange(round(share * BEAMS))
    return np.asarray(0.52 + 0.04 * np.sin(0.12 * beams) + 0.02 * np.sin(0.28 * beams))


@pytest.mark.parametrize("share", [0.0, 0.2, 0.3])
def test_what_moves_along_with_the_robot_does_not_hold_the_map_back(share: float) -> None:
    config, generator = RobotConfig(), np.random.default_rng(0)
    mapper = Mapper(MappingConfig(), config.localization, config.gyro, Pose())
    beside, x = companion(share), 0.0
    for step in range(150):
        stamp = PERIOD * step
        x += SPEED * PERIOD * (stamp > 2.0)
        ranges = corridor_from(x)
        if BESIDE[0] < stamp < BESIDE[1]:
            ranges[: len(beside)] = beside
        seen = (ranges + generator.normal(0.0, NOISE, BEAMS)).astype(np.float32)
        mapper.move(stamp, Pose(x, 0.0, 0.0))
        mapper.see(stamp, seen, LIDAR)
    assert mapper.pose.x == pytest.approx(x, abs=0.4)
