"""Frontiers: where the known ends, told in the order to go there, and from where to look."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.planning.frontiers.frontiers import Frontier, frontiers, is_frontier
from roomba.planning.frontiers.kernels import clusters, frontier_cells, viewpoint, ways_from

CELL = 0.05
Point = tuple[float, float]
cells = arrays.arrays(
    np.int8, st.tuples(st.integers(4, 14), st.integers(4, 14)),
    elements=st.sampled_from([FREE, FREE, UNKNOWN, OCCUPIED]), fill=st.nothing(),
)  # fmt: skip


def occupancy(values: NDArray[np.int8]) -> OccupancyMap:
    return OccupancyMap(GridFrame(CELL, 0.0, 0.0, *values.shape), values.astype(np.int8))


def room(
    width: float = 4.0, height: float = 3.0, gaps: tuple[Point, ...] = ((1.0, 1.6),)
) -> OccupancyMap:
    """A room of free cells, its walls from (0, 0) on, the unknown around: 0.5 m of it.

    ``gaps`` are the parts of the wall x = width that are open, low and high y, m.
    """
    rows, columns = round(height / CELL) + 22, round(width / CELL) + 22
    values = np.full((rows, columns), UNKNOWN, np.int8)
    values[10:-10, 10:-10] = OCCUPIED
    values[11:-11, 11:-11] = FREE
    made = OccupancyMap(GridFrame(CELL, -0.55, -0.55, rows, columns), values)
    for low, high in gaps:
        first, last = made.frame.cell_of(width, low)[0], made.frame.cell_of(width, high)[0]
        values[first:last, -11] = FREE
    return made


def fits(made: OccupancyMap, cells: int = 3) -> NDArray[np.bool_]:
    """Where a body of so many cells in radius may be: known floor all around it."""
    free = made.values == FREE
    result: NDArray[np.bool_] = free.copy()
    for down in range(-cells, cells + 1):
        for right in range(-cells, cells + 1):
            result &= np.roll(free, (down, right), (0, 1))
    return result


def found_in(made: OccupancyMap, here: Point = (0.5, 0.5), *left_out: Point) -> list[Frontier]:
    return frontiers(made, fits(made), here, left_out)


def test_in_a_closed_room_there_is_none() -> None:
    assert found_in(room(gaps=())) == []


def test_a_doorway_to_the_unknown_is_one() -> None:
    made = room()
    (frontier,) = found_in(made)
    assert frontier.middle == pytest.approx((4.025, 1.3), abs=0.06)
    assert frontier.length == pytest.approx(0.6, abs=0.1)
    assert made.values[made.frame.cell_of(*frontier.middle)] == FREE
    assert fits(made)[made.frame.cell_of(*frontier.viewpoint)]
    assert math.dist(frontier.middle, frontier.viewpoint) < 1.2
    straight = math.dist((0.5, 0.5), frontier.viewpoint)
    assert straight - 0.1 < frontier.way < 1.09 * straight + 0.1


def test_the_nearest_comes_first() -> None:
    made = room(gaps=((0.2, 0.8), (2.2, 2.8)))
    low, high = found_in(made, (0.5, 0.5))
    assert low.middle[1] < high.middle[1]
    assert low.way < high.way
    high, low = found_in(made, (0.5, 2.5))
    assert low.middle[1] < high.middle[1]


def test_a_small_one_waits_for_a_larger_that_is_not_much_farther() -> None:
    """0.3 m beside the robot, and 0.6 m half a metre on."""
    made = room(gaps=((0.4, 0.7), (1.2, 1.8)))
    first, second = found_in(made, (3.5, 0.5))
    assert first.length > 0.4 > second.length
    assert second.way < first.way
    # Were it far away, the small one comes first.
    made = room(height=6.0, gaps=((0.4, 0.7), (4.2, 4.8)))
    first, second = found_in(made, (3.5, 0.5))
    assert first.length < 0.4 < second.length


def test_specks_of_the_unknown_are_ignored() -> None:
    """Shadows of chair legs, of up to 10 cells; a patch of 0.3 m is none."""
    made = room(gaps=())
    made.values[30:33, 30:33] = UNKNOWN
    made.values[50, 50:60] = UNKNOWN
    assert found_in(made) == []
    made.values[30:36, 30:36] = UNKNOWN
    (frontier,) = found_in(made)
    assert math.dist(frontier.middle, made.frame.centre_of(32, 32)) < 0.3


def test_what_was_left_out_is_not_told() -> None:
    made = room(gaps=((0.2, 0.8), (2.2, 2.8)))
    low, high = found_in(made)
    x, y = low.middle
    assert [each.middle for each in found_in(made, (0.5, 0.5), (x - 0.2, y + 0.2))] == [high.middle]
    assert len(found_in(made, (0.5, 0.5), (x - 0.25, y + 0.25))) == 2
    assert found_in(made, (0.5, 0.5), low.middle, high.middle) == []


def test_of_a_long_one_another_place_is_told_when_its_middle_is_left_out() -> None:
    made = room(gaps=((0.5, 2.5),))
    (whole,) = found_in(made)
    (rest,) = found_in(made, (0.5, 0.5), whole.middle)
    assert 0.3 <= math.dist(rest.middle, whole.middle) < 1.1
    assert rest.length == whole.length
    left_out = [whole.middle]
    while found := found_in(made, (0.5, 0.5), *left_out):
        left_out.append(found[0].middle)
        assert len(left_out) < 8
    assert len(left_out) >= 4


def test_where_no_way_leads_nothing_is_told() -> None:
    """A wall across the room, the open side behind it."""
    made = room()
    made.values[10:-10, 40] = OCCUPIED
    assert found_in(made) == []
    # From the other side it is.
    assert len(found_in(made, (3.0, 1.5))) == 1


def test_it_looks_around_corners_only_where_it_sees() -> None:
    """A screen before the doorway: it is looked at from beside the screen, not through it."""
    made = room()
    made.values[24:40, -20] = OCCUPIED
    (frontier,) = found_in(made)
    row, column = made.frame.cell_of(*frontier.middle)
    at_row, at_column = made.frame.cell_of(*frontier.viewpoint)
    for share in np.linspace(0.0, 1.0, 100):
        along = made.values[
            round(at_row + share * (row - at_row)), round(at_column + share * (column - at_column))
        ]
        assert along != OCCUPIED


def test_a_viewpoint_is_in_sight_and_near() -> None:
    """A screen of two cells before a place 20 cells away: only from its ends is it seen."""
    values = np.full((30, 60), FREE, np.int8)
    values[5:25, 40:42] = OCCUPIED
    ways = np.empty(values.shape)
    ways_from(values == FREE, 15, 5, ways)
    row, column, cost = viewpoint(values, ways, 15, 50, 24, 0.1)
    assert row <= 5 or row >= 24 or column >= 42
    assert math.hypot(row - 15, column - 50) <= 24
    assert cost == pytest.approx(ways[row, column] + 0.1 * math.hypot(row - 15, column - 50))
    # Without it the nearest place within reach does.
    open_floor = np.full((30, 60), FREE, np.int8)
    ways_from(open_floor == FREE, 2, 5, ways)
    row, column, _ = viewpoint(open_floor, ways, 20, 50, 24, 0.1)
    assert math.hypot(row - 20, column - 50) <= 24


def test_a_place_off_the_map_is_refused() -> None:
    with pytest.raises(ValueError, match="expected a place on the map"):
        found_in(room(), (-5.0, 0.5))


def test_whether_one_is_left_is_told() -> None:
    made = room()
    (frontier,) = found_in(made)
    assert is_frontier(made, frontier.middle, 0.25)
    assert not is_frontier(made, (1.0, 1.0), 0.25)
    # Nearer to the border than so much it is told as well.
    cut = OccupancyMap(GridFrame(CELL, 0.0, 0.0, 10, 30), np.full((10, 30), FREE, np.int8))
    cut.values[0, 5:25] = UNKNOWN
    assert is_frontier(cut, (0.75, 0.075), 0.25)
    assert not is_frontier(room(gaps=()), frontier.middle, 0.25)
    for far in ((-9.0, 1.0), (9.0, 1.0), (1.0, -9.0), (1.0, 9.0)):
        assert not is_frontier(made, far, 0.25)


@given(cells)
def test_frontier_cells_are_free_with_a_side_to_much_unknown(values: NDArray[np.int8]) -> None:
    least = 5
    marked = np.empty(values.shape, np.bool_)
    frontier_cells(values, least, marked)
    rows, columns = values.shape
    for row in range(rows):
        for column in range(columns):
            expected = False
            if 0 < row < rows - 1 and 0 < column < columns - 1 and values[row, column] == FREE:
                sides = ((row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1))
                expected = any(
                    values[side] == UNKNOWN and len(_patch(values, side)) >= least for side in sides
                )
            assert marked[row, column] == expected


def _patch(values: NDArray[np.int8], begin: tuple[int, int]) -> set[tuple[int, int]]:
    """The unknown cells that hang together with one by their sides."""
    known, todo = {begin}, [begin]
    while todo:
        row, column = todo.pop()
        for at in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            inside = 0 <= at[0] < values.shape[0] and 0 <= at[1] < values.shape[1]
            if inside and at not in known and values[at] == UNKNOWN:
                known.add(at)
                todo.append(at)
    return known


@given(arrays.arrays(np.bool_, st.tuples(st.integers(1, 10), st.integers(1, 10))))
def test_cells_that_touch_are_one_cluster(marked: NDArray[np.bool_]) -> None:
    labels = np.empty(marked.shape, np.int32)
    count = clusters(marked, labels)
    assert ((labels > 0) == marked).all()
    assert set(labels[marked].tolist()) == set(range(1, count + 1))
    at = np.argwhere(marked)
    for row, column in at.tolist():
        for other_row, other_column in at.tolist():
            if max(abs(row - other_row), abs(column - other_column)) == 1:
                assert labels[row, column] == labels[other_row, other_column]


@given(
    arrays.arrays(np.bool_, st.tuples(st.integers(2, 9), st.integers(2, 9))),
    st.integers(0, 1),
    st.integers(0, 1),
)
@settings(max_examples=60)
def test_ways_are_the_shortest_ones(fitting: NDArray[np.bool_], row: int, column: int) -> None:
    ways = np.empty(fitting.shape)
    ways_from(fitting, row, column, ways)
    assert ways == pytest.approx(_relaxed(fitting, row, column))


def _relaxed(fitting: NDArray[np.bool_], row: int, column: int) -> NDArray[np.float64]:
    """The same by repeated relaxing (Bellman and Ford)."""
    ways = np.full(fitting.shape, math.inf)
    ways[row, column] = 0.0
    steps = [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if (a, b) != (0, 0)]
    changed = True
    while changed:
        changed = False
        for at in np.argwhere(np.isfinite(ways)).tolist():
            for down, right in steps:
                to = at[0] + down, at[1] + right
                inside = 0 <= to[0] < fitting.shape[0] and 0 <= to[1] < fitting.shape[1]
                if not inside or not fitting[to]:
                    continue
                if down and right and not (fitting[at[0], to[1]] and fitting[to[0], at[1]]):
                    continue
                on = ways[at[0], at[1]] + math.hypot(down, right)
                if on < ways[to] - 1e-9:
                    ways[to], changed = on, True
    return ways


def test_the_viewpoint_weighs_the_way_against_how_near_it_is() -> None:
    values = np.full((5, 40), FREE, np.int8)
    ways = np.empty(values.shape)
    ways_from(np.ones(values.shape, np.bool_), 2, 2, ways)
    # A metre nearer is worth two of way: it goes all the way.
    assert viewpoint(values, ways, 2, 30, 12, 2.0)[:2] == (2, 30)
    # Were it worth less, it stops as soon as it sees it.
    row, column, cost = viewpoint(values, ways, 2, 30, 12, 0.5)
    assert (row, column) == (2, 18)
    assert cost == pytest.approx(16.0 + 0.5 * 12.0)
    ways[:] = math.inf
    assert viewpoint(values, ways, 2, 30, 12, 2.0) == (-1, -1, math.inf)
