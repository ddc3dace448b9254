"""Floors, boxes, and the independent reference for shortest ways."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.grid import GridFrame
from roomba_bench.floors import Floor, Mask, building, far_corners, free_poses, room_for
from roomba_bench.peers.boxes import boxes_of
from roomba_bench.peers.grids import links, path_facts
from roomba_bench.shortest import ShortestWays

FRAME = GridFrame(0.1, -1.0, 2.0, 40, 60)


def random_floor(share: float = 0.3) -> Mask:
    return np.random.default_rng(3).random(FRAME.shape) < share


def test_boxes_cover_each_solid_cell_once() -> None:
    solid = random_floor()
    covered = np.zeros(solid.shape, int)
    for left, low, right, high in boxes_of(solid):
        covered[low:high, left:right] += 1
    assert np.array_equal(covered, solid.astype(int))


def test_a_room_is_four_boxes_and_no_room_is_none() -> None:
    walls = np.ones((8, 12), bool)
    walls[1:-1, 1:-1] = False
    assert len(boxes_of(walls)) == 4
    assert boxes_of(~np.ones((3, 3), bool)).shape == (0, 4)


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


def test_path_facts_count_length_and_corners_cut() -> None:
    fits = np.array([[True, False], [True, True]])
    cut = path_facts(fits, np.array([[0, 0], [1, 1]]))
    assert cut == {"length": pytest.approx(2**0.5), "corners cut": 1.0}
    around = path_facts(fits, np.array([[0, 0], [1, 0], [1, 1]]))
    assert around == {"length": 2.0, "corners cut": 0.0}
    with pytest.raises(ValueError, match="closed cells"):
        path_facts(fits, np.array([[0, 0], [0, 1]]))


def test_links_cut_no_corners() -> None:
    first, second, cost = links(np.array([[True, False], [True, True]]))
    assert sorted(zip(first, second, cost, strict=True)) == [(0, 2, 1.0), (2, 3, 1.0)]


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
