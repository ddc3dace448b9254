"""Submaps: their keyframes, and the points that are matched to others."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, START, Floats, points_of
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.perception.slam.submaps.submap import Keyframe, Submap, moved

POINTS = points_of(Eye(FURNISHED).scan(START)).astype(np.float32)
pose_rows = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-3.1, 3.1)).map(
    np.array
)


def submap(*poses: tuple[float, float, float]) -> Submap:
    return Submap(0.0, [Keyframe(POINTS, np.array(pose)) for pose in poses])


@given(pose_rows)
def test_points_move_and_normals_turn_with_a_pose(pose: Floats) -> None:
    there = moved(POINTS, pose)
    for before, after in list(zip(POINTS.astype(np.float64), there, strict=True))[::40]:
        at = Pose(*pose).compose(Pose(*before[:2]))
        assert after[:2] == pytest.approx((at.x, at.y))
        facing = Pose(0.0, 0.0, pose[2]).compose(Pose(*before[2:]))
        assert after[2:] == pytest.approx((facing.x, facing.y))
    back = Pose(*pose).inverse()
    assert moved(there, np.array([back.x, back.y, back.theta])) == pytest.approx(POINTS, abs=1e-9)


@pytest.mark.parametrize("most", [50, 300, 5000])
def test_closed_it_has_points_with_surfaces_only_and_not_too_many(most: int) -> None:
    closed = submap((0.0, 0.0, 0.0), (0.2, 0.0, 0.1), (0.4, 0.1, 0.2))
    closed.close(most)
    assert 0.4 * min(most, 3 * len(POINTS)) < len(closed.cloud) <= most
    assert np.hypot(closed.cloud[:, 2], closed.cloud[:, 3]) == pytest.approx(1.0, abs=1e-5)
    # From all of its keyframes.
    first = moved(POINTS, np.zeros(3))
    last = moved(POINTS, np.array([0.4, 0.1, 0.2]))
    for part in (first, last):
        assert (np.abs(part[:, None, :2] - closed.cloud[None, :, :2]).max(axis=2) < 1e-9).any()


def test_without_keyframes_it_is_empty() -> None:
    empty = Submap(1.0)
    empty.close(100)
    assert empty.cloud.shape == (0, 4)
    assert empty.poses(np.zeros(3)).shape == (0, 3)


@given(pose_rows)
def test_keyframes_lie_where_the_submap_does(pose: Floats) -> None:
    inner = (0.3, -0.2, 0.5)
    found = submap((0.0, 0.0, 0.0), inner).poses(pose)
    expected = Pose(*pose).compose(Pose(*inner))
    assert found[0] == pytest.approx(pose)
    assert found[1] == pytest.approx((expected.x, expected.y, expected.theta))
