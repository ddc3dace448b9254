"""Kernels of the frontiers, against plain loops over all cells."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from roomba.grid import FREE, OCCUPIED, UNKNOWN
from roomba.planning.frontiers.kernels import (
    clusters,
    frontier_cells,
    seen_from,
    viewpoint,
    ways_from,
)

cells = arrays.arrays(
    np.int8, st.tuples(st.integers(4, 14), st.integers(4, 14)),
    elements=st.sampled_from([FREE, FREE, UNKNOWN, OCCUPIED]), fill=st.nothing(),
)  # fmt: skip


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
@settings(max_examples=examples(40))
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


def is_seen(values: NDArray[np.int8], row: int, column: int, to_row: int, to_column: int) -> bool:
    """Whether no cell that is nearest to the straight way, step by step, is occupied."""
    steps = max(abs(to_row - row), abs(to_column - column))
    for step in range(1, steps):
        down, right = step * (to_row - row) / steps, step * (to_column - column) / steps
        if values[round(row + down), round(column + right)] == OCCUPIED:
            return False
    return True


def least_cost(
    values: NDArray[np.int8], ways: NDArray[np.float64], cell: tuple[int, int], aside: float
) -> float:
    """Of all cells within RADIUS that see one, the least of the way and how far they are aside."""
    best = math.inf
    for row, column in np.ndindex(*values.shape):
        away = math.dist((row, column), cell)
        if away <= RADIUS and is_seen(values, row, column, *cell):
            best = min(best, float(ways[row, column]) + aside * away)
    return best


RADIUS = 4


@given(cells, st.data(), st.sampled_from([0.0, 0.5, 2.0]))
@settings(max_examples=examples(40))
def test_the_viewpoint_is_the_best_of_all_cells(
    values: NDArray[np.int8], data: st.DataObject, aside: float
) -> None:
    rows, columns = values.shape
    begin = data.draw(st.tuples(st.integers(0, rows - 1), st.integers(0, columns - 1)))
    looked_at = data.draw(st.tuples(st.integers(0, rows - 1), st.integers(0, columns - 1)))
    ways = np.empty(values.shape)
    ways_from(values == FREE, *begin, ways)
    row, column, cost = viewpoint(values, ways, *looked_at, RADIUS, aside)
    assert cost == pytest.approx(least_cost(values, ways, looked_at, aside))
    if math.isfinite(cost):
        away = math.dist((row, column), looked_at)
        assert away <= RADIUS
        assert is_seen(values, row, column, *looked_at)
        assert cost == pytest.approx(ways[row, column] + aside * away)


@given(cells, st.integers(0, 2**32 - 1))
@settings(max_examples=examples(40))
def test_the_first_cell_that_is_not_left_out_and_can_be_looked_at_is_taken(
    values: NDArray[np.int8], seed: int
) -> None:
    random = np.random.default_rng(seed)
    ways = np.empty(values.shape)
    start_row, start_column = random.integers(0, values.shape).tolist()
    ways_from(values == FREE, start_row, start_column, ways)
    tried = random.integers(0, values.shape, (5, 2))
    middles = (tried[:, ::-1] + 0.5) * 0.1
    left_out = random.uniform(0.0, 1.4, (int(random.integers(0, 6)), 2))
    found = seen_from(tried, middles, left_out, 0.25, values, ways, RADIUS, 2.0)
    for index, (cell, middle) in enumerate(zip(tried.tolist(), middles.tolist(), strict=True)):
        at_row, at_column = cell
        if any(math.dist(middle, each) < 0.25 for each in left_out.tolist()):
            continue
        row, column, cost = viewpoint(values, ways, at_row, at_column, RADIUS, 2.0)
        if math.isfinite(cost):
            assert found == (index, row, column)
            return
    assert found == (-1, -1, -1)
