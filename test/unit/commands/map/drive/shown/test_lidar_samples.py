"""Scans are kept with their poses by odometry, and corrected by the lidar's sweep."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.drives.made_logs import BEGAN, PERIOD, drive
from fixtures.drives.turning_drive import (
    BEAM_TIME,
    half_circle,
    readings_of,
    turning_drive,
    turning_pose,
)

from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.geometry import Pose
from roomba.recordings.drives.sweeps import Sweep
from roomba.recordings.readings import LidarScan, Odometry, Reading


def test_a_scan_is_where_odometry_had_the_robot_at_its_time() -> None:
    samples = LidarSamples(readings_of(turning_drive(), half_circle()))
    assert samples.period == pytest.approx(PERIOD)
    begin, sample = samples.scans[0], samples.scans[20]
    then = turning_pose(0.0).inverse().compose(turning_pose(sample.stamp - BEGAN))
    assert samples.between(begin, sample) == pytest.approx([then.x, then.y, then.theta], abs=1e-3)
    next_one = turning_pose(sample.stamp - BEGAN + PERIOD)
    turned = next_one.theta - turning_pose(sample.stamp - BEGAN).theta
    assert samples.turning(sample) == pytest.approx(turned, abs=1e-3)


def test_late_scans_are_where_it_was_before() -> None:
    samples = LidarSamples(readings_of(drive(6.0), half_circle()))
    one, other = samples.scans[5], samples.scans[10]
    late = samples.between(one, other, 0.1)
    # It goes round in a circle: all pieces of its way are alike.
    assert late == pytest.approx(samples.between(one, other), abs=0.01)


def test_a_robot_that_stands_shows_nothing_new() -> None:
    lidar = half_circle()
    readings = []
    for number in range(100):
        readings.append(Reading(0.1 * number, Odometry(Pose()), 0.0))
        readings.append(Reading(0.1 * number, LidarScan(np.ones(180, np.float32), lidar), 0.0))
    assert len(LidarSamples(readings).scans) == 1
    assert LidarSamples([]).scans == []
    assert LidarSamples(readings[1::2]).scans == []


def test_a_turn_of_more_than_a_half_circle_is_no_jump_back() -> None:
    readings = []
    for number in range(100):
        heading = math.remainder(0.1 * number, math.tau)
        readings.append(Reading(0.1 * number, Odometry(Pose(theta=heading)), 0.0))
        scan = LidarScan(np.ones(180, np.float32), half_circle())
        readings.append(Reading(0.1 * number, scan, 0.0))
    samples = LidarSamples(readings)
    assert [samples.turning(sample) for sample in samples.scans] == pytest.approx(
        [0.1] * len(samples.scans)
    )


def test_the_points_of_a_scan_lie_where_its_sweep_says() -> None:
    items = turning_drive(beam_time=BEAM_TIME, is_backwards=True)
    straight = turning_drive()
    swept = LidarSamples(readings_of(items, half_circle(BEAM_TIME)))
    at_once = LidarSamples(readings_of(straight, half_circle()))
    # Where it turns fastest; of the middle of the room, so that the wall is near.
    number = max(range(len(swept.scans)), key=lambda n: abs(swept.turning(swept.scans[n])))
    true = at_once.points(at_once.scans[number])[:, :2]
    off = [
        float(np.median([np.hypot(*(true - end).T).min() for end in points[:, :2]]))
        for points in (
            swept.points(swept.scans[number], sweep) for sweep in (None, Sweep(is_backwards=True))
        )
    ]
    assert off[1] < 0.02 < off[0]
