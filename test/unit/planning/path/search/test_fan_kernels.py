"""What a root sees of the next row, against segments tried one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from roomba.planning.path.search.any_angle import FreeSpace
from roomba.planning.path.search.fan_kernels import (
    BEFORE_GOAL,
    DIRECTION,
    EPOCH,
    FANS,
    GOAL_SQUARE,
    HEAP_SIZE,
    LEFT,
    RIGHT,
    ROW,
    Work,
    add_fan,
    drive_fan,
    offer_root,
)
from roomba.planning.path.search.floor_kernels import CROSSING

Mask = NDArray[np.bool_]
FAR = 1e18
FLOORS = arrays(
    np.bool_,
    st.tuples(st.integers(3, 5), st.integers(3, 9)),
    elements=st.integers(0, 5).map(lambda number: number > 0),
    fill=st.just(True),
)


def work_over(fits: Mask, goal: tuple[float, float] = (1.0, 1.0)) -> Work:
    """Room for a search; the goal in padded cells."""
    floor = FreeSpace.of(fits)
    size = floor.fits.size
    state = np.zeros(5, np.int64)
    state[EPOCH], state[GOAL_SQUARE] = 1, -1
    return Work(
        floor.fits,
        floor.open_squares,
        floor.flags,
        np.zeros(size, np.int32),
        np.zeros(size),
        np.zeros(size, np.int32),
        np.zeros(400),
        np.zeros(400, np.int32),
        np.zeros(400, np.int32),
        np.zeros((400, 7)),
        state,
        np.array([1.0, 1.0, *goal, FAR]),
    )


def passes(squares: NDArray[np.uint8], row: int, direction: int, begin: float, end: float) -> bool:
    """Whether a segment from one row to the next stays in open squares between them."""
    strip = squares[row if direction > 0 else row - 1]
    low, high = min(begin, end), max(begin, end)
    return all(strip[column] for column in range(math.floor(low), math.ceil(high)))


@st.composite
def fans(draw: st.DrawFn) -> tuple[Mask, int, int, float, float, float, float]:
    """A floor, and on it a root that sees some of a row, in padded cells."""
    fits = draw(FLOORS)
    rows, columns = fits.shape
    direction = draw(st.sampled_from([1, -1]))
    row = draw(st.integers(2, rows - 1))
    root_y = row - direction * draw(st.sampled_from([0.5, 1.0, 2.0, 7.0]))
    root_x = draw(st.integers(4, 4 * columns)) / 4
    left = draw(st.integers(2, 2 * columns - 1)) / 2
    right = left + draw(st.integers(1, 12)) / 2
    assume(right <= columns)
    return fits, direction, row, root_x, root_y, left, right


@given(fans())
@settings(max_examples=examples(200))
def test_the_next_fans_are_what_segments_through_this_one_reach(
    fan: tuple[Mask, int, int, float, float, float, float],
) -> None:
    fits, direction, row, root_x, root_y, left, right = fan
    work = work_over(fits)
    add_fan(work, -1, root_x, root_y, 0.0, row, direction, left, right)
    drive_fan(work, 0)
    found = work.fans[1 : work.state[FANS]]
    assert (found[:, ROW] == row + direction).all()
    assert (found[:, DIRECTION] == direction).all()
    share = (row - root_y) / (row + direction - root_y)
    for sixteenth in range(16 * (fits.shape[1] + 2)):
        to_x = sixteenth / 16 + 0.0137
        over = root_x + (to_x - root_x) * share
        seen = left <= over <= right and passes(work.open_squares, row, direction, over, to_x)
        assert seen == any(each[LEFT] <= to_x <= each[RIGHT] for each in found)


@given(fans(), st.integers(0, 40), st.sampled_from([0.25, 0.5, 0.75]))
@settings(max_examples=examples(150))
def test_a_goal_between_the_rows_is_offered_where_it_is_seen(
    fan: tuple[Mask, int, int, float, float, float, float], quarter: int, share: float
) -> None:
    fits, direction, row, root_x, root_y, left, right = fan
    goal = 1.0 + quarter / 4 + 0.0137, row + direction * share
    work = work_over(fits, goal)
    strip = row if direction > 0 else row - 1
    assume(goal[0] < fits.shape[1] and work.open_squares[strip, int(goal[0])])
    work.state[GOAL_SQUARE] = strip
    add_fan(work, -1, root_x, root_y, 3.0, row, direction, left, right)
    drive_fan(work, 0)
    over = root_x + (goal[0] - root_x) * (row - root_y) / (goal[1] - root_y)
    if left <= over <= right and passes(work.open_squares, row, direction, over, goal[0]):
        assert work.ends[4] == pytest.approx(3.0 + math.dist(goal, (root_x, root_y)))
        assert work.state[BEFORE_GOAL] == -1
    else:
        assert work.ends[4] == FAR


@given(fans())
@settings(max_examples=examples(100))
def test_centres_at_which_the_floor_is_thin_become_roots(
    fan: tuple[Mask, int, int, float, float, float, float],
) -> None:
    fits, direction, row, root_x, root_y, left, right = fan
    work = work_over(fits)
    add_fan(work, -1, root_x, root_y, 2.0, row, direction, left, right)
    columns = work.fits.shape[1]
    for x in range(math.ceil(left), math.floor(right) + 1):
        index = row * columns + x
        if work.flags[row, x] & CROSSING:
            assert work.stamps[index] == 2
            assert work.costs[index] == pytest.approx(2.0 + math.dist((x, row), (root_x, root_y)))
        elif not work.flags[row, x]:
            assert work.stamps[index] == 0


def test_of_the_ways_to_a_root_the_shortest_is_kept_until_it_is_done() -> None:
    work = work_over(np.ones((3, 3), np.bool_))
    index = 2 * 5 + 2
    offer_root(work, 2, 2, 7, 5.0)
    offer_root(work, 2, 2, 8, 6.0)
    assert (work.costs[index], work.before[index], work.state[HEAP_SIZE]) == (5.0, 7, 1)
    offer_root(work, 2, 2, 9, 4.0)
    assert (work.costs[index], work.before[index], work.state[HEAP_SIZE]) == (4.0, 9, 2)
    # The nearest comes first: by its cost, and as the crow flies to the goal.
    assert work.keys[0] == pytest.approx(4.0 + math.sqrt(2.0))
    work.stamps[index] += 1
    offer_root(work, 2, 2, 6, 1.0)
    assert (work.costs[index], work.before[index]) == (4.0, 9)


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_a_goal_behind_a_closed_square_of_the_same_row_is_not_seen(is_mirrored: bool) -> None:
    """Leaning rays would pass the closed square: it lies between the fan and the goal."""
    fits = np.ones((3, 7), np.bool_)
    fits[2, 3] = False
    # In padded cells; the fan is on row 2, and squares 3 and 4 above it are closed.
    left, right, root_x, goal_x = 1.0, 3.0, 1.0, 5.5
    if is_mirrored:
        left, right, root_x, goal_x = 8.0 - right, 8.0 - left, 8.0 - root_x, 8.0 - goal_x
    work = work_over(fits, (goal_x, 2.75))
    work.state[GOAL_SQUARE] = 2
    assert work.open_squares[2, 1:7].tolist() == [1, 1, 0, 0, 1, 1]
    add_fan(work, -1, root_x, 1.5, 0.0, 2, 1, left, right)
    drive_fan(work, 0)
    assert work.ends[4] == FAR
