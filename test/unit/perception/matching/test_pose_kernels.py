"""Poses seen from others: they agree with the composition of poses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.matching.pose_kernels import beyond, is_apart, seen_from

metres = st.floats(-20.0, 20.0)
poses = st.builds(Pose, metres, metres, st.floats(-3.1, 3.1))


def row(pose: Pose) -> NDArray[np.float64]:
    return np.array([pose.x, pose.y, pose.theta])


def assert_same(found: tuple[float, float, float], expected: Pose) -> None:
    assert found[:2] == pytest.approx((expected.x, expected.y), abs=1e-9)
    assert math.remainder(found[2] - expected.theta, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)


@given(poses, poses)
def test_beyond_a_pose_lies_what_is_composed_with_it(pose: Pose, step: Pose) -> None:
    found = beyond(pose.x, pose.y, pose.theta, step.x, step.y, step.theta)
    assert_same(found, pose.compose(step))


@given(poses, poses)
def test_a_pose_sees_another_as_its_inverse_composed_with_that(pose: Pose, other: Pose) -> None:
    assert_same(seen_from(row(pose), row(other)), pose.inverse().compose(other))


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        ((0.1, 0.0, 0.1), False),
        ((0.0, 0.3, 0.1), True),
        ((0.1, 0.0, 0.5), True),
        ((0.0, 0.0, 2.0 * math.pi - 0.1), False),
    ],
)
def test_poses_are_apart_by_their_way_or_their_turn(
    other: tuple[float, float, float], expected: bool
) -> None:
    assert is_apart(np.zeros(3), np.array(other), 0.2, 0.4) == expected
