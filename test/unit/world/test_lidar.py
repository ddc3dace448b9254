"""The lidar against plain geometry: within a millimetre, but for beams that graze a corner."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.references.slow_lidar import disagreeing, ranges_to_cells, within
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.sensors import LidarConfig
from roomba.files.home_layer import list_homes
from roomba.files.shipped import HOMES
from roomba.grid import GridFrame
from roomba.world.layers.layer import load_home
from roomba.world.lidar import Lidar

FAR = LidarConfig(min_range=1e-6, max_range=1e3)
OFF_GRID = {"bay", "cottage", "loft"}
"""Homes with walls off the grid, which test_free_walls.py looks at."""
MOST_GRAZING = 1e-4
"""Share of the beams that may see past a corner which they just meet, or the other way round."""
GRAZE = 2e-5
"""m; how far a beam's origin is moved to see whether it grazes a corner."""

Solid = NDArray[np.bool_]
Poses = NDArray[np.float64]


def slow_scan(solid: Solid, frame: GridFrame, pose: Poses, config: LidarConfig) -> Poses:
    x, y, theta = pose.tolist()
    ranges = ranges_to_cells(solid, frame, x, y, theta, config.beams)
    return within(ranges, config.min_range, config.max_range)


def count_grazing(
    solid: Solid,
    frame: GridFrame,
    poses: Poses,
    scans: NDArray[np.float32],
    config: LidarConfig = FAR,
) -> int:
    """Return how many beams disagree, which all must agree with a beam right beside them."""
    count = 0
    for pose, scan in zip(poses, scans, strict=True):
        off = disagreeing(scan, slow_scan(solid, frame, pose, config))
        if off.any():
            shifts = [(dx, dy, 0.0) for dx in (-GRAZE, GRAZE) for dy in (-GRAZE, GRAZE)]
            shifts += [(0.0, 0.0, -GRAZE), (0.0, 0.0, GRAZE)]
            beside = [slow_scan(solid, frame, pose + shift, config) for shift in shifts]
            unexplained = off & np.all([disagreeing(scan, other) for other in beside], axis=0)
            beams = np.flatnonzero(unexplained)
            assert not len(beams), f"{pose.tolist()}: beams {beams}: {scan[beams]}"
        count += int(off.sum())
    return count


def free_poses(solid: Solid, frame: GridFrame, count: int, random: np.random.Generator) -> Poses:
    rows, columns = np.nonzero(~solid)
    chosen = random.integers(len(rows), size=count)
    inside = random.uniform(0.02, 0.98, (2, count))
    return np.column_stack(
        [
            frame.origin_x + (columns[chosen] + inside[0]) * frame.resolution,
            frame.origin_y + (rows[chosen] + inside[1]) * frame.resolution,
            random.uniform(-10.0, 10.0, count),
        ]
    )


def maze(rows: int, columns: int, density: float, random: np.random.Generator) -> Solid:
    solid: Solid = random.random((rows, columns)) < density
    solid[rows // 2, columns // 2] = False
    return solid


@settings(max_examples=examples(60))
@given(
    st.integers(0, 2**32 - 1),
    st.tuples(st.integers(1, 45), st.integers(1, 45)),
    st.floats(0.0, 0.7),
    st.sampled_from((0.02, 0.05, 0.15)),
    st.sampled_from((None, 0.15, 0.4, 1.0, 100.0)),
    st.sampled_from((8, 9, 31, 360, 1001)),
)
def test_it_sees_what_plain_geometry_sees_in_any_maze(
    seed: int,
    shape: tuple[int, int],
    density: float,
    resolution: float,
    tile: float | None,
    beams: int,
) -> None:
    random = np.random.default_rng(seed)
    solid = maze(*shape, density, random)
    x, y = random.uniform(-5.0, 5.0, 2).tolist()
    frame = GridFrame(resolution, x, y, *shape)
    config = FAR.model_copy(update={"beams": beams})
    poses = free_poses(solid, frame, 8, random)
    scans = Lidar.on_grid(solid, frame, config, tile).scan(poses)
    assert np.isfinite(scans).all()
    # So few beams: one that grazes is much.
    assert count_grazing(solid, frame, poses, scans, config) <= 4


def test_beams_that_graze_corners_are_few() -> None:
    random = np.random.default_rng(3)
    beams = grazing = 0
    for density in (0.01, 0.05, 0.3):
        solid = maze(80, 80, density, random)
        frame = GridFrame(0.05, -1.0, -2.0, *solid.shape)
        poses = free_poses(solid, frame, 60, random)
        scans = Lidar.on_grid(solid, frame, FAR, 0.5).scan(poses)
        grazing += count_grazing(solid, frame, poses, scans)
        beams += scans.size
    assert grazing < MOST_GRAZING * beams


@pytest.mark.parametrize("name", sorted(set(list_homes(HOMES)) - OFF_GRID))
def test_it_sees_what_plain_geometry_sees_in_every_shipped_home(name: str) -> None:
    home = load_home(name, HOMES)
    config = LidarConfig()
    poses = free_poses(home.solid, home.frame, 15, np.random.default_rng(1))
    poses[0] = home.station.x, home.station.y, home.station.theta
    scans = Lidar.of(home).scan(poses)
    # Of 5400 beams a few graze corners.
    assert count_grazing(home.solid, home.frame, poses, scans, config) <= 4


@settings(max_examples=examples(15))
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.3))
def test_tiles_of_all_sizes_see_the_same(seed: int, density: float) -> None:
    random = np.random.default_rng(seed)
    solid = maze(60, 70, density, random)
    frame = GridFrame(0.05, -0.3, 0.2, *solid.shape)
    poses = free_poses(solid, frame, 10, random)
    whole = Lidar.on_grid(solid, frame, FAR, 100.0)
    assert len(whole.edges.starts) == 1
    expected = whole.scan(poses)
    for tile in (0.05, 0.2, 0.35, 1.0, 2.0):
        tiled = Lidar.on_grid(solid, frame, FAR, tile)
        assert len(tiled.edges.starts) > 1
        off = disagreeing(tiled.scan(poses), expected.astype(np.float64))
        assert off.sum() <= 1, tile


