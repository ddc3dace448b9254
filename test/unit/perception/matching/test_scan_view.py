"""Scans as perception uses them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel, plain_ranges


def test_beam_0_is_ahead_and_the_others_follow_counter_clockwise() -> None:
    lidar = LidarModel.all_around(4, 0.15, 12.0)
    view = lidar.view(np.array([1.0, 2.0, 3.0, 4.0], np.float32))
    expected = [[1, 0, 1, 0], [0, 2, 0, 1], [-3, 0, -1, 0], [0, -4, 0, -1]]
    assert view.ends == pytest.approx(np.array(expected, np.float64), abs=1e-9)
    assert view.mount.tolist() == [0.0, 0.0, 0.0]


def test_only_beams_that_met_something_in_reach_are_kept() -> None:
    lidar = LidarModel.all_around(8, 0.15, 12.0)
    ranges = [0.14, 0.1501, np.inf, -np.inf, np.nan, 11.9, 12.1, -1.0]
    view = lidar.view(np.array(ranges, np.float32))
    assert len(view) == 2
    assert np.hypot(*view.ends[:, :2].T) == pytest.approx([0.1501, 11.9])


def test_angles_are_the_lidar_s_own_and_its_mount_is_the_robot_s() -> None:
    lidar = LidarModel(np.array([-0.5, 0.5]), 0.1, 5.0, Pose(0.1, 0.02, 0.5 * math.pi))
    view = lidar.view(np.array([1.0, 2.0], np.float32))
    ends = [
        (0.1 + math.sin(0.5), 0.02 + math.cos(0.5)),
        (0.1 - 2.0 * math.sin(0.5), 0.02 + 2.0 * math.cos(0.5)),
    ]
    assert view.ends[:, :2] == pytest.approx(np.array(ends))
    assert view.mount == pytest.approx([0.1, 0.02, 0.5 * math.pi])


def test_a_scan_in_which_nothing_came_back_is_empty() -> None:
    lidar = LidarModel.all_around(360, 0.15, 12.0)
    assert len(lidar.view(np.full(360, np.inf, np.float32))) == 0


@pytest.mark.parametrize("shape", [(359,), (361,), (0,), (360, 1), (1, 360)])
def test_another_number_of_beams_is_refused(shape: tuple[int, ...]) -> None:
    lidar = LidarModel.all_around(360, 0.15, 12.0)
    with pytest.raises(ValueError, match="expected a scan of 360 ranges, got shape"):
        lidar.view(np.ones(shape, np.float32))


def test_a_view_does_not_change_with_the_next_scan() -> None:
    lidar = LidarModel.all_around(4, 0.15, 12.0)
    first = lidar.view(np.ones(4, np.float32))
    before = first.ends.copy()
    lidar.view(np.full(4, 2.0, np.float32))
    assert (first.ends == before).all()


def test_ranges_that_lie_apart_or_may_not_be_written_are_copied_and_others_are_not() -> None:
    plain = np.arange(8, dtype=np.float32)
    fixed = plain.copy()
    fixed.flags.writeable = False
    assert plain_ranges(plain) is plain
    for odd in (fixed, plain[::-1], plain[::2]):
        made = plain_ranges(odd)
        assert made.tolist() == odd.tolist()
        assert made.flags.c_contiguous
        assert made.flags.writeable
