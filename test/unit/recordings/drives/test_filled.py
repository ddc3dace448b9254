"""Odometry that is filled in where it is rarer than scans."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.drives.filled import filled
from roomba.recordings.readings import LidarScan, Odometry, Reading, Turning, Value

LIDAR = LidarModel(np.linspace(0.0, 6.0, 8), 0.1, 8.0, Pose())
SCAN = LidarScan(np.ones(8, np.float32), LIDAR)


def odometry(stamp: float, x: float = 0.0, theta: float = 0.0) -> Reading:
    return Reading(stamp, Odometry(Pose(x, 0.0, theta)), stamp)


def scan(stamp: float) -> Reading:
    return Reading(stamp, SCAN, stamp)


def test_at_each_scan_between_two_poses_it_is_on_the_way_from_one_to_the_other() -> None:
    told = [odometry(10.0, 1.0, 3.1), scan(10.2), scan(10.4), odometry(11.0, 2.0, -3.1)]
    first, added, one, again, other, last = filled(told)
    assert [first, one, other, last] == [told[0], told[1], told[2], told[3]]
    turned = 2.0 * math.pi - 6.2
    for reading, share in ((added, 0.2), (again, 0.4)):
        assert reading.stamp == pytest.approx(10.0 + share)
        assert isinstance(reading.value, Odometry)
        pose = reading.value.pose
        assert pose.x == pytest.approx(1.0 + share)
        assert math.cos(pose.theta - (3.1 + share * turned)) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "told",
    [
        [odometry(1.0), scan(1.05), odometry(1.1), scan(1.25), odometry(1.3)],
        [odometry(1.0), scan(1.5), scan(2.0), scan(2.5), odometry(3.5)],
        [scan(0.5), scan(0.7), odometry(1.0), scan(1.2), scan(1.4)],
        [scan(0.5), scan(0.7)],
        [],
    ],
    ids=["as frequent as scans", "a gap", "its ends", "none", "nothing"],
)
def test_elsewhere_nothing_is_added(told: list[Reading]) -> None:
    assert list(filled(told)) == told


def test_without_odometry_nothing_is_held_back() -> None:
    asked = list[float]()

    def told() -> Iterator[Reading]:
        for at in range(1000):
            asked.append(float(at))
            yield scan(float(at))

    readings = filled(told())
    assert next(readings).stamp == 0.0
    assert len(asked) == 1


@given(st.lists(st.tuples(st.floats(0.0, 30.0), st.integers(0, 2)), max_size=60))
def test_what_was_recorded_stays_and_time_goes_on(parts: list[tuple[float, int]]) -> None:
    kinds: list[Value] = [SCAN, Odometry(Pose(1.0, 2.0, 0.5)), Turning(0.1)]
    told = [Reading(stamp, kinds[kind], stamp) for stamp, kind in sorted(parts)]
    found = list(filled(told))
    known = {id(each) for each in told}
    assert [each for each in found if id(each) in known] == told
    assert all(isinstance(each.value, Odometry) for each in found if id(each) not in known)
    stamps = [each.stamp for each in found]
    assert stamps == sorted(stamps)
