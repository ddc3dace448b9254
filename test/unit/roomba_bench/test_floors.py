"""Floors, and the independent reference for shortest ways."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.arrays import Mask
from roomba.grid import GridFrame
from roomba_bench.floors import Floor, building, far_corners, free_poses, room_for
from roomba_bench.shortest import ShortestWays

FRAME = GridFrame(0.1, -1.0, 2.0, 40, 60)


def random_floor(share: float = 0.3) -> Mask:
    return np.random.default_rng(3).random(FRAME.shape) < share


def test_a_building_is_the_same_each_time_and_most_of_it_is_one_floor() -> None:
    floor = ~building(400)
    assert np.array_equal(floor, ~building(400))
    start, goal = far_corners(floor)
    assert sum(start) < 100
    assert sum(goal) > 700


def test_free_poses_have_room() -> None:
    solid = random_floor(0.02)
    floor = Floor("random", solid, FRAME)
    room = room_for(floor, 0.2)
    for x, y, theta in free_poses(floor, 50, room=0.2):
        assert room[FRAME.cell_of(x, y)]
        assert -math.pi <= theta <= math.pi


def test_the_shortest_way_leads_around_a_wall() -> None:
    solid = np.zeros(FRAME.shape, bool)
    solid[:30, 30] = True  # from (2.0, 2.0) up to (2.1, 5.0)
    ways = ShortestWays(solid, FRAME, 0.0)
    straight = ways.length((0.0, 5.5), (4.0, 5.5))
    assert straight == pytest.approx(4.0)
    over = ways.length((0.0, 5.0 - 1.5), (4.1, 5.0 - 1.5))
    assert over == pytest.approx(2 * math.hypot(2.0, 1.5) + 0.1)


def test_a_disc_keeps_its_radius_from_a_corner() -> None:
    solid = np.zeros(FRAME.shape, bool)
    solid[:30, 30] = True
    way = ShortestWays(solid, FRAME, 0.5).length((0.0, 5.5), (4.1, 5.5))
    assert way == pytest.approx(4.1)
    lower = ShortestWays(solid, FRAME, 0.5).length((0.0, 5.0), (4.1, 5.0))
    tangent, turn = math.hypot(2.0, 0.0) ** 2 - 0.5**2, math.asin(0.5 / 2.0)
    assert lower == pytest.approx(2 * (math.sqrt(tangent) + 0.5 * turn) + 0.1, rel=2e-3)


def test_no_way_is_infinitely_long() -> None:
    solid = np.zeros(FRAME.shape, bool)
    solid[10:31, [5, 25]] = solid[[10, 30], 5:26] = True  # around (0.5, 4.0)
    ways = ShortestWays(solid, FRAME, 0.1)
    assert ways.length((0.5, 4.0), (4.0, 4.0)) == math.inf
    assert ways.length((0.0, 4.0), (1.0, 4.5)) == pytest.approx(math.hypot(1.0, 0.5))
