"""The best pose of a wide window: the same as by trying all poses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, Floats, points_of, row
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose
from roomba.perception.slam.scan_matching.correlative import CorrelativeMatcher
from roomba.perception.slam.submaps.submap import moved

REACH = MappingConfig().search_reach
HERE = Pose(2.5, 1.2, 0.0)
ROOM = moved(points_of(Eye(FURNISHED).scan(HERE)), row(HERE))
POINTS = np.column_stack((ROOM[:, :2], np.zeros_like(ROOM[:, :2])))
"""The room's, without normals: nothing is known of what is between them."""
MATCHER = CorrelativeMatcher(POINTS, REACH)


def likelihood(points: Floats, pose: Floats) -> float:
    """The mean likelihood of points, by the distance to the nearest one of the room, m."""
    there = moved(np.column_stack((points[:, :2], points[:, :2])), pose)[:, :2]
    away = np.hypot(*(there[:, None] - ROOM[None, :, :2]).transpose(2, 0, 1)).min(axis=1)
    return float(np.exp(-0.5 * (away / 0.06) ** 2).mean())


@given(st.floats(0.6, 4.4), st.floats(0.6, 3.0), st.floats(-3.1, 3.1), st.integers(0, 9999))
@settings(max_examples=examples(12), deadline=None)
def test_a_scan_is_found_however_bad_the_guess(x: float, y: float, theta: float, seed: int) -> None:
    if FURNISHED.solid[FURNISHED.frame.cell_of(x, y)]:
        return
    points = points_of(Eye(FURNISHED).scan(Pose(x, y, theta)))
    off = np.random.default_rng(seed).uniform(-1.0, 1.0, 3) * (0.9, 0.9, 0.6)
    found = MATCHER.best(points, np.array([x, y, theta]) + off, 1.0, 0.7, 0.3)
    assert found is not None
    if likelihood(points, np.array([x, y, theta])) < likelihood(points, found.pose) - 0.02:
        return  # what stands before the other walls hides them: another pose fits better
    assert math.hypot(found.pose[0] - x, found.pose[1] - y) < 0.12
    assert abs(math.remainder(found.pose[2] - theta, 2.0 * math.pi)) < 0.04


def test_no_other_pose_of_the_window_is_better() -> None:
    """The whole window is tried, cell by cell and step by step."""
    points = points_of(Eye(FURNISHED).scan(Pose(2.0, 1.5, 0.4)))[::6]
    around = np.array([2.2, 1.35, 0.45])
    found = MATCHER.best(points, around, 0.3, 0.1, 0.1)
    assert found is not None
    shifts, turns = np.arange(-0.3, 0.31, 0.05), np.arange(-0.108, 0.109, 0.012)
    best = max(
        likelihood(points, around + np.array([x, y, turn]))
        for x in shifts
        for y in shifts
        for turn in turns
    )
    assert likelihood(points, found.pose) > best - 0.03


def test_what_fits_nowhere_is_not_found() -> None:
    points = np.random.default_rng(1).uniform(-2.0, 2.0, (200, 2))
    assert MATCHER.best(points, row(HERE), 0.5, 0.5, 0.6) is None
    assert MATCHER.best(np.zeros((0, 2)), row(HERE), 0.5, 0.5, 0.0) is None


def test_a_place_without_points_is_refused() -> None:
    with pytest.raises(ValueError, match="points in reach"):
        CorrelativeMatcher(np.full((3, 4), 100.0), REACH)


def corridor(doors: list[float]) -> Floats:
    """Points of a corridor of 20 m along x, with recesses 0.9 m wide in one wall."""
    along = np.arange(-10.0, 10.0, 0.04)
    is_door = np.any([np.abs(along - door) < 0.45 for door in doors], axis=0)
    left, right = np.where(is_door, 1.2, 1.0), np.full(len(along), -1.0)
    return np.concatenate([np.column_stack((along, left)), np.column_stack((along, right))])


def test_where_all_looks_alike_no_place_is_unique() -> None:
    """Doors each 4 m: a place 4 m ahead fits nearly as well. A cross corridor is unlike it."""
    doors = [-8.0, -4.0, 0.0, 4.0, 8.0]
    around, around_window = np.zeros(3), 6.0
    seen = corridor(doors)[::2]
    seen = seen[np.abs(seen[:, 0]) < 4.0]
    alike = CorrelativeMatcher(corridor(doors), REACH)
    across = np.column_stack((np.full(300, 1.5), np.linspace(1.0, 7.0, 300)))
    with_corner = np.concatenate((seen, across))
    unlike = CorrelativeMatcher(np.concatenate((corridor(doors), across)), REACH)
    for matcher, points, expected in ((alike, seen, False), (unlike, with_corner, True)):
        found = matcher.best(points, around, around_window, 0.2, 0.3)
        assert found is not None
        unique = matcher.is_unique(points, found, around, around_window, 0.2)
        assert unique == expected
        assert not unique or np.abs(found.pose[:2]).max() < 0.06


def test_what_is_farther_than_the_reach_says_nothing() -> None:
    """Of the place nothing is known there; in a large hall most points lie so far off."""
    near, far = POINTS[:, :2], np.column_stack((np.linspace(-9.0, 9.0, 300), np.full(300, 30.0)))
    for points, score in ((near, score_of(near)), (far, 0.0)):
        assert score_of(np.concatenate((points, far))) == pytest.approx(score, abs=0.02)


def score_of(points: Floats) -> float:
    """The mean likelihood of points where they are."""
    found = MATCHER.best(points, np.zeros(3), 0.0, 0.0, 0.0)
    return 0.0 if found is None else found.score
