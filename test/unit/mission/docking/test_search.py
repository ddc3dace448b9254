"""Looking for the station's beams, place by place."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.body import BodyConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.sensors import StationConfig
from roomba.geometry import Pose, Twist
from roomba.mission.docking.search import BeamSearch, drive_to, is_at_staging, steered
from roomba.mission.docking.track import StationTrack

CONFIG = DockingConfig()
DT = 0.05


def track_at(x: float, y: float, theta: float = 0.0) -> StationTrack:
    track = StationTrack(BodyConfig(), StationConfig(), CONFIG, Pose())
    track.move(Pose(x, y, theta), Twist(), DT)
    return track


def follow(search: BeamSearch, track: StationTrack) -> list[Pose]:
    """Drive as the search wants, exactly, until it has been everywhere."""
    poses: list[Pose] = []
    for _ in range(2000):
        wanted = search.tick(track, DT)
        if wanted is None:
            return poses
        track.move(None, wanted, DT)
        poses.append(track.pose)
    raise AssertionError("the search has no end")


@pytest.mark.parametrize("start", [(-0.65, 0.0), (-1.5, 0.8), (-0.3, -0.4)])
def test_it_looks_around_and_from_nearer_by_and_from_both_sides(start: tuple[float, float]) -> None:
    poses = follow(BeamSearch(CONFIG), track_at(*start))
    for place in ((-0.325, 0.0), (-0.4875, 0.3), (-0.4875, -0.3)):
        assert min(pose.distance_to(*place) for pose in poses) < 0.1
    first = next(i for i, pose in enumerate(poses) if pose.distance_to(-0.65, 0.0) < 0.1)
    turned = poses[first + 1 :][: round(2.0 * math.pi / CONFIG.turning_speed / DT) - 2]
    # All around on the spot, before it goes anywhere else.
    assert max(pose.distance_to(turned[0].x, turned[0].y) for pose in turned) < 0.03
    assert {math.floor(math.degrees(pose.theta) / 60.0) for pose in turned} == set(range(-3, 3))
    # At last it stands where it can drive at the station.
    assert poses[-1].distance_to(-0.65, 0.0) < 0.1
    assert max(pose.x for pose in poses) < -0.2


def test_what_cannot_be_reached_is_left_out() -> None:
    search, track = BeamSearch(CONFIG), track_at(-0.65, 0.0)
    skips = 0
    while search.tick(track, DT) is not None:
        search.skip()
        skips += 1
    assert 3 <= skips <= 6
    search.skip()
    assert search.tick(track, DT) is None


@given(st.floats(0.0, 1.0), st.floats(-math.pi, math.pi))
def test_it_turns_before_it_drives(speed: float, wrong: float) -> None:
    twist = steered(CONFIG, speed, wrong)
    assert 0.0 <= twist.linear <= speed
    assert abs(twist.angular) <= CONFIG.turning_speed
    assert twist.angular * wrong >= 0.0
    assert twist.linear == 0.0 if abs(wrong) >= 0.5 else twist.linear >= 0.0


def test_it_slows_down_at_a_place() -> None:
    assert drive_to(track_at(-1.5, 0.0), CONFIG, -0.5, 0.0).linear == CONFIG.speed
    near = drive_to(track_at(-0.6, 0.0), CONFIG, -0.5, 0.0)
    assert near.linear == pytest.approx(0.1 + CONFIG.creep_speed)
    assert is_at_staging(track_at(-0.6, 0.05), CONFIG)
    assert not is_at_staging(track_at(-0.5, 0.05), CONFIG)
