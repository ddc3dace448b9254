"""Counts of visits beside a slow count."""

from __future__ import annotations

import numpy as np

from roomba.grid import GridFrame
from roomba.perception.swept.visits import Visits

FRAME = GridFrame(0.05, -0.5, 1.0, 40, 60)


def swept(x: float, y: float, x0: float, y0: float, x1: float, y1: float) -> bool:
    """Whether a disc of 0.2 m that goes from one point to another passes over a third one."""
    share = np.linspace(0.0, 1.0, 2001)
    away = np.hypot(x - (x0 + share * (x1 - x0)), y - (y0 + share * (y1 - y0)))
    return bool(away.min() <= 0.1 + 1e-9)


def test_a_straight_way_counts_once_what_the_tool_passes() -> None:
    visits = Visits(FRAME, 0.2)
    visits.sweep(0.0, 0.3, 1.8)
    visits.sweep(0.5, 0.52, 1.91)
    for row in range(FRAME.rows):
        for column in range(FRAME.columns):
            x, y = FRAME.centre_of(row, column)
            expected = swept(x, y, 0.3, 1.8, 0.52, 1.91)
            assert visits.counts[row, column] == expected, (x, y)


def test_neighbouring_swaths_count_once_and_later_visits_up_to_three() -> None:
    visits = Visits(FRAME, 0.2)
    row, column = FRAME.cell_of(0.5, 2.0)
    for second in (0.0, 1.0, 2.0):
        visits.sweep(second, 0.5, 2.0)
    assert visits.counts[row, column] == 1
    for minute in range(1, 6):
        visits.sweep(60.0 * minute, 0.5, 2.0)
    assert visits.counts[row, column] == 3


def test_a_robot_that_was_carried_swept_nothing_between() -> None:
    visits = Visits(FRAME, 0.2)
    visits.sweep(0.0, 0.0, 1.5)
    visits.sweep(0.1, 1.5, 2.5)
    assert visits.counts[FRAME.cell_of(0.75, 2.0)] == 0
    visits.lift()
    visits.sweep(0.2, 1.4, 2.5)
    visits.clear()
    assert not visits.counts.any()


def test_what_lies_off_the_frame_is_left_out() -> None:
    visits = Visits(FRAME, 0.2)
    visits.sweep(0.0, -30.0, 40.0)
    assert not visits.counts.any()


def test_all_poses_at_once_count_as_one_by_one() -> None:
    random = np.random.default_rng(5)
    turns = np.cumsum(random.normal(0.0, 0.5, 400))
    way = np.cumsum(0.08 * np.column_stack((np.cos(turns), np.sin(turns))), axis=0)
    way[200:] += (0.7, 0.4)  # carried
    poses = np.column_stack((0.5 * np.arange(400), way + np.array([0.5, 2.0])))
    one_by_one, at_once = Visits(FRAME, 0.2), Visits(FRAME, 0.2)
    for moment, x, y in poses.tolist():
        one_by_one.sweep(moment, x, y)
    at_once.sweep_all(poses)
    assert np.array_equal(at_once.counts, one_by_one.counts)
    assert set(np.unique(at_once.counts)) == {0, 1, 2, 3}


def test_over_a_map_that_grew_the_same_floor_stays_visited() -> None:
    visits = Visits(FRAME, 0.2)
    visits.sweep(0.0, 0.3, 1.8)
    before = visits.counts.sum()
    grown = GridFrame(0.05, -1.0, 0.5, 60, 90)
    visits.carry(grown)
    assert visits.frame == grown
    assert visits.counts.sum() == before
    assert visits.counts[grown.cell_of(0.3, 1.8)] == 1
    # A neighbouring swath at once is the same visit; the way goes on where it was.
    visits.sweep(1.0, 0.6, 1.8)
    assert visits.counts[grown.cell_of(0.3, 1.8)] == 1
    assert visits.counts[grown.cell_of(0.45, 1.8)] == 1
    visits.sweep(60.0, 0.3, 1.8)
    assert visits.counts[grown.cell_of(0.3, 1.8)] == 2
