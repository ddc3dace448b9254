"""Occupancy counts: the grid grows wherever something is seen, and loses nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, START, points_of, row, wrong_cells
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from roomba.perception.slam.drawing.occupancy_counts import OccupancyCounts

CENTRE = np.zeros(2)
AHEAD = np.array([[0.5, 0.0, -1.0, 0.0]], np.float32)
places = st.lists(st.tuples(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0)), min_size=1, max_size=5)


def value_at(made: OccupancyMap, x: float, y: float) -> int:
    row, column = made.frame.cell_of(x, y)
    if not (0 <= row < made.frame.rows and 0 <= column < made.frame.columns):
        return UNKNOWN
    return int(made.values[row, column])


def is_on_border(place: float, phase: float) -> bool:
    off = math.remainder(place - phase, 0.05)
    return abs(off) < 1e-6


@given(places, st.floats(0.0, 0.049), st.floats(0.0, 0.049))
@settings(max_examples=examples(40))
def test_it_grows_to_all_sides_and_keeps_all(
    at: list[tuple[float, float]], phase_x: float, phase_y: float
) -> None:
    counts = OccupancyCounts(0.05, (phase_x, phase_y))
    for x, y in at:
        counts.draw(AHEAD, CENTRE, np.array([x, y, 0.0]))
    made = counts.occupancy(0.3, 1)
    # Later ones may have gone through the ends of earlier ones.
    for index, (x, y) in enumerate(at):
        if is_on_border(x + 0.52, phase_x) or is_on_border(y, phase_y):
            continue  # rounding decides to which cell the end belongs
        if all(abs(y - other) > 0.1 for _, other in at[index + 1 :]):
            assert value_at(made, x + 0.52, y) == OCCUPIED
            assert value_at(made, x + 0.2, y) == FREE
            assert value_at(made, x + 0.62, y) in (UNKNOWN, FREE, OCCUPIED)
    known = made.values != UNKNOWN
    assert (made.values == OCCUPIED).sum() <= len(at)
    # One cell of the unknown around all that is known, and no more.
    assert not known[[0, -1]].any()
    assert not known[:, [0, -1]].any()
    assert known[1].any()
    assert known[-2].any()
    assert known[:, 1].any()
    assert known[:, -2].any()
    corner = np.array([made.frame.origin_x - phase_x, made.frame.origin_y - phase_y]) / 0.05
    assert corner == pytest.approx(np.round(corner), abs=1e-6)


def test_the_order_in_which_it_grows_makes_no_difference() -> None:
    """Far to all sides, there and back: the counts of before are where they were.

    No beam goes along a border of cells: there rounding decides.
    """
    places = [(0.0, 0.0), (9.0, 0.0), (-9.0, 3.0), (0.0, 11.0), (1.0, -12.0)]
    poses = [Pose(x + 0.01, y + 0.02) for x, y in places]
    maps = []
    for order in (poses, poses[::-1], poses[2:] + poses[:2]):
        counts = OccupancyCounts(0.05)
        for pose in order:
            counts.draw(AHEAD, CENTRE, row(pose))
        maps.append(counts.occupancy(0.3, 1))
    for made in maps[1:]:
        assert made.frame == maps[0].frame
        assert (made.values == maps[0].values).all()
    assert (maps[0].values == OCCUPIED).sum() == len(poses)


def test_a_room_is_drawn_as_it_is() -> None:
    counts, eye = OccupancyCounts(0.05), Eye(FURNISHED)
    for pose in (START, Pose(1.0, 2.6, 0.4), Pose(4.4, 3.2, 2.0), Pose(4.2, 0.6, -1.0)):
        counts.draw(points_of(eye.scan(pose)).astype(np.float32), CENTRE, row(pose))
    made = counts.occupancy(0.3, 2)
    assert wrong_cells(made, FURNISHED) == (0, 0)
    # 5 x 4 m without cupboard and shelf, but a few cells in corners.
    area = (made.values == FREE).sum() * 0.05**2
    assert area == pytest.approx(20.0 - 0.45 - 0.15, abs=0.3)


def test_the_legs_of_chairs_are_as_thin_as_they_are() -> None:
    """Noise and grazed corners put beams beside them; with two cells each a gap would be shut."""
    corners = [(0.8 + 0.4 * right, 0.8 + 0.4 * up) for right in range(6) for up in range(4)]
    home = room_home(4.0, 3.0, tuple((x, y, x + 0.05, y + 0.05) for x, y in corners))
    counts, eye, random = OccupancyCounts(0.05), Eye(home), np.random.default_rng(3)
    for _ in range(60):
        x, y, theta = random.uniform((0.3, 0.3, -3.0), (3.7, 0.7, 3.0)).tolist()
        pose = Pose(x, y, theta)
        taken_for = row(pose) + random.normal(0.0, (0.003, 0.003, 0.002))
        scan = points_of(eye.scan(pose, random)).astype(np.float32)
        counts.draw(scan, CENTRE, taken_for)
    made = counts.occupancy(0.3, 2)
    for x, y in corners:
        row_of, column_of = made.frame.cell_of(x + 0.025, y + 0.025)
        around = made.values[row_of - 2 : row_of + 3, column_of - 2 : column_of + 3]
        assert around[2, 2] == OCCUPIED
        assert (around == OCCUPIED).sum() == 1, f"the leg at {x}, {y}"


def test_a_beam_that_grazes_a_corner_stays_in_its_cell() -> None:
    """It met a thin thing of unknown facing 8 mm before the corner; 2 cm on is the next cell."""
    counts = OccupancyCounts(0.05)
    along = np.array([-0.8, 0.6])
    for way in (1.0, 1.5):
        x, y = np.array([0.512, 0.001]) - way * along
        scan = np.array([[*(way * along), 0.0, 0.0]], np.float32)
        counts.draw(scan, CENTRE, np.array([x, y, 0.0]))
    made = counts.occupancy(0.3, 2)
    assert value_at(made, 0.525, 0.025) == OCCUPIED
    assert (made.values == OCCUPIED).sum() == 1


def test_an_open_way_is_free_where_nothing_else_is_known() -> None:
    """It takes no wall away, and makes none; what it shows goes with its scan."""
    counts = OccupancyCounts(0.05)
    counts.draw(AHEAD, CENTRE, np.zeros(3))
    wall, behind = (0.52, 0.0), (0.82, 0.0)
    ways = np.array([[1.0, 0.0], [0.0, 1.0]], np.float32)
    assert value_at(counts.occupancy(0.3, 1), *behind) != FREE
    counts.draw(np.zeros((0, 4), np.float32), CENTRE, np.zeros(3), ways)
    made = counts.occupancy(0.3, 1)
    assert value_at(made, *wall) == OCCUPIED
    assert value_at(made, *behind) == value_at(made, 0.0, 0.97) == FREE
    counts.erase(np.zeros((0, 4), np.float32), CENTRE, np.zeros(3), ways)
    made = counts.occupancy(0.3, 1)
    assert value_at(made, *behind) == value_at(made, 0.0, 0.97) == UNKNOWN


def test_an_empty_sheet_is_no_map() -> None:
    with pytest.raises(ValueError, match="at least one scan"):
        OccupancyCounts(0.05).occupancy(0.3, 2)


def test_a_scan_without_points_shows_where_the_lidar_was() -> None:
    counts = OccupancyCounts(0.05)
    counts.draw(np.zeros((0, 4), np.float32), CENTRE, np.array([1.0, 2.0, 0.0]))
    made = counts.occupancy(0.3, 2)
    assert made.values.shape == (3, 3)
    assert (made.values == UNKNOWN).all()
    assert made.frame.contains(1.0, 2.0)


def test_a_scan_that_is_erased_leaves_the_others() -> None:
    first, second = np.array([0.0, 0.0, 0.0]), np.array([0.3, 2.0, 1.0])
    both_counts = OccupancyCounts(0.05), OccupancyCounts(0.05)
    for counts in both_counts:
        counts.draw(AHEAD, CENTRE, first)
    both_counts[0].draw(AHEAD, CENTRE, second)
    assert value_at(both_counts[0].occupancy(0.3, 1), 0.4, 2.2) == FREE
    both_counts[0].erase(AHEAD, CENTRE, second)
    made, expected = (counts.occupancy(0.3, 1) for counts in both_counts)
    assert (made.values != UNKNOWN).sum() == (expected.values != UNKNOWN).sum() > 5
    assert value_at(made, 0.52, 0.0) == OCCUPIED
