"""Readings of a drive, told to the localizer one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.robots.located import CONFIG, FURNISHED, LIDAR, Eye

from roomba.commands.localize.replay import Replay, Row
from roomba.commands.map.drive.odometry_gaps import ALWAYS
from roomba.commands.map.drive.whole_odometry import WholeOdometry
from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.readings import LidarScan, Odometry, Reading, Turning, Value

BEGAN = 1_700_000_000.0
START = Pose(1.4, 1.0, 0.3)


def replay() -> Replay:
    return Replay(FURNISHED.map, CONFIG, WholeOdometry(CONFIG, MappingConfig(), ()), START)


def hear(robot: Replay, seconds: float, value: Value) -> Row | None:
    """Tell a reading that was recorded a day after it was measured."""
    return robot.hear(Reading(BEGAN + seconds, value, BEGAN + seconds + 86400.0))


def test_a_scan_waits_until_odometry_has_reached_its_last_beam() -> None:
    robot, angles = replay(), np.linspace(0.0, math.tau, 360, endpoint=False)
    lidar = LidarModel(angles, 0.1, 12.0, Pose(), 0.2 / 359)
    scan = LidarScan(np.ones(360, np.float32), lidar)
    hear(robot, 0.9, Odometry(Pose()))
    hear(robot, 1.0, scan)
    hear(robot, 1.15, Odometry(Pose()))
    assert robot.scans == 0
    hear(robot, 1.21, Odometry(Pose()))
    assert robot.scans == 1


def test_scans_without_odometry_are_left_out_and_counted() -> None:
    robot = replay()
    lidar = LidarModel(np.linspace(0.0, 3.0, 180), 0.1, 12.0)
    scan = LidarScan(np.ones(180, np.float32), lidar)
    hear(robot, 0.0, Odometry(Pose()))
    for seconds in (2.0, 3.0, 4.0):
        hear(robot, seconds, scan)
    assert robot.scans == 0
    assert robot.notes == ["2 scans of times without odometry: left out"]


def test_turns_are_those_of_the_gyro() -> None:
    """The wheels say that it stands."""
    headings = []
    for speed in (None, 0.5):
        robot, row = replay(), None
        for tick in range(41):
            if speed is not None:
                hear(robot, 0.05 * tick, Turning(speed))
            row = hear(robot, 0.05 * tick, Odometry(Pose(0.02 * tick, 0.0, 0.0))) or row
        assert row is not None
        headings.append(row.estimate.pose.theta - START.theta)
    assert abs(headings[0]) < 1e-6
    assert 0.3 < headings[1] < 1.01


def test_what_was_driven_without_odometry_and_without_scans_that_tell_is_a_guess() -> None:
    """As along a bare corridor: a map that is made meanwhile goes on at the robot's pace."""
    odometry = WholeOdometry(CONFIG, MappingConfig(), (ALWAYS,))
    robot, eye, row = Replay(FURNISHED.map, CONFIG, odometry, START), Eye(FURNISHED), None
    nothing = np.full(LIDAR.beams, np.inf, np.float32)
    for tick in range(30):
        here = START.compose(Pose(0.06 * min(tick, 15)))
        row = hear(robot, 0.2 * tick, LidarScan(nothing if tick > 15 else eye.scan(here), LIDAR))
        if tick == 15:
            assert row is not None
            assert row.estimate.position_deviation < 0.03
    assert row is not None
    assert row.way == pytest.approx(0.06 * 29, abs=0.1)
    assert row.estimate.position_deviation > 0.1


def test_rows_come_as_often_as_the_live_node_tells_its_pose() -> None:
    robot = replay()
    rows = [hear(robot, 0.01 * tick, Odometry(Pose(0.001 * tick))) for tick in range(101)]
    told = [row for row in rows if row is not None]
    assert len(told) == 21
    assert [row.elapsed for row in told[:3]] == [0.0, told[1].elapsed, 2.0 * told[1].elapsed]
    assert told[-1].stamp == BEGAN + 1.0
    assert told[-1].arrival == BEGAN + 1.0 + 86400.0
    assert abs(told[-1].way - 0.1) < 1e-6


def test_of_late_scans_rows_tell_the_times_that_scans_of_those_places_have() -> None:
    """A map of the drive has its places by the stamps of scans, too."""
    robot, generator, rows = replay(), np.random.default_rng(1), []
    eye, late = Eye(FURNISHED), 0.2

    def here(seconds: float) -> Pose:
        return Pose(START.x, START.y, START.theta + math.sin(seconds))

    for tick in range(600):
        seconds = 0.05 * tick
        rows.append(hear(robot, seconds, Odometry(START.inverse().compose(here(seconds)))))
        if tick % 4 == 0:
            ranges = eye.scan(here(seconds - late), generator)
            rows.append(hear(robot, seconds, LidarScan(ranges, LIDAR)))
    told = [row for row in rows if row is not None]
    assert told[0].scan_stamp == told[0].stamp
    assert told[-1].scan_stamp - told[-1].stamp == pytest.approx(late, abs=0.01)
    stamps = [row.scan_stamp for row in told]
    assert stamps == sorted(stamps)
    assert told[-1].estimate.pose.theta == pytest.approx(
        here(told[-1].stamp - BEGAN).theta, abs=0.01
    )
