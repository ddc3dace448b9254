"""Matching a scan from a pose that is tried, and choosing beams."""

from __future__ import annotations

import math

import numpy as np
from fixtures.robots.located import FURNISHED, LIDAR, Eye
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose, wrap_angle
from roomba.perception.localization.search.matched import FROM_NEAR, evenly_chosen, matched
from roomba.perception.matching.surface_field import SurfaceField

HERE = Pose(1.4, 2.6, math.pi - 0.02)
FIELD = SurfaceField.of(FURNISHED.map)


def test_a_scan_fits_best_where_it_was_taken_and_the_heading_is_one_turn_at_most() -> None:
    view = LIDAR.view(Eye(FURNISHED).scan(HERE))
    pose, fit = matched(view, FIELD, Pose(1.5, 2.5, -math.pi + 0.1), 0.03)
    assert pose.distance_to(HERE.x, HERE.y) < 0.01
    assert abs(wrap_angle(pose.theta - HERE.theta)) < 0.01
    assert -math.pi <= pose.theta <= math.pi
    assert fit.agree > 0.95


def test_from_near_what_is_farther_off_does_not_draw_it() -> None:
    view = LIDAR.view(Eye(FURNISHED).scan(HERE))
    start = Pose(HERE.x + 0.6, HERE.y - 0.5, HERE.theta + 0.3)
    near, _ = matched(view, FIELD, start, 0.03, FROM_NEAR)
    afar, _ = matched(view, FIELD, start, 0.03)
    assert near.distance_to(start.x, start.y) <= afar.distance_to(start.x, start.y)


@given(st.integers(0, 3000), st.integers(1, 400))
def test_beams_are_chosen_evenly_from_the_first_to_the_last(count: int, most: int) -> None:
    chosen = evenly_chosen(count, most)
    assert len(chosen) <= most
    if count >= 1:
        assert chosen[0] == 0
        assert (np.diff(chosen) > 0).all()
        assert most == 1 or chosen[-1] == count - 1
        assert len(chosen) == min(count, most)
    if count > most > 1:
        assert np.ptp(np.diff(chosen)) <= 1


def test_none_of_no_beams_is_chosen() -> None:
    assert evenly_chosen(0, 48).tolist() == []
