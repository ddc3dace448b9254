"""The pose that the master keeps counts in the run of the robot in which it was kept."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
import rospy
from fixtures.waiting import wait_until

from roomba.configuration.nodes import PlacingConfig
from roomba.geometry import Pose
from roomba_ros.localization import kept_pose
from roomba_ros.localization.kept_pose import PARAMETER, KeptPose

START = Pose(0.0, 0.0, 0.5)
PLACING = PlacingConfig()


class Start:
    """What the parameters say of the start."""

    initial_post_x, initial_post_y, initial_post_theta = START.x, START.y, START.theta


@pytest.fixture
def master(monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, Any]]:
    """The parameters of a master."""
    parameters: dict[str, Any] = {"robot_run": "the first", "/run_id": "of the master"}
    ended: list[bool] = []
    monkeypatch.setattr(rospy, "get_param", parameters.get)
    monkeypatch.setattr(rospy, "set_param", parameters.__setitem__)
    monkeypatch.setattr(rospy, "is_shutdown", lambda: bool(ended))
    monkeypatch.setattr(kept_pose, "read_seed_parameters", Start)
    yield parameters
    ended.append(True)


def begun() -> KeptPose:
    kept = KeptPose(0.01, PLACING)
    kept.start()
    return kept


def keep(master: dict[str, Any]) -> None:
    """Let a process keep a pose."""
    kept = begun()
    kept.keep(Pose(1.0, 2.0, 0.0))
    wait_until(lambda: PARAMETER in master, 10.0)


def test_a_process_of_the_same_run_goes_on_where_the_one_before_was(
    master: dict[str, Any],
) -> None:
    keep(master)
    kept = begun()
    assert kept.start_pose(Pose(0.5, 0.0, 0.0)) == (Pose(1.5, 2.0, 0.0), PLACING.kept)
    assert kept.was_found


def test_in_another_run_on_the_same_master_the_robot_is_where_it_starts(
    master: dict[str, Any],
) -> None:
    keep(master)
    master["robot_run"] = "the second"
    kept = begun()
    assert kept.start_pose(Pose()) == (START, PLACING.start)
    assert not kept.was_found


@pytest.mark.parametrize(
    "left", [[1.0, 2.0, 0.0], "", {"run": "the first"}, {"run": "the first", "pose": [1.0, "x", 0]}]
)
def test_what_is_no_pose_is_not_gone_by(master: dict[str, Any], left: object) -> None:
    master[PARAMETER] = left
    assert begun().start_pose(Pose()) == (START, PLACING.start)
