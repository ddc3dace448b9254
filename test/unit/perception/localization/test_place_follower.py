"""A known place followed: carried by dead reckoning, corrected by scans."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.located import CONFIG, FURNISHED, LIDAR, START, Eye

from roomba.geometry import Pose, wrap_angle
from roomba.perception.localization.place_follower import PlaceFollower

_SPREAD = np.diag([0.05**2, 0.05**2, 0.05**2])
_PERIOD = 0.1
"""s; between two readings, odometry and a scan each."""


def follower(at: Pose = START) -> PlaceFollower:
    followed = PlaceFollower(FURNISHED.map, CONFIG.localization, CONFIG.gyro, 1)
    followed.begin_at(at, _SPREAD)
    return followed


def turned(seconds: float) -> Pose:
    """Return where a robot is that turns to and fro on the spot, map frame."""
    return replace(START, theta=START.theta + 0.8 * math.sin(1.5 * seconds))


def turn_and_see(
    followed: PlaceFollower, late: float, seconds: float, begins_anew: bool = False
) -> None:
    """Turn to and fro; scans are stamped so much later than they were taken, s.

    ``begins_anew``: before each scan the pose is told anew.
    """
    eye = Eye(FURNISHED)
    for index in range(round(seconds / _PERIOD)):
        now = index * _PERIOD
        odometry = START.inverse().compose(turned(now))
        followed.reckoning.move(now, odometry, None)
        view = LIDAR.view(eye.scan(turned(now - late)))
        taken = now - followed.latency
        reckoned = followed.reckoning.at(taken)
        if begins_anew:
            followed.begin_at(turned(now), _SPREAD)
        if reckoned is not None:
            followed.correct(view, taken, reckoned, tells_places_apart=True)


def test_a_scan_draws_the_pose_to_where_it_fits() -> None:
    followed = follower(Pose(START.x + 0.04, START.y - 0.03, START.theta + 0.03))
    followed.reckoning.move(0.0, Pose(0.0, 0.0, 0.0), None)
    view = LIDAR.view(Eye(FURNISHED).scan(START))
    for _ in range(3):
        followed.correct(view, 0.0, followed.reckoning.pose, tells_places_apart=True)
    assert followed.tracker.pose.distance_to(START.x, START.y) < 0.005
    assert abs(wrap_angle(followed.tracker.pose.theta - START.theta)) < 0.005
    assert followed.position_deviation < 0.02
    assert followed.heading_deviation < 0.02


def test_a_scan_that_tells_no_places_apart_has_no_fit() -> None:
    followed = follower()
    followed.reckoning.move(0.0, Pose(0.0, 0.0, 0.0), None)
    view = LIDAR.view(Eye(FURNISHED).scan(START))
    here = followed.reckoning.pose
    assert followed.correct(view, 0.0, here, tells_places_apart=False) is None
    fit = followed.correct(view, 0.0, here, tells_places_apart=True)
    assert fit is not None
    assert fit.agree > 0.95


def test_the_pose_of_then_is_as_far_back_as_dead_reckoning_says() -> None:
    followed = follower()
    followed.reckoning.move(0.0, Pose(0.0, 0.0, 0.0), None)
    followed.reckoning.move(1.0, Pose(0.3, 0.0, 0.0), None)
    then = followed.pose_then(Pose(0.0, 0.0, 0.0))
    assert followed.tracker.pose.distance_to(then.x, then.y) == pytest.approx(0.3, abs=0.02)


@pytest.mark.parametrize("late", [0.0, 0.2])
def test_it_learns_how_late_scans_are(late: float) -> None:
    followed = follower()
    turn_and_see(followed, late, 20.0)
    assert followed.latency == pytest.approx(late, abs=0.026)


def test_turns_across_changes_of_the_pose_teach_no_latency() -> None:
    followed = follower()
    turn_and_see(followed, 0.2, 20.0, begins_anew=True)
    assert followed.latency == 0.0


def test_without_a_map_it_goes_where_dead_reckoning_goes() -> None:
    followed = PlaceFollower(None, CONFIG.localization, CONFIG.gyro, 1)
    followed.begin_at(START, _SPREAD)
    followed.reckoning.move(0.0, Pose(0.0, 0.0, 0.0), None)
    followed.reckoning.move(1.0, Pose(0.2, 0.0, 0.5), None)
    expected = START.compose(Pose(0.2, 0.0, 0.5))
    assert followed.tracker.pose.distance_to(expected.x, expected.y) < 0.02
