"""Scans against odometry show how a lidar is mounted."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.drives.made_logs import LASER, Item, drive
from fixtures.drives.turning_drive import half_circle, readings_of, turning_drive

from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.commands.map.drive.shown.shown_mount import ShownMount, shown_mount
from roomba.geometry import Pose, wrap_angle


def shown(items: list[Item], mount: Pose = LASER) -> ShownMount | None:
    return shown_mount(LidarSamples(readings_of(items, half_circle(mount=mount))))


@pytest.mark.parametrize("is_turned_over", [False, True])
@pytest.mark.parametrize("yaw", [0.0, 0.6, math.pi, -0.5 * math.pi])
def test_which_way_it_looks_and_hangs_is_seen(yaw: float, is_turned_over: bool) -> None:
    items = turning_drive(yaw=yaw, hangs=is_turned_over)
    found = shown(items, Pose())
    assert found is not None
    assert found.is_turned_over is is_turned_over
    assert abs(wrap_angle(found.yaw - yaw)) < 0.1


def test_one_that_is_mounted_as_it_was_told_looks_ahead() -> None:
    for mount in (LASER, Pose(LASER.x, LASER.y, 1.0)):
        found = shown(turning_drive(yaw=mount.theta), mount)
        assert found is not None
        assert (found.is_turned_over, found.yaw) == (False, pytest.approx(0.0, abs=0.1))


@pytest.mark.parametrize(("mount", "yaw"), [(LASER, 0.0), (Pose(theta=math.pi), math.pi)])
def test_of_a_robot_that_goes_round_in_a_circle_only_what_is_clear_is_told(
    mount: Pose, yaw: float
) -> None:
    """There a lidar that looks a little aside moves as one that is a little off the middle."""
    found = shown(drive(20.0), mount)
    assert found is not None
    assert not found.is_turned_over
    assert abs(wrap_angle(found.yaw - yaw)) < 0.5


def test_a_robot_that_hardly_moved_tells_nothing() -> None:
    assert shown(drive(1.0)) is None
    assert shown([]) is None


def test_odometry_that_does_not_fit_tells_nothing() -> None:
    """A robot whose wheels slip tells turns that no scan shows."""
    generator = np.random.default_rng(2)
    items = [
        replace(item, value=Pose(item.value.x, item.value.y, generator.normal()))
        if isinstance(item.value, Pose)
        else item
        for item in turning_drive()
    ]
    assert shown(items) is None


def test_scans_in_which_nothing_is_seen_tell_nothing() -> None:
    items = [
        replace(item, value=np.full(180, np.inf)) if isinstance(item.value, np.ndarray) else item
        for item in turning_drive()
    ]
    assert shown(items) is None
