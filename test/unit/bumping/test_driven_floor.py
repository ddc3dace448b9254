"""The way back over floor where the robot has been, and floor that this way must not use."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from roomba.bumping.driven_floor import DrivenFloor
from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import Pose

CONFIG = BumpingConfig()
WAY = ((0.0, 0.0), (0.0, 3.0), (4.0, 3.0), (4.0, -1.0))
"""Corners, m: from the first one through a door to a room beside it."""


@pytest.fixture
def floor() -> DrivenFloor:
    driven = DrivenFloor(CONFIG)
    for (x, y), (to_x, to_y) in pairwise(WAY):
        for share in np.linspace(0.0, 1.0, 300):
            driven.drive(Pose(x + share * (to_x - x), y + share * (to_y - y), 0.0))
    return driven


def test_it_leads_back_along_the_way_and_not_through_the_wall(floor: DrivenFloor) -> None:
    floor.lead_to(*WAY[0])
    pose, passed = Pose(*WAY[-1], 0.0), 0.0
    corners = set()
    while pose.distance_to(*WAY[0]) > CONFIG.driven_ahead:
        following = floor.next_from(pose)
        assert following is not None
        assert pose.distance_to(*following) <= CONFIG.driven_ahead + 2.0 * CONFIG.driven_cell
        passed += pose.distance_to(*following)
        pose = Pose(*following, 0.0)
        corners |= {corner for corner in WAY[1:3] if pose.distance_to(*corner) < 1.0}
        assert passed < 15.0
    assert corners == set(WAY[1:3])


def test_beside_the_way_it_is_led_to_it_and_far_from_it_not(floor: DrivenFloor) -> None:
    floor.lead_to(*WAY[0])
    beside = floor.next_from(Pose(0.4, 2.0, 0.0))
    assert beside is not None
    assert beside[0] < 0.1
    assert floor.next_from(Pose(2.0, 1.0, 0.0)) is None


def test_a_place_that_was_not_driven_is_come_as_near_as_was(floor: DrivenFloor) -> None:
    floor.lead_to(-0.5, -0.5)
    assert floor.next_from(Pose(0.1, 0.1, 0.0)) == pytest.approx((0.05, 0.05), abs=0.11)


def test_without_a_way_it_leads_nowhere(floor: DrivenFloor) -> None:
    assert floor.next_from(Pose()) is None
    floor.forget()
    floor.lead_to(0.0, 0.0)
    assert floor.next_from(Pose()) is None
