import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose, Twist, heading_of, old_in_new, wrap_angle

angles = st.floats(-50.0, 50.0)
metres = st.floats(-100.0, 100.0)
poses = st.builds(Pose, metres, metres, angles)


@given(angles)
def test_wrapped_angle_is_the_same_direction_within_half_a_turn(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


@given(angles, st.floats(0.1, 10.0))
def test_the_heading_of_a_quaternion_does_not_depend_on_its_length(
    angle: float, length: float
) -> None:
    z, w = length * math.sin(angle / 2.0), length * math.cos(angle / 2.0)
    turned = wrap_angle(heading_of(0.0, 0.0, z, w) - angle)
    assert turned == pytest.approx(0.0, abs=1e-9)
    assert heading_of(0.0, 0.0, 0.0, 0.0) == 0.0


def test_half_a_turn_is_wrapped_to_plus_pi() -> None:
    assert wrap_angle(-math.pi) == math.pi
    assert wrap_angle(3 * math.pi) == pytest.approx(math.pi)


@given(poses)
def test_inverse_undoes_a_pose(pose: Pose) -> None:
    there_and_back = pose.compose(pose.inverse())
    assert there_and_back.x == pytest.approx(0.0, abs=1e-9)
    assert there_and_back.y == pytest.approx(0.0, abs=1e-9)
    assert math.cos(there_and_back.theta) == pytest.approx(1.0)


@given(poses, poses)
def test_an_old_frame_lies_where_it_brings_a_place_to_what_that_is_now(
    before: Pose, after: Pose
) -> None:
    there = old_in_new(before, after).compose(before)
    assert (there.x, there.y) == pytest.approx((after.x, after.y), abs=1e-6)
    assert wrap_angle(there.theta - after.theta) == pytest.approx(0.0, abs=1e-9)
    assert old_in_new(before, before) == Pose()


def test_composition_turns_then_goes() -> None:
    ahead = Pose(1.0, 2.0, math.pi / 2).compose(Pose(3.0, 0.0, 0.1))
    assert (ahead.x, ahead.y) == pytest.approx((1.0, 5.0))
    assert ahead.theta == pytest.approx(math.pi / 2 + 0.1)


@given(poses, st.lists(st.tuples(metres, metres, metres), min_size=1, max_size=4))
def test_points_are_transformed_as_poses_are_composed(
    pose: Pose, rows: list[tuple[float, float, float]]
) -> None:
    points = np.array(rows)
    moved = pose.transform(points)
    for (x, y, height), row in zip(rows, moved.tolist(), strict=True):
        composed = pose.compose(Pose(x, y))
        assert row == pytest.approx([composed.x, composed.y, height])
    assert np.array_equal(points, rows)


def test_bearing_is_positive_to_the_left() -> None:
    assert Pose(0.0, 0.0, 0.0).bearing_to(1.0, 1.0) == pytest.approx(math.pi / 4)
    assert Pose(0.0, 0.0, math.pi).bearing_to(-1.0, 1.0) == pytest.approx(-math.pi / 4)


def test_only_numbers_can_be_driven() -> None:
    assert Twist(1.0, -1.0).is_finite
    assert not Twist(math.nan, 0.0).is_finite
    assert not Twist(0.0, math.inf).is_finite


def test_a_pose_of_numbers_that_are_none_is_not_finite() -> None:
    assert Pose(1.0, -2.0, 3.0).is_finite
    for bad in (math.nan, math.inf, -math.inf):
        assert not any(pose.is_finite for pose in (Pose(bad), Pose(0.0, bad), Pose(0.0, 0.0, bad)))
