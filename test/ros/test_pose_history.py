"""Where the robot was at a time, by the poses that were told."""

import math

import pytest

from roomba.geometry import Pose
from roomba_ros.localization.pose_history import PoseHistory


def history(*told: tuple[float, Pose]) -> PoseHistory:
    poses = PoseHistory()
    for stamp, pose in told:
        poses.add(stamp, pose)
    return poses


def test_between_two_poses_the_robot_went_evenly_the_shorter_way_round() -> None:
    poses = history(
        (1.0, Pose(0.0, 0.0, math.pi - 0.1)),
        (1.1, Pose(0.04, 0.02, -math.pi + 0.1)),
        (1.2, Pose(0.04, 0.02, 0.0)),
    )
    found = poses.at(1.025)
    assert found is not None
    assert (found.x, found.y) == pytest.approx((0.01, 0.005))
    assert found.theta == pytest.approx(math.pi - 0.05)
    assert poses.at(1.0) == Pose(0.0, 0.0, math.pi - 0.1)
    assert poses.at(1.2) == Pose(0.04, 0.02, 0.0)
    assert poses.newest == (1.2, Pose(0.04, 0.02, 0.0))


@pytest.mark.parametrize("stamp", [0.9, 1.2])
def test_before_and_after_all_poses_nothing_is_known(stamp: float) -> None:
    assert history((1.0, Pose()), (1.1, Pose(0.01, 0.0))).at(stamp) is None
    assert history().at(stamp) is None
    assert history().newest is None


@pytest.mark.parametrize(
    ("takes", "end"),
    [(0.4, Pose(0.1, 0.0)), (0.1, Pose(0.5, 0.0)), (0.1, Pose(0.0, 0.0, 2.0))],
    ids=["silence", "another place", "another heading"],
)
def test_across_a_gap_or_a_correction_nothing_is_known(takes: float, end: Pose) -> None:
    assert history((1.0, Pose()), (1.0 + takes, end)).at(1.0 + 0.5 * takes) is None


def test_a_clock_that_is_set_back_begins_anew() -> None:
    before, after = Pose(1.0, 0.0), Pose(1.1, 0.0)
    poses = history((10.0, before), (10.2, before), (10.05, after), (10.15, after))
    assert poses.at(10.1) == after
    assert poses.at(10.02) is None
