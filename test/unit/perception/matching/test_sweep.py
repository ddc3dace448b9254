"""Scans of a lidar that turns while the robot moves become scans that are taken at once."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.drives.made_lidars import Lidar, cast, outlines

from roomba.geometry import Pose
from roomba.perception.matching.reckoned_path import ReckonedPath, remember
from roomba.perception.matching.scan_view import LidarModel

WALLS = outlines((0.0, 0.0, 5.0, 4.0), (3.3, 3.1, 3.8, 4.0))
START = Pose(2.0, 1.5, 0.4)


def moving(linear: float, angular: float, time: float) -> Pose:
    """A robot that drives a circle."""
    turn = angular * time
    if abs(angular) < 1e-9:
        return START.compose(Pose(linear * time, 0.0, 0.0))
    radius = linear / angular
    return START.compose(Pose(radius * math.sin(turn), radius * (1.0 - math.cos(turn)), turn))


def path_of(linear: float, angular: float, until: float = 0.4) -> ReckonedPath:
    path = ReckonedPath.empty()
    for stamp in np.arange(0.0, until, 0.02).tolist():
        pose = moving(linear, angular, stamp)
        remember(path, stamp, np.array([pose.x, pose.y, pose.theta]))
    return path


CLEAN = Lidar(noise=0.0, missed=0.0)
LIDARS = {
    "all around": CLEAN,
    "clockwise": Lidar(noise=0.0, missed=0.0, step=-math.radians(1.0)),
    "ahead, off the middle": Lidar(
        noise=0.0, missed=0.0, fan=math.pi, step=math.radians(0.5), mount=Pose(0.2, -0.1, 0.7)
    ),
    "two degrees, backwards": Lidar(
        noise=0.0, missed=0.0, step=math.radians(2.0), mount=Pose(0.0, 0.1, math.pi)
    ),
}


@pytest.mark.parametrize("lidar", LIDARS.values(), ids=LIDARS.keys())
@pytest.mark.parametrize(("linear", "angular"), [(0.3, 1.0), (0.3, -1.0), (0.0, 2.0), (0.4, 0.0)])
def test_it_is_the_scan_of_a_lidar_that_measures_at_once(
    lidar: Lidar, linear: float, angular: float
) -> None:
    raw = lidar.scan(
        lambda time: moving(linear, angular, time), 0.1, WALLS, np.random.default_rng(1)
    )
    # Where it was at the first beam is where the scan is seen from.
    here = moving(linear, angular, 0.1)
    model, path = lidar.model(), path_of(linear, angular)
    still = model.at_once(0.1, raw, path)
    eye = here.compose(lidar.mount)
    true = cast(np.tile([eye.x, eye.y, eye.theta], (len(raw), 1)), lidar.angles, WALLS)
    both = np.isfinite(still) & np.isfinite(raw)
    error = np.abs(still - true)[both]
    # All around a turn leaves out what the lidar did not come to see.
    assert both.mean() > 0.9
    assert np.median(error) < 0.001
    assert np.mean(error < 0.01) > 0.95
    if angular:
        assert np.median(np.abs(raw - true)[both]) > 10.0 * np.median(error)


def test_what_met_nothing_is_told_as_before() -> None:
    lidar = Lidar(noise=0.0, missed=0.4, no_echo=0.0)
    raw = lidar.scan(lambda time: moving(0.3, 1.0, time), 0.1, WALLS, np.random.default_rng(1))
    still = lidar.model().at_once(0.1, raw, path_of(0.3, 1.0))
    known = still[np.isfinite(still)]
    assert set(np.unique(known[known < 0.1]).tolist()) == {0.0}
    assert np.mean(known == 0.0) == pytest.approx(np.mean(raw == 0.0), abs=0.1)


def test_of_a_robot_that_stands_a_scan_is_what_was_measured() -> None:
    lidar = Lidar()
    raw = lidar.scan(lambda time: START, 0.1, WALLS, np.random.default_rng(1))
    still = lidar.model().at_once(0.1, raw, path_of(0.0, 0.0))
    assert (np.isfinite(still) == np.isfinite(raw)).all()
    assert still[np.isfinite(raw)] == pytest.approx(raw[np.isfinite(raw)], abs=1e-5)


def test_odometry_that_is_not_there_yet_goes_on_as_it_did() -> None:
    """The newest odometry is of the first beam."""
    raw = CLEAN.scan(lambda time: moving(0.3, 1.0, time), 0.1, WALLS, np.random.default_rng(1))
    early = CLEAN.model().at_once(0.1, raw, path_of(0.3, 1.0, until=0.11))
    later = CLEAN.model().at_once(0.1, raw, path_of(0.3, 1.0))
    both = np.isfinite(early) & np.isfinite(later)
    assert np.median(np.abs(early - later)[both]) < 0.002


def test_a_lidar_that_measures_at_once_is_left_as_it_is() -> None:
    ranges = np.full(360, 2.0, np.float32)
    for increment in (0.0, math.nan, math.inf, 0.1):
        lidar = LidarModel(np.radians(np.arange(360)), 0.1, 9.0, time_increment=increment)
        assert lidar.at_once(0.1, ranges, path_of(0.3, 1.0)) is ranges
        assert lidar.sweep == 0.0
