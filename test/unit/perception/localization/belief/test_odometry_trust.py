"""Wheels that err far more than configured are trusted less, and the pose is kept."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.drives.made_lidars import TICK, Lidar, outlines
from fixtures.robots.mapped import CUPBOARD, FURNISHED, SHELF

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.perception.localization.localizer import Localizer

CONFIG = RobotConfig()
WALLS = outlines((0.0, 0.0, 5.0, 4.0), CUPBOARD, SHELF)
AHEAD = Lidar(fan=math.pi, turns=False)
"""It sees half of what is around."""
SECONDS, SETTLED = 40.0, 10.0
"""s; of a drive, and until something is learned."""


def way(time: float) -> Pose:
    """Two rounds of the room, with bends to either side."""
    angle = 0.3 * time
    x, y = 2.5 + math.cos(angle), 2.0 + 0.9 * math.sin(angle)
    return Pose(x, y, angle + 0.5 * math.pi + 0.4 * math.sin(0.9 * time))


def drive(way_error: float, turn_error: float) -> tuple[Localizer, float]:
    """Drive with wheels that are off by shares of way and turn; return the median error, m."""
    generator, model = np.random.default_rng(3), AHEAD.model()
    localizer = Localizer(
        FURNISHED.map, CONFIG.localization, CONFIG.gyro, CONFIG.body.radius, way(0.0)
    )
    odometry, before, off = Pose(), way(0.0), []
    ticks_a_scan = round(1.0 / (AHEAD.rate * TICK))
    for tick in range(round(SECONDS / TICK)):
        now = TICK * tick
        step, before = before.inverse().compose(way(now)), way(now)
        on = 1.0 + way_error
        odometry = odometry.compose(Pose(on * step.x, on * step.y, (1 + turn_error) * step.theta))
        localizer.move(now, odometry)
        if tick % ticks_a_scan == 0:
            localizer.see(now, AHEAD.scan(way, now, WALLS, generator), model)
            if now > SETTLED:
                pose = localizer.estimate.pose
                off.append(pose.distance_to(before.x, before.y))
    return localizer, float(np.median(off))


def test_good_wheels_are_trusted_as_they_are_configured() -> None:
    localizer, off = drive(0.0, 0.0)
    assert localizer.belief[0]["odometry_scale"] == pytest.approx(1.0, abs=1.0)
    assert off < 0.006


def test_the_place_is_as_sure_with_wheels_that_are_a_quarter_off() -> None:
    localizer, off = drive(0.25, -0.2)
    assert off < 0.005
    ahead, _, turn = localizer.belief[0]["odometry_scale"]
    assert ahead > 2.0
    assert turn > 2.0
