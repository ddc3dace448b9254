"""Where dead reckoning had the robot lately: any time is found between what was told."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.perception.matching.reckoned_path import (
    ReckonedPath,
    forget_path,
    pose_at,
    remember,
)


def told(*rows: tuple[float, float, float, float]) -> ReckonedPath:
    path = ReckonedPath.empty()
    for stamp, *pose in rows:
        remember(path, stamp, np.array(pose))
    return path


def at(path: ReckonedPath, stamp: float) -> list[float] | None:
    pose = np.full(3, 9.0)
    return pose.tolist() if pose_at(path, stamp, pose) else None


def test_between_two_poses_the_way_is_straight_and_the_turn_the_short_one() -> None:
    path = told((1.0, 0.0, 0.0, 3.0), (1.5, 1.0, -2.0, -3.0))
    half = math.pi - 3.0
    assert at(path, 1.125) == pytest.approx([0.25, -0.5, 3.0 + 0.5 * half])
    assert at(path, 1.375) == pytest.approx([0.75, -1.5, -3.0 - 0.5 * half])
    assert at(path, 1.0) == [0.0, 0.0, 3.0]
    assert at(path, 1.5) == at(path, 7.0) == [1.0, -2.0, -3.0]
    assert at(path, 0.99) is None


def test_nothing_is_known_before_the_first_pose_and_after_all_was_forgotten() -> None:
    path = told((1.0, 1.0, 1.0, 1.0))
    forget_path(path)
    assert at(path, 1.0) is at(ReckonedPath.empty(), 1.0) is None


@given(st.lists(st.floats(0.0005, 3.0), min_size=1, max_size=60), st.floats(0.0, 4.0))
def test_it_is_what_a_search_through_all_finds(steps: list[float], back: float) -> None:
    """Of the last two seconds, all of them; a robot that drives at 0.3 m/s by its stamps."""
    stamps = np.cumsum(steps)
    path = told(*((stamp, 0.3 * stamp, 0.0, 0.0) for stamp in stamps.tolist()))
    first = np.searchsorted(stamps, stamps[-1] - 2.0)
    asked = float(stamps[-1] - back)
    found = at(path, asked)
    if asked < stamps[max(first - 1, 0)]:
        assert found is None
    else:
        assert found is not None
        assert found[0] == pytest.approx(0.3 * asked, abs=1e-9)


def test_odometry_that_is_told_seldom_is_known_between_its_newest_two() -> None:
    path = told((0.0, 0.0, 0.0, 0.0), (3.0, 3.0, 0.0, 0.0), (6.0, 9.0, 0.0, 0.0))
    assert at(path, 5.95) == pytest.approx([8.9, 0.0, 0.0])


def test_of_many_poses_in_a_second_the_newest_thousand_are_kept() -> None:
    path = told(*((1e-3 * index, float(index), 0.0, 0.0) for index in range(5000)))
    assert at(path, 4.9985) == pytest.approx([4998.5, 0.0, 0.0])
    assert at(path, 4.0) == pytest.approx([4000.0, 0.0, 0.0])
    assert at(path, 3.9) is None
