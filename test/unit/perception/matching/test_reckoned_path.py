"""The recent poses by dead reckoning, at any time between two readings."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import wrap_angle
from roomba.perception.matching.reckoned_path import (
    ReckonedPath,
    forget_path,
    is_told_within,
    pose_at,
    pose_in,
    remember,
    stretch_at,
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


def test_how_often_it_is_told_is_known_from_the_second_pose_on() -> None:
    pose = np.zeros(3)
    path = ReckonedPath.empty()
    assert not is_told_within(path, 1.0)
    remember(path, 1.0, pose)
    # What an empty row of the ring says would be a time before.
    assert not is_told_within(path, 5.0)
    remember(path, 1.25, pose)
    assert is_told_within(path, 0.25)
    assert not is_told_within(path, 0.24)
    remember(path, 2.0, pose)
    assert not is_told_within(path, 0.5)
    forget_path(path)
    assert not is_told_within(path, 9.0)


def test_of_many_poses_in_a_second_the_newest_thousand_are_kept() -> None:
    path = told(*((1e-3 * index, float(index), 0.0, 0.0) for index in range(5000)))
    assert at(path, 4.9985) == pytest.approx([4998.5, 0.0, 0.0])
    assert at(path, 4.0) == pytest.approx([4000.0, 0.0, 0.0])
    assert at(path, 3.9) is None


TURN = st.floats(-math.pi, math.pi)


def going_on(path: ReckonedPath, stamp: float) -> list[float]:
    x, y, theta = pose_in(stretch_at(path, stamp), stamp)
    return [x, y, wrap_angle(theta)]


@given(
    st.lists(st.tuples(st.floats(0.001, 0.3), TURN), min_size=1, max_size=9), st.floats(0.0, 1.0)
)
def test_along_a_stretch_is_where_a_search_finds_the_robot(
    steps: list[tuple[float, float]], share: float
) -> None:
    stamps = np.cumsum([step for step, _ in steps])
    path = told(
        *(
            (float(t), 0.3 * float(t), -float(t), turn)
            for t, (_, turn) in zip(stamps, steps, strict=True)
        )
    )
    asked = float(stamps[0] + share * (stamps[-1] - stamps[0]))
    found, expected = going_on(path, asked), at(path, asked)
    assert expected is not None
    assert found[:2] == pytest.approx(expected[:2], abs=1e-9)
    assert wrap_angle(found[2] - expected[2]) == pytest.approx(0.0, abs=1e-9)


def test_a_stretch_holds_until_the_next_pose() -> None:
    path = told((1.0, 0.0, 0.0, 0.0), (2.0, 1.0, 0.0, 0.0), (3.0, 1.0, 1.0, 0.0))
    first = stretch_at(path, 1.5)
    assert first.until == 2.0
    assert pose_in(first, 1.75) == pytest.approx((0.75, 0.0, 0.0))
    assert stretch_at(path, first.until).until == 3.0


def test_before_all_poses_the_robot_stands_and_beyond_them_it_goes_on_for_half_a_second() -> None:
    path = told((1.0, 0.0, 0.0, 3.0), (1.2, 0.2, 0.1, -3.0))
    turn = 2.0 * math.pi - 6.0
    assert going_on(path, 0.9) == [0.0, 0.0, 3.0]
    assert stretch_at(path, 0.9).until == 1.0
    assert going_on(path, 1.3) == pytest.approx([0.3, 0.15, -3.0 + 0.5 * turn])
    for late in (1.7, 1.8, 9.0):
        assert going_on(path, late) == pytest.approx([0.7, 0.35, -3.0 + 2.5 * turn])


def test_one_pose_or_none_is_where_the_robot_stands() -> None:
    assert going_on(told((1.0, 0.5, 0.25, 2.0)), 4.0) == [0.5, 0.25, 2.0]
    assert going_on(ReckonedPath.empty(), 4.0) == [0.0, 0.0, 0.0]
