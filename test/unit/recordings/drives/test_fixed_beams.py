"""Beams that a thing hides which goes with the robot are found, and what they show is left out."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.drives.fixed_beams import UnhiddenScans, fixed_beams
from roomba.recordings.readings import LidarScan

BEAMS = 90
ANGLES = 2.0 * math.pi / BEAMS * np.arange(BEAMS)
AWAY, NOISE = 0.5, 0.01
"""m."""
TURNING = 0.1 * np.arange(80)
"""rad; headings of a robot that turns by 8 rad."""
Ranges = NDArray[np.float32]


def in_room(headings: Floats, hidden: slice = slice(0)) -> Ranges:
    """Return scans in a room of 5 by 3 m, along which it drives; a thing hides some beams."""
    random = np.random.default_rng(1)
    along = np.linspace(1.0, 4.0, len(headings))[:, None]
    ways = headings[:, None] + ANGLES
    ahead, aside = np.cos(ways), np.sin(ways)
    with np.errstate(divide="ignore"):
        to_ends = np.where(ahead > 0.0, 5.0 - along, along) / np.abs(ahead)
        ranges = np.minimum(to_ends, np.where(aside > 0.0, 1.9, 1.1) / np.abs(aside))
    ranges[:, hidden] = AWAY
    return np.asarray(ranges + random.normal(0.0, NOISE, ranges.shape), np.float32)


@pytest.mark.parametrize("hidden", [slice(10, 12), slice(20, 60), slice(5, 75)])
def test_what_a_thing_on_the_robot_hides_is_found(hidden: slice) -> None:
    found = fixed_beams(in_room(TURNING, hidden), TURNING)
    assert np.flatnonzero(found).tolist() == list(range(BEAMS))[hidden]


def test_walls_and_beams_that_meet_nothing_are_no_thing_on_the_robot() -> None:
    ranges = in_room(TURNING)
    ranges[:, :40] = np.inf
    assert not fixed_beams(ranges, TURNING).any()
    # A driver that tells its longest range for no echo.
    ranges[:, :40] = 5.0
    assert not fixed_beams(ranges, TURNING).any()


def test_beside_a_wall_nothing_is_told_of_a_robot_that_goes_straight_on() -> None:
    straight = 0.02 * np.sin(np.arange(80.0))
    assert not fixed_beams(in_room(straight, slice(20, 60)), straight).any()


def test_odometry_that_turns_while_the_robot_stands_hides_nothing() -> None:
    standing = np.repeat(in_room(np.zeros(1)), len(TURNING), axis=0)
    assert not fixed_beams(standing, TURNING).any()


def test_what_they_show_is_left_out_as_too_near() -> None:
    lidar = LidarModel(np.array([-0.2, 0.0, 0.2]), 0.1, 9.0)
    scan = LidarScan(np.array([1.0, 2.0, 3.0], np.float32), lidar)
    unhidden = UnhiddenScans(np.array([False, True, True]))
    after = unhidden.of(scan)
    assert after.ranges.tolist() == [1.0, -math.inf, -math.inf]
    assert after.ranges.dtype == np.float32
    assert after.lidar is lidar
    assert UnhiddenScans(np.array([True])).of(scan) is scan