@pytest.mark.parametrize("resolution", [0.05, 0.03, 0.1])
def test_it_sees_all_around_on_the_border_between_two_tiles(resolution: float) -> None:
    frame = GridFrame(resolution, -1.0, 2.0, 60, 60)
    solid = np.zeros(frame.shape, np.bool_)
    lidar = Lidar.on_grid(solid, frame, FAR, 10 * resolution)
    on_lines = np.array([10, 20, 30, 40, 50]) * resolution
    places = [(x, y) for x in (*on_lines, 0.777) for y in (*on_lines, 0.555)]
    poses = np.array([(-1.0 + x, 2.0 + y, 0.123) for x, y in places])
    expected = np.array([slow_scan(solid, frame, pose, FAR) for pose in poses])
    assert not disagreeing(lidar.scan(poses), expected).any()


@pytest.mark.parametrize("tile", [0.5, None])
def test_it_stays_on_the_grid_right_at_its_border(tile: float | None) -> None:
    frame = GridFrame(0.05, 0.0, 0.0, 40, 40)
    solid = np.zeros(frame.shape, np.bool_)
    inside = math.nextafter(2.0, 0.0)
    poses = np.array([(inside, inside, 0.1), (inside, 0.0, 0.1), (0.0, 1.0, 0.1), (0.0, 0.0, 0.1)])
    scans = Lidar.on_grid(solid, frame, FAR, tile).scan(poses)
    assert scans.max() <= math.hypot(2.0, 2.0)
    # Each sees the far sides of the grid, whichever of its own side's beams find it too near.
    assert (scans.max(axis=1) >= 2.0).all()


def test_beam_0_looks_ahead_and_they_go_round_to_the_left() -> None:
    home = room_home()
    scan = Lidar.of(home).scan(np.array([(1.0, 1.5, math.pi / 2.0)]))[0]
    assert scan.dtype == np.float32
    assert scan[[0, 90, 180, 270]] == pytest.approx((2.5, 1.0, 1.5, 4.0), abs=1e-5)


def test_too_near_is_minus_infinity_and_too_far_is_infinity() -> None:
    config = LidarConfig(min_range=0.5, max_range=3.0)
    poses = np.array([(0.499, 2.0, math.pi), (0.501, 2.0, math.pi), (1.0, 2.0, 0.0)])
    scans = Lidar.of(room_home(), config).scan(poses)
    assert scans[0, 0] == -math.inf
    assert scans[1, 0] == pytest.approx(0.501, abs=1e-5)
    assert scans[2, 0] == math.inf
    assert Lidar.of(room_home(), LidarConfig(max_range=3.999)).scan(poses)[2, 0] == math.inf
    assert Lidar.of(room_home(), LidarConfig(max_range=4.001)).scan(poses)[2, 0] == pytest.approx(4)


def test_a_scan_is_the_same_alone_and_among_others() -> None:
    home = load_home("studio", HOMES)
    lidar = Lidar.of(home)
    poses = free_poses(home.solid, home.frame, 40, np.random.default_rng(5))
    together = lidar.scan(poses)
    assert lidar.scan(poses).tobytes() == together.tobytes()
    for pose, scan in zip(poses, together, strict=True):
        assert lidar.scan(pose[None]).tobytes() == scan.tobytes()


def test_what_is_given_to_be_filled_is_filled() -> None:
    lidar = Lidar.of(room_home())
    poses = np.array([(1.0, 1.0, 0.0), (2.0, 2.0, 1.0)])
    out = np.zeros((2, 360), np.float32)
    assert lidar.scan(poses, out) is out
    assert out.tobytes() == lidar.scan(poses).tobytes()
    wrongs: list[Any] = [np.zeros((1, 360), np.float32), np.zeros((2, 360))]
    for wrong in wrongs:
        with pytest.raises(ValueError, match="expected out to be float32"):
            lidar.scan(poses, wrong)


@pytest.mark.parametrize(
    ("poses", "said"),
    [
        ([[9.0, 1.0, 0.0]], "poses on the grid"),
        ([[1.0, 1.0, 0.0], [1.0, -0.2, 0.0]], r"got \[1.0, -0.2, 0.0\]"),
        ([[1.0, 5.2, 0.0]], "poses on the grid"),
        ([[-0.2, 1.0, 0.0]], "poses on the grid"),
        ([[math.nan, 1.0, 0.0]], "poses on the grid"),
        ([[1.0, math.inf, 0.0]], "poses on the grid"),
        ([[1.0, 1.0, math.nan]], "poses on the grid"),
        ([[1.0, 1.0]], "shape"),
        ([1.0, 1.0, 0.0], "shape"),
    ],
)
def test_poses_that_make_no_sense_are_refused(poses: list[object], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Lidar.of(room_home()).scan(np.array(poses, np.float64))


def test_no_pose_is_no_scan() -> None:
    assert Lidar.of(room_home()).scan(np.zeros((0, 3))).shape == (0, 360)
