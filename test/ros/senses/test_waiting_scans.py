"""Scans that wait for the odometry of their time."""

import numpy as np

from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.readings import ScanReading
from roomba_ros.senses.waiting_scans import WaitingScans

LIDAR = LidarModel.all_around(4, 0.1, 8.0)


def scans(*stamps: float) -> WaitingScans:
    waiting = WaitingScans()
    for stamp in stamps:
        waiting.put(ScanReading(stamp, np.ones(4, np.float32), LIDAR))
    return waiting


def taken(waiting: WaitingScans, stamp: float) -> float | None:
    scan = waiting.take(stamp)
    return None if scan is None else scan.stamp


def test_the_newest_is_taken_of_those_whose_time_has_come() -> None:
    waiting = scans(1.0, 1.25, 1.5)
    assert taken(waiting, 0.95) is None
    assert waiting.oldest == 1.0
    assert taken(waiting, 1.3) == 1.25
    assert taken(waiting, 1.3) is None
    assert taken(waiting, 1.5) == 1.5
    assert (taken(waiting, 9.0), waiting.oldest) == (None, None)


def test_a_newer_one_does_not_take_the_place_of_one_that_waits() -> None:
    waiting = scans(*(0.25 * count for count in range(4, 21)))
    assert waiting.oldest == 4.0
    assert taken(waiting, 4.6) == 4.5


def test_after_the_clock_was_set_back_older_ones_do_not_wait() -> None:
    waiting = scans(500.0, 500.5, 2.0)
    assert waiting.oldest == 2.0
    assert taken(waiting, 2.0) == 2.0


def test_one_without_a_stamp_is_taken_at_once() -> None:
    assert taken(scans(0.0), 7.0) == 0.0


def test_one_waits_for_its_last_beam() -> None:
    waiting = WaitingScans()
    turning = LidarModel(np.arange(5) * 0.5, 0.1, 8.0, time_increment=0.05)
    waiting.put(ScanReading(1.0, np.ones(5, np.float32), turning))
    assert taken(waiting, 1.15) is None
    assert taken(waiting, 1.2) == 1.0
