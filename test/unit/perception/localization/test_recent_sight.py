"""Seeing what was seen before: what tells a robot that was carried from a home that was changed."""

from __future__ import annotations

import pytest
from fixtures.robots.located import CONFIG, FURNISHED, LIDAR, MOVED, TWO_ROOMS, Eye, free_poses
from numpy.random import default_rng

from roomba.geometry import Pose
from roomba.perception.localization.recent_sight import RecentSight
from roomba.world.home.home import Home

START = Pose(-2.0, 5.0, 1.0)
"""Dead reckoning's frame lies anywhere."""


def reckoned(pose: Pose, start: Pose) -> Pose:
    """Return where dead reckoning says that a robot is, which set out from a pose."""
    return START.compose(start.inverse().compose(pose))


@pytest.mark.parametrize("home", [FURNISHED, MOVED, TWO_ROOMS])
def test_driving_on_it_sees_what_it_saw(home: Home) -> None:
    eye, random = Eye(home), default_rng(1)
    for pose in free_poses(home, 20, random):
        sight = RecentSight(CONFIG.localization.recent_sight)
        sight.note(10.0, START, LIDAR.view(eye.scan(pose, random)))
        for step in (Pose(0.15, 0.05, 0.4), Pose(-0.2, 0.0, 2.0), Pose(0.0, 0.0, -3.0)):
            there = pose.compose(step)
            view = LIDAR.view(eye.scan(there, random))
            assert sight.is_still(12.0, reckoned(there, pose), view)


@pytest.mark.parametrize("home", [FURNISHED, TWO_ROOMS])
def test_carried_away_it_sees_something_else(home: Home) -> None:
    eye, random = Eye(home), default_rng(2)
    poses = free_poses(home, 40, random)
    fooled = 0
    for pose, there in zip(poses[::2], poses[1::2], strict=True):
        sight = RecentSight(CONFIG.localization.recent_sight)
        sight.note(10.0, START, LIDAR.view(eye.scan(pose, random)))
        fooled += sight.is_still(12.0, START, LIDAR.view(eye.scan(there, random)))
    assert fooled == 0


def test_what_it_saw_just_now_or_long_ago_tells_nothing() -> None:
    view = LIDAR.view(Eye(FURNISHED).scan(Pose(1.0, 1.0, 0.3)))
    sight = RecentSight(CONFIG.localization.recent_sight)
    assert not sight.is_still(10.0, START, view)
    sight.note(10.0, START, view)
    assert not sight.is_still(10.5, START, view)
    assert sight.is_still(11.5, START, view)
    assert not sight.is_still(20.0, START, view)


def test_a_clock_that_is_set_back_begins_anew() -> None:
    view = LIDAR.view(Eye(FURNISHED).scan(Pose(1.0, 1.0, 0.3)))
    sight = RecentSight(CONFIG.localization.recent_sight)
    sight.note(1000.0, START, view)
    sight.note(10.0, START, view)
    assert sight.is_still(11.5, START, view)
    assert not sight.is_still(1001.5, START, view)


def test_with_nothing_in_sight_nothing_is_the_same() -> None:
    scan = Eye(FURNISHED).scan(Pose(1.0, 1.0, 0.3))
    view, nothing = LIDAR.view(scan), LIDAR.view(scan * 0.0)
    sight = RecentSight(CONFIG.localization.recent_sight)
    sight.note(10.0, START, nothing)
    assert not sight.is_still(12.0, START, view)
    sight = RecentSight(CONFIG.localization.recent_sight)
    sight.note(10.0, START, view)
    assert not sight.is_still(12.0, START, nothing)
