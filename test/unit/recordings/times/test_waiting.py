"""Scans that wait for odometry."""

from __future__ import annotations

import numpy as np

from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.times.waiting import StampedScan, WaitingScan

ANGLES = np.arange(4) * 0.5 * np.pi
RANGES = np.ones(4, np.float32)


def scan(stamp: float, time_increment: float = 0.1) -> StampedScan:
    lidar = LidarModel(ANGLES, 0.1, 5.0, time_increment=time_increment)
    return StampedScan(stamp, RANGES, lidar)


def test_a_scan_waits_for_its_last_beam() -> None:
    waiting, first = WaitingScan(), scan(2.0)
    assert waiting.ready(2.0) is None
    assert waiting.put(first) is None
    assert waiting.ready(2.29) is None
    assert waiting.ready(2.31) is first
    assert waiting.ready(2.4) is None


def test_one_that_was_measured_at_once_waits_for_its_stamp() -> None:
    waiting, first = WaitingScan(), scan(2.0, 0.0)
    waiting.put(first)
    assert waiting.ready(1.99) is None
    assert waiting.ready(2.0) is first


def test_the_next_scan_takes_the_place_of_one_that_waits() -> None:
    waiting, first, second = WaitingScan(), scan(2.0), scan(2.2)
    waiting.put(first)
    assert waiting.put(second) is first
    assert waiting.ready(2.31) is None
    assert waiting.last() is second
    assert waiting.last() is None
