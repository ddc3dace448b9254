"""Poses as matrices, beside the library's own poses."""

from __future__ import annotations

import pytest

from roomba.geometry import Pose
from roomba_bench.peers.matching.matrices import matrix_of, pose_of


def test_matrices_go_on_as_poses_do_and_come_back() -> None:
    first, then = Pose(1.0, -2.0, 2.5), Pose(0.3, 0.4, 1.5)
    composed = first.compose(then)
    told = pose_of(
        matrix_of((first.x, first.y, first.theta)) @ matrix_of((then.x, then.y, then.theta))
    )
    assert told == pytest.approx((composed.x, composed.y, composed.theta))
