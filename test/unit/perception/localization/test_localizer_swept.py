"""On a known map a lidar that turns while the robot turns, or is late, is as good as any."""

from __future__ import annotations

import math

import numpy as np
from fixtures.drives.made_lidars import TICK, Lidar, outlines
from fixtures.robots.mapped import CUPBOARD, FURNISHED, SHELF

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, wrap_angle
from roomba.perception.localization.localizer import Localizer

WALLS = outlines((0.0, 0.0, 5.0, 4.0), CUPBOARD, SHELF)
SECONDS = 12.0


def turning(time: float) -> Pose:
    """It drives around the room, and turns to and fro at up to 1 rad/s beside that."""
    angle = 0.3 * time
    swing = 0.7 * 4.5 / math.pi * (1.0 - math.cos(math.pi / 4.5 * time))
    return Pose(2.5 + math.cos(angle), 2.0 + 0.9 * math.sin(angle), angle + 0.5 * math.pi + swing)


def heading_error(
    lidar: Lidar, *, tells_time: bool = True, late: float = 0.0, after: float = 3.0
) -> float:
    """Root mean square of how far it takes the robot to be turned from how it is, rad.

    Scans come, and are stamped, so ``late``, s; errors count ``after`` so long, s.
    """
    config, generator = RobotConfig(), np.random.default_rng(2)
    localizer = Localizer(
        FURNISHED.map, config.localization, config.gyro, config.body.radius, turning(0.0)
    )
    model, scans, off = lidar.model(tells_time=tells_time), 0, []
    for tick in range(round(SECONDS / TICK)):
        now = TICK * tick
        localizer.move(now, turning(0.0).inverse().compose(turning(now)))
        stamp = scans / lidar.rate
        if now >= stamp + lidar.time_increment * model.beams + late:
            scans += 1
            localizer.see(stamp + late, lidar.scan(turning, stamp, WALLS, generator), model)
        if now > after:
            off.append(wrap_angle(localizer.estimate.pose.theta - turning(now).theta))
    return float(np.sqrt(np.mean(np.square(off))))


def test_known_times_of_beams_make_it_as_good_as_a_lidar_that_measures_at_once() -> None:
    instant, swept = heading_error(Lidar(turns=False)), heading_error(Lidar())
    assert swept < 1.5 * instant
    assert heading_error(Lidar(), tells_time=False) > 3.0 * swept


def test_scans_that_come_late_are_taken_for_what_they_saw_then() -> None:
    in_time = heading_error(Lidar(turns=False), after=8.0)
    assert heading_error(Lidar(turns=False), late=0.15, after=8.0) < 2.0 * in_time
    assert heading_error(Lidar(), late=0.2, after=8.0) < 2.0 * in_time
