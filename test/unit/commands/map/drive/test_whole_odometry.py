"""Odometry that tells nothing for a while goes on by scans."""

from __future__ import annotations

from pathlib import Path

import pytest
from fixtures.drives.made_logs import BEGAN, Item, changed, drive, held, pose_at, write_bag
from fixtures.robots.located import CONFIG

from roomba.commands.map.drive.whole_odometry import whole_odometry_of
from roomba.geometry import Pose, wrap_angle
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import LidarScan, Odometry

SECONDS = 40.0
BEGIN = pose_at(0.0).inverse()


class Heard:
    """What the odometry of a drive tells: poses by time, and where the recorded frame lies then."""

    def __init__(self, path: Path, items: list[Item]) -> None:
        self.poses: dict[float, Pose] = {}
        self.frames: dict[float, Pose] = {}
        self.recorded: dict[float, Pose] = {}
        self.guessed: list[float] = []
        with LoggedDrive([write_bag(path / "made.bag", items)]) as recorded:
            odometry = whole_odometry_of(recorded, CONFIG)
            for reading in recorded.readings():
                passed = round(reading.stamp - BEGAN, 6)
                if isinstance(reading.value, Odometry):
                    self.recorded[passed] = reading.value.pose
                pose = odometry.hear(reading)
                if pose is not None:
                    self.poses[passed], self.frames[passed] = pose, odometry.frame
                    self.guessed += [passed] * isinstance(reading.value, LidarScan)

    def off(self, begin: float = 0.0) -> float:
        """Return the largest error of what was moved since a time, s: m, or rad."""
        start, true_start = self.poses[begin].inverse(), pose_at(begin).inverse()
        errors = [0.0]
        for passed, pose in self.poses.items():
            if passed >= begin:
                moved, true = start.compose(pose), true_start.compose(pose_at(passed))
                errors += [moved.distance_to(true.x, true.y), wrap_angle(moved.theta - true.theta)]
        return max(map(abs, errors))


def test_odometry_without_a_gap_is_as_it_was_recorded(tmp_path: Path) -> None:
    heard = Heard(tmp_path, drive(SECONDS))
    assert heard.poses == heard.recorded
    assert set(heard.frames.values()) == {Pose()}
    assert not heard.guessed


@pytest.mark.parametrize("goes_on_there", [True, False])
def test_where_it_stands_still_each_scan_tells_how_far_the_robot_came(
    tmp_path: Path, goes_on_there: bool
) -> None:
    items = changed(drive(SECONDS), "/odom", held(10.0, 25.0, goes_on_there=goes_on_there))
    heard = Heard(tmp_path, items)
    assert heard.off() < 0.05
    assert len(heard.guessed) == pytest.approx(75, abs=2)
    assert (heard.guessed[0], heard.guessed[-1]) == pytest.approx((10.2, 24.8), abs=0.21)
    for passed in (5.0, 30.0, 39.9):
        placed = heard.frames[passed].compose(heard.recorded[passed])
        assert placed.distance_to(heard.poses[passed].x, heard.poses[passed].y) < 1e-9


def test_while_it_stands_still_the_recorded_frame_moves_along(tmp_path: Path) -> None:
    """A pose on the map is the same, told in the one frame or in the other one."""
    heard = Heard(tmp_path, changed(drive(SECONDS), "/odom", held(10.0, 25.0, goes_on_there=True)))
    stood = BEGIN.compose(pose_at(10.0))
    placed = heard.frames[20.0].compose(stood)
    assert placed.distance_to(heard.poses[20.0].x, heard.poses[20.0].y) < 0.05


def test_a_drive_without_odometry_goes_by_scans_alone(tmp_path: Path) -> None:
    heard = Heard(tmp_path, [item for item in drive(SECONDS) if item.topic == "/scan"])
    assert len(heard.poses) == len(heard.guessed) == 200
    assert heard.off(1.0) < 0.05
