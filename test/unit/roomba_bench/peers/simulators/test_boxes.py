"""Solid cells as rectangles."""

from __future__ import annotations

import numpy as np

from roomba_bench.peers.simulators.boxes import boxes_of


def test_boxes_cover_each_solid_cell_once() -> None:
    solid = np.random.default_rng(3).random((40, 60)) < 0.3
    covered = np.zeros(solid.shape, int)
    for left, low, right, high in boxes_of(solid):
        covered[low:high, left:right] += 1
    assert np.array_equal(covered, solid.astype(int))


def test_a_room_is_four_boxes_and_no_room_is_none() -> None:
    walls = np.ones((8, 12), bool)
    walls[1:-1, 1:-1] = False
    assert len(boxes_of(walls)) == 4
    assert boxes_of(~np.ones((3, 3), bool)).shape == (0, 4)
