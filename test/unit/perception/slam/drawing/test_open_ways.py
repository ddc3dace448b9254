"""What beams without an echo show to be open, near the lidar."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.drawing.open_ways import open_ways

NEAREST, FARTHEST = 0.16, 8.0
NO_ECHO = st.sampled_from((math.inf, math.nan, 0.0, 8.0, 81.83))


def ways(ranges: NDArray[np.float64], mount: Pose | None = None) -> NDArray[np.float32]:
    """Return the open ways of a scan all around, beam 0 ahead: up to 1 m, 0.1 m before walls."""
    lidar = LidarModel.all_around(len(ranges), NEAREST, FARTHEST)
    if mount is not None:
        angles = np.linspace(0.0, math.tau, len(ranges), endpoint=False)
        lidar = LidarModel(angles, NEAREST, FARTHEST, mount)
    return open_ways(ranges.astype(np.float32), lidar.arrays(), 1.0, 0.1)


def round_room(length: float, beams: int = 360) -> NDArray[np.float64]:
    return np.full(beams, length)


@given(NO_ECHO, st.integers(0, 359), st.integers(1, 300))
def test_between_far_walls_the_way_is_open_for_a_metre(
    no_echo: float, first: int, count: int
) -> None:
    ranges = round_room(3.0)
    without = (first + np.arange(count)) % 360
    ranges[without] = no_echo
    found = ways(ranges)
    assert len(found) == count
    assert np.hypot(*found.T) == pytest.approx(np.ones(count), abs=1e-5)
    angles = np.degrees(np.arctan2(found[:, 1], found[:, 0])) % 360.0
    assert sorted(np.round(angles).astype(int) % 360) == sorted(without)


def test_beside_a_near_wall_it_ends_before_that() -> None:
    """A wall that is seen where it is met squarely, and goes on past where it is not."""
    ranges = round_room(3.0)
    ranges[80:100], ranges[100:140] = 0.5, math.inf
    assert np.hypot(*ways(ranges).T) == pytest.approx(np.full(40, 0.4), abs=1e-5)
    ranges[80:100] = 0.18
    assert np.hypot(*ways(ranges).T) == pytest.approx(np.full(40, 0.08), abs=1e-5)


def test_what_is_too_near_to_be_measured_is_no_open_way() -> None:
    """REP 117 tells it as minus infinity."""
    ranges = round_room(3.0)
    ranges[10:14], ranges[14:20] = math.inf, -math.inf
    assert len(ways(ranges)) == 4


def test_where_nothing_was_met_nothing_is_known() -> None:
    assert len(ways(np.full(360, math.inf))) == 0
    assert len(ways(round_room(3.0))) == 0


def test_ways_begin_at_the_lidar_and_look_as_it_does() -> None:
    ranges = round_room(3.0)
    ranges[0] = math.inf
    [found] = ways(ranges, Pose(0.3, -0.1, 0.5 * math.pi))
    assert found == pytest.approx([0.3, 0.9], abs=1e-5)
