"""Scans are put in the order in which their beams were measured."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.drives.sweeps import Sweep, SweptScans
from roomba.recordings.readings import LidarScan

RANGES = np.array([1.0, 2.0, 3.0, 4.0], np.float32)


def scan(time_increment: float = 0.01) -> LidarScan:
    lidar = LidarModel(np.array([-0.2, 0.0, 0.2, 0.4]), 0.1, 9.0, time_increment=time_increment)
    return LidarScan(RANGES, lidar)


@pytest.mark.parametrize(
    ("sweep", "told", "increment"),
    [
        (Sweep(), -0.01, 0.01),
        (Sweep(is_backwards=True), 0.01, 0.01),
        (Sweep(turn=0.0), 0.01, 0.0),
        (Sweep(is_backwards=True, turn=0.2), 0.0, 0.2 * 0.2 / math.tau),
    ],
)
def test_what_is_seen_stays_where_it_is(sweep: Sweep, told: float, increment: float) -> None:
    before = scan(told)
    after = SweptScans(sweep).of(before)
    assert after.lidar.time_increment == pytest.approx(increment)
    order = -1 if sweep.is_backwards else 1
    assert after.ranges.tolist() == before.ranges[::order].tolist()
    ends = [each.lidar.view(each.ranges).ends for each in (before, after)]
    assert ends[1][::order] == pytest.approx(ends[0])


def test_the_scans_of_a_lidar_stay_those_of_one_lidar() -> None:
    swept, one = SweptScans(Sweep(is_backwards=True)), scan()
    assert swept.of(one).lidar is swept.of(one).lidar


@pytest.mark.parametrize(
    ("sweep", "words"),
    [
        (Sweep(), "from the first to the last"),
        (Sweep(is_backwards=True), "from the last to the first"),
        (Sweep(turn=0.0), "all at once"),
        (Sweep(turn=0.2), "from the first to the last, 0.200 s for a whole turn"),
    ],
)
def test_a_sweep_has_words(sweep: Sweep, words: str) -> None:
    assert str(sweep) == words
