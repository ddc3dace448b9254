"""From ranges to points on surfaces: where they lie, and how their surfaces face."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import LIDAR, Eye, Ranges
from fixtures.robots.mapped import FURNISHED, points_of
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.scan_matching.surface_kernels import NORMAL_X, NORMAL_Y, X, Y

ANGLES = np.arange(LIDAR.beams) * (2.0 * np.pi / LIDAR.beams)


def wall(distance: float, angle: float) -> Ranges:
    """A scan of an endless wall: so far away, m, its foot in that direction, rad."""
    facing = np.cos(ANGLES - angle)
    with np.errstate(divide="ignore"):
        return np.where(facing > 1e-6, distance / facing, np.inf).astype(np.float32)


@given(st.floats(0.2, 6.0), st.floats(-math.pi, math.pi))
def test_a_wall_faces_the_lidar(distance: float, angle: float) -> None:
    points = points_of(wall(distance, angle))
    foot = np.array([math.cos(angle), math.sin(angle)])
    assert len(points) > 100
    assert points[:, :2] @ foot == pytest.approx(distance, abs=1e-4)
    lengths = np.hypot(points[:, X], points[:, Y])
    known = np.any(points[:, 2:] != 0.0, axis=1)
    # Only what is met nearly along it may be doubted.
    assert known[lengths < 3.0 * distance].all()
    assert points[known, 2:] @ foot == pytest.approx(-1.0, abs=1e-4)


def test_noise_turns_walls_a_little() -> None:
    random = np.random.default_rng(1)
    turned = []
    for _ in range(20):
        ranges = wall(1.5, 0.7) + random.normal(0.0, 0.005, LIDAR.beams).astype(np.float32)
        points = points_of(ranges)
        known = points[np.any(points[:, 2:] != 0.0, axis=1)]
        off = np.arctan2(known[:, NORMAL_Y], known[:, NORMAL_X]) - (0.7 - math.pi)
        turned.append(np.abs(np.remainder(off + math.pi, 2.0 * math.pi) - math.pi))
    assert np.median(np.concatenate(turned)) < math.radians(4.0)
    assert np.mean(np.concatenate(turned) < math.radians(12.0)) > 0.95


@pytest.mark.parametrize("distance", [0.25, 0.4, 0.7])
def test_much_noise_does_not_decide_how_a_wall_close_by_faces(distance: float) -> None:
    """Else a bare corridor seems to tell the way along it."""
    random, off = np.random.default_rng(1), []
    for _ in range(20):
        ranges = wall(distance, 0.7) + random.normal(0.0, 0.05, LIDAR.beams).astype(np.float32)
        points = points_of(ranges, noise=0.05)
        near = points[np.hypot(points[:, X], points[:, Y]) < 1.5 * distance]
        off.append(np.abs(near[:, NORMAL_X] * math.sin(0.7) - near[:, NORMAL_Y] * math.cos(0.7)))
    # The sine of that angle is by how much of its weight a point tells the way along the wall.
    assert np.mean(np.concatenate(off) ** 2) < 0.13**2


@given(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(-math.pi, math.pi))
def test_the_mount_moves_and_turns_points(x: float, y: float, theta: float) -> None:
    ranges = wall(1.0, 0.4)
    bare = points_of(ranges)
    mounted = points_of(ranges, LidarModel(ANGLES, 0.15, 12.0, Pose(x, y, theta)))
    turn = np.array([[math.cos(theta), math.sin(theta)], [-math.sin(theta), math.cos(theta)]])
    assert mounted[:, :2] == pytest.approx(bare[:, :2] @ turn + (x, y))
    assert mounted[:, 2:] == pytest.approx(bare[:, 2:] @ turn)


@pytest.mark.parametrize("pose", [Pose(2.5, 1.2, 0.0), Pose(0.6, 0.5, 1.0), Pose(4.4, 3.6, -2.0)])
def test_in_a_room_no_surface_lies_across_its_corners(pose: Pose) -> None:
    points = points_of(Eye(FURNISHED).scan(pose))
    known = points[np.any(points[:, 2:] != 0.0, axis=1)]
    # Beside a corner only one side of a point is looked at.
    assert len(known) > 0.97 * len(points)
    directions = np.arctan2(known[:, NORMAL_Y], known[:, NORMAL_X]) + pose.theta
    off = np.abs(np.remainder(directions + math.pi / 4.0, math.pi / 2.0) - math.pi / 4.0)
    # Where a beam passes close to an edge two of three points may be of the other wall.
    assert np.mean(off < math.radians(3.0)) > 0.97
    assert off.max() < math.radians(15.0)
    # All face the lidar.
    assert ((known[:, :2] * known[:, 2:]).sum(axis=1) < 0.0).all()


def test_the_ends_of_half_a_circle_are_no_neighbours() -> None:
    """A lidar that looks ahead only, close between two walls."""
    angles = np.linspace(-math.pi / 2.0, math.pi / 2.0, 181)
    with np.errstate(divide="ignore"):
        ranges = (0.25 / np.abs(np.sin(angles))).astype(np.float32)
    points = points_of(ranges, LidarModel(angles, 0.15, 12.0))
    known = points[np.any(points[:, 2:] != 0.0, axis=1)]
    assert len(known) > 80
    assert np.abs(known[:, NORMAL_Y]) == pytest.approx(1.0, abs=1e-4)
    assert (known[:, NORMAL_Y] * known[:, Y] < 0.0).all()


@pytest.mark.parametrize("beams", [1, 2, 8])
def test_few_beams_have_points_without_surfaces_or_none_at_all(beams: int) -> None:
    lidar = LidarModel.all_around(beams, 0.15, 12.0)
    points = points_of(np.ones(beams, np.float32), lidar)
    assert len(points) == beams
    assert np.isfinite(points).all()
    assert (points[:, 2:] == 0.0).all()
    for nothing in (math.inf, math.nan, 0.0, 0.1, 12.5, -1.0):
        assert len(points_of(np.full(beams, nothing, np.float32), lidar)) == 0


def test_what_is_out_of_reach_is_no_part_of_a_surface() -> None:
    ranges = Eye(room_home(5.0, 4.0)).scan(Pose(2.5, 2.0, 0.0))
    ranges[::3] = np.inf
    points = points_of(ranges)
    assert len(points) == 240
    assert np.mean(np.any(points[:, 2:] != 0.0, axis=1)) > 0.9
