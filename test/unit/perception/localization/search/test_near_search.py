"""Looking around a pose: slips and turns that no wheel told are found, and nothing behind walls."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.robots.located import CONFIG, FURNISHED, LIDAR, START, Eye, Located, steps

from roomba.geometry import Pose, Twist, wrap_angle
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.search.near_search import best_near, better_near
from roomba.perception.matching.surface_field import SurfaceField

HERE = Pose(1.4, 2.6, 0.7)
FIELD = SurfaceField.of(FURNISHED.map)


@pytest.mark.parametrize("off", [Pose(0.0, 0.0, 0.6), Pose(0.45, -0.3, -0.4), Pose(-0.5, 0.5, 0.0)])
def test_a_pose_that_is_off_by_half_a_metre_is_found(off: Pose) -> None:
    view = LIDAR.view(Eye(FURNISHED).scan(HERE))
    around = Pose(HERE.x + off.x, HERE.y + off.y, HERE.theta + off.theta)
    found = best_near(view, FIELD, around, CONFIG.localization)
    assert found is not None
    pose, fit = found
    assert pose.distance_to(HERE.x, HERE.y) < 0.01
    assert abs(wrap_angle(pose.theta - HERE.theta)) < 0.01
    assert fit.agree > 0.95


def test_the_heading_that_is_found_is_one_turn_at_most() -> None:
    here = Pose(HERE.x, HERE.y, math.pi - 0.1)
    view = LIDAR.view(Eye(FURNISHED).scan(here))
    found = best_near(view, FIELD, Pose(here.x, here.y, -math.pi + 0.3), CONFIG.localization)
    assert found is not None
    assert found[0].theta == pytest.approx(here.theta, abs=0.01)


def test_where_nothing_has_room_nothing_is_found() -> None:
    view = LIDAR.view(Eye(FURNISHED).scan(HERE))
    assert best_near(view, FIELD, Pose(-5.0, -5.0, 0.0), CONFIG.localization) is None
    nothing = LIDAR.view(np.full(LIDAR.beams, np.inf, np.float32))
    assert best_near(nothing, FIELD, HERE, CONFIG.localization) is None


def test_a_place_near_by_is_better_only_if_a_scan_fits_it_clearly_more_and_as_usual() -> None:
    view, config = LIDAR.view(Eye(FURNISHED).scan(HERE)), CONFIG.localization
    off = Pose(HERE.x + 0.3, HERE.y - 0.2, HERE.theta + 0.4)
    found = better_near(view, FIELD, off, (0.98, 0.0), config)
    assert found is not None
    assert found[0].distance_to(HERE.x, HERE.y) < 0.01
    assert better_near(view, FIELD, HERE, (0.98, 0.0), config) is None
    # Better than that no scan fits: what is usual was seen somewhere else.
    assert better_near(view, FIELD, off, (1.3, 0.0), config) is None
    assert better_near(view, FIELD, off, (0.98, -0.2), config) is None
    assert better_near(view, FIELD, Pose(-5.0, -5.0, 0.0), (0.98, 0.0), config) is None


def test_a_push_that_no_wheel_told_costs_no_search_of_the_whole_map() -> None:
    robot = Located(FURNISHED, START)
    for _ in steps(2.0):
        robot.step(Twist())
    pushed = robot.world.pose.compose(Pose(0.3, 0.1, -0.5))
    robot.world.put(pushed)
    states = set()
    for _ in steps(2.0):
        robot.step(Twist())
        states.add(robot.estimate.knowledge)
    assert states == {Knowledge.KNOWN}
    assert robot.error < 0.02
