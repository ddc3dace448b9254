"""Scans matched to what was seen before: found again exactly, with things and persons about."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, START, Floats, points_of, row
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.perception.slam.scan_matching.surfel_kernels import (
    ALIGN_WORK,
    ASKED,
    FACINGS,
    SUMS,
    Surfels,
    add_points,
    align,
)
from roomba.perception.slam.scan_matching.surfels import Match, SurfelGrid
from roomba.perception.slam.scan_matching.tolerances import Tolerances

EYE = Eye(FURNISHED)
TOLERANCES = Tolerances(np.array([0.1, 0.05, 0.03]), 0.03**2, 0.03)
LOOSE = np.diag([0.1**2, 0.1**2, 0.1**2])
OFF = np.array([0.03, -0.03, 0.0])
EXACT = 0.002
"""m"""
near = st.tuples(
    st.floats(-0.05, 0.05), st.floats(-0.05, 0.05), st.floats(-math.radians(3), math.radians(3))
)


def grid_of(eye: Eye = EYE, *poses: Pose) -> SurfelGrid:
    """What is seen from some poses, in the frame of the map."""
    grid = SurfelGrid(8.0)
    for pose in poses or (START,):
        grid.add(points_of(eye.scan(pose)), row(pose))
    return grid


def matched(
    grid: SurfelGrid, points: Floats, prior: Floats, spread: Floats = LOOSE, **changes: int
) -> Match:
    found = grid.match(points, prior, spread, TOLERANCES, **{"rounds": 8, **changes})
    assert found is not None
    return found


@given(near)
def test_a_scan_is_found_again_from_beside_it(off: tuple[float, float, float]) -> None:
    found = matched(grid_of(), points_of(EYE.scan(START)), row(START) + off)
    assert found.pose == pytest.approx(row(START), abs=EXACT)
    assert found.met > 0.95
    assert found.close > 0.95


@given(near, st.floats(-0.3, 0.3), st.floats(-math.pi, math.pi))
def test_a_scan_from_another_place_is_matched(
    off: tuple[float, float, float], way: float, heading: float
) -> None:
    there = Pose(START.x + way, START.y + 0.1, heading)
    found = matched(grid_of(), points_of(EYE.scan(there)), row(there) + off)
    assert found.pose == pytest.approx(row(there), abs=0.006)


def test_noise_does_not_carry_it_away() -> None:
    random = np.random.default_rng(2)
    grid = SurfelGrid(8.0)
    for pose in (START, Pose(2.6, 1.2, 0.1), Pose(2.7, 1.3, 0.2)):
        grid.add(points_of(EYE.scan(pose, random)), row(pose))
    off = np.array([0.05, -0.05, math.radians(3)])
    away = [
        matched(grid, points_of(EYE.scan(START, random)), row(START) + off).pose - row(START)
        for _ in range(20)
    ]
    assert np.abs(away).max() < 0.008
    assert np.hypot(*np.array(away)[:, :2].T).mean() < 0.004


@pytest.mark.parametrize("stride", [1, 2, 5])
def test_every_few_points_suffice(stride: int) -> None:
    off = np.array([0.04, 0.03, -0.04])
    found = matched(grid_of(), points_of(EYE.scan(START)), row(START) + off, stride=stride)
    assert found.pose == pytest.approx(row(START), abs=EXACT)
    assert found.asked == pytest.approx(350 / stride, rel=0.1)


def test_a_person_who_walks_about_does_not_pull() -> None:
    """A third of what is in sight belongs to a person who came 0.15 m nearer."""
    person = (1.2, 1.6, 1.6, 2.6)
    before = Eye(room_home(5.0, 4.0, ((3.3, 3.1, 3.8, 4.0), (0.0, 1.4, 0.3, 1.9), person)))
    moved = (1.3, 1.5, 1.7, 2.5)
    after = Eye(room_home(5.0, 4.0, ((3.3, 3.1, 3.8, 4.0), (0.0, 1.4, 0.3, 1.9), moved)))
    found = matched(grid_of(before), points_of(after.scan(START)), row(START) + OFF)
    assert found.pose == pytest.approx(row(START), abs=0.005)
    assert found.close < 0.95


def plane(x: float, facing: float) -> Floats:
    """Points on the wall at x, m, that faces along x or back, from y = -1 to 1."""
    y = np.linspace(-1.0, 1.0, 100)
    return np.column_stack((np.full(100, x), y, np.full(100, facing), np.zeros(100)))


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("left", [1.01, 1.03, 1.07])
def test_both_sides_of_a_thin_wall_are_kept_apart(left: float, side: float) -> None:
    """5 cm thick, within one cell or two of 10 cm: each side is matched to itself alone."""
    grid = SurfelGrid(3.0)
    grid.add(plane(left, -1.0), np.zeros(3))
    grid.add(plane(left + 0.05, 1.0), np.zeros(3))
    seen = plane(left if side < 0.0 else left + 0.05, side)
    found = matched(grid, seen, np.array([0.02, 0.0, 0.0]))
    assert found.pose[0] == pytest.approx(0.0, abs=0.002)
    assert found.close == 1.0


def test_along_a_bare_wall_the_prior_holds() -> None:
    grid = SurfelGrid(3.0)
    grid.add(plane(1.0, -1.0), np.zeros(3))
    found = matched(grid, plane(1.0, -1.0), np.array([0.02, 0.04, 0.0]))
    assert found.pose[0] == pytest.approx(0.0, abs=0.002)
    assert found.pose[1] == pytest.approx(0.04, abs=0.002)
    assert found.covariance[1, 1] == pytest.approx(LOOSE[1, 1], rel=0.05)
    assert found.covariance[0, 0] < 0.01 * LOOSE[0, 0]
    assert found.information[0, 0] > 1e3
    assert found.information[1, 1] < 1.0


def test_a_prior_as_sure_as_the_points_is_met_halfway() -> None:
    grid = SurfelGrid(3.0)
    grid.add(plane(1.0, -1.0), np.zeros(3))
    as_sure = np.eye(3) * 0.03**2 / 100.0
    wide = TOLERANCES._replace(scales=np.array([10.0]))
    found = grid.match(plane(1.0, -1.0), np.array([0.02, 0.0, 0.0]), as_sure, wide, rounds=8)
    assert found is not None
    assert found.pose[0] == pytest.approx(0.01, abs=1e-4)
    assert found.covariance[0, 0] == pytest.approx(0.5 * as_sure[0, 0], rel=0.01)


@pytest.mark.parametrize("turn", [0.3, 0.8, -0.9, 1.5, 3.0])
def test_surfaces_that_face_elsewhere_are_others(turn: float) -> None:
    grid = SurfelGrid(3.0)
    grid.add(plane(1.0, -1.0), np.zeros(3))
    asked = plane(1.0, -1.0)
    asked[:, 2:] = -math.cos(turn), -math.sin(turn)
    assert matched(grid, asked, np.zeros(3), np.eye(3) * 1e-10).met == float(abs(turn) < 0.6)


def test_a_sure_prior_is_not_left() -> None:
    prior = row(START) + OFF
    found = matched(grid_of(), points_of(EYE.scan(START)), prior, np.eye(3) * 1e-10)
    assert found.pose == pytest.approx(prior, abs=1e-4)


def test_without_anything_to_match_the_prior_stays() -> None:
    prior = np.array([0.1, 0.2, 0.3])
    points = points_of(EYE.scan(START))
    for grid, asked in ((SurfelGrid(3.0), points), (grid_of(), np.zeros((0, 4)))):
        found = matched(grid, asked, prior)
        assert found.pose == pytest.approx(prior)
        assert (found.met, found.close) == (0.0, 0.0)
        assert found.covariance == pytest.approx(LOOSE)
    assert SurfelGrid(3.0).match(points, prior, np.zeros((3, 3)), TOLERANCES, rounds=3) is None


def test_what_was_cleared_is_not_met() -> None:
    grid = grid_of()
    grid.clear()
    assert matched(grid, points_of(EYE.scan(START)), row(START)).met == 0.0
    grid.add(points_of(EYE.scan(START)), row(START))
    assert matched(grid, points_of(EYE.scan(START)), row(START)).met > 0.95


def surfels(cells: int, most: int) -> Surfels:
    return Surfels(
        np.zeros((cells, cells, FACINGS, SUMS), np.float32),
        np.array([-0.05 * cells, -0.05 * cells, 0.1]),
        np.zeros(most, np.int32),
        np.zeros(1, np.int64),
    )


def test_points_off_the_grid_or_without_a_surface_are_left_out() -> None:
    grid = surfels(10, 50)
    points = np.array([[0.7, 0.0, 1.0, 0.0], [0.0, -0.7, 0.0, 1.0], [0.1, 0.1, 0.0, 0.0]])
    add_points(grid, points, 3, np.zeros(3))
    assert not grid.sums.any()
    assert grid.used[0] == 0
    prior, pose, counts = np.zeros(3), np.zeros(3), np.zeros(3)
    assert align(
        grid, points, 3, 1, 1, prior, LOOSE.copy(), TOLERANCES, 4, pose, np.zeros((3, 3)), counts,
        np.empty((ALIGN_WORK, 3)),
    )  # fmt: skip
    assert counts[ASKED] == 2.0


def test_a_grid_that_is_full_takes_no_new_cells() -> None:
    grid = surfels(40, 5)
    add_points(grid, plane(0.52, -1.0), 100, np.zeros(3))
    assert grid.used[0] == 5
    cells = np.count_nonzero(grid.sums[..., 0].sum(axis=2))
    assert cells == 5
    # Those that it has go on.
    before = grid.sums[..., 0].sum()
    add_points(grid, plane(0.52, -1.0), 100, np.zeros(3))
    assert grid.sums[..., 0].sum() == 2.0 * before
