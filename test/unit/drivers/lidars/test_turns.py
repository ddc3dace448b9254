"""Points gathered into turns."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.configuration.sensors import LidarConfig
from roomba.drivers.lidars.turns import TurnCollector
from roomba.robot.readings import ScanReading

CONFIG = LidarConfig(beams=360, min_range=0.1, max_range=8.0, mount_ahead=0.05)


def gathered(
    collector: TurnCollector, points: list[tuple[float, float, float]]
) -> list[ScanReading]:
    scans = [collector.add(*point) for point in points]
    return [scan for scan in scans if scan is not None]


def circle(begin: float, end: float, distance: float = 1.0) -> list[tuple[float, float, float]]:
    """Points a degree apart, ten turns a second, from one to another place, turns."""
    return [
        (float(place % 360), distance, place / 3600)
        for place in range(round(begin * 360), round(end * 360))
    ]


def test_the_first_turn_that_is_whole_is_the_first_scan() -> None:
    assert gathered(TurnCollector(CONFIG), circle(0.0, 2.0)) == []
    (scan,) = gathered(TurnCollector(CONFIG), circle(0.5, 2.1))
    assert scan.stamp == pytest.approx(0.1, abs=1e-6)
    assert np.isfinite(scan.ranges).all()


def test_the_mount_and_where_it_faces_are_those_of_the_robot() -> None:
    (scan,) = gathered(TurnCollector(CONFIG, math.pi / 2.0), circle(0.5, 2.1))
    first = scan.lidar.view(scan.ranges).ends[0]
    assert first[:2] == pytest.approx((0.05, 1.0), abs=1e-6)


def test_too_near_and_too_far_is_no_range_and_the_nearest_of_a_beam_counts() -> None:
    points = circle(0.5, 2.1)
    points = [(angle, 9.0 if angle == 90.0 else distance, at) for angle, distance, at in points]
    points = [(angle, 0.05 if angle == 180.0 else distance, at) for angle, distance, at in points]
    at = next(place for place, point in enumerate(points) if point[0] == 10.0 and point[2] > 0.1)
    points.insert(at + 1, (10.2, 0.5, points[at][2]))
    (scan,) = gathered(TurnCollector(CONFIG), points)
    assert np.isinf(scan.ranges[[90, 180]]).all()
    assert scan.ranges[10] == pytest.approx(0.5)


def test_a_model_is_kept_while_it_turns_as_fast() -> None:
    scans = gathered(TurnCollector(CONFIG), circle(0.5, 4.1))
    assert scans[0].lidar is scans[-1].lidar
