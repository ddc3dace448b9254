"""Counting beams: through the cells before a surface, ended in its own, nothing behind."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.robots.mapped import Floats
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.grid import FREE, OCCUPIED, UNKNOWN
from roomba.perception.slam.drawing.drawing_kernels import (
    MARGIN,
    CountArrays,
    draw,
    occupancy,
)

CELL = 0.05
SIZE = 60
CENTRE = np.zeros(2)


def no_counts() -> CountArrays:
    counts = np.zeros((2, SIZE, SIZE), np.uint16)
    corner = -0.5 * SIZE * CELL
    bounds = np.array([2**40, -1, 2**40, -1])
    offsets = np.zeros((SIZE, SIZE, 2), np.float32)
    return CountArrays(counts[0], counts[1], np.array([corner, corner, CELL]), bounds, offsets)


def drawn(*points: tuple[float, float, float, float], pose: Floats | None = None) -> CountArrays:
    made = no_counts()
    here = np.array([0.01, 0.01, 0.0]) if pose is None else pose
    draw(made, np.array(points, np.float32).reshape(-1, 4), CENTRE, here)
    return made


def cell(x: float, y: float) -> tuple[int, int]:
    return math.floor(y / CELL) + SIZE // 2, math.floor(x / CELL) + SIZE // 2


def values_of(
    made: CountArrays, share: float = 0.3, least: int = 1
) -> tuple[NDArray[np.int8], int, int]:
    """All that is known, and its first row and column."""
    first_row, last_row, first_column, last_column = made.bounds.tolist()
    shape = last_row - first_row + 1 + 2 * MARGIN, last_column - first_column + 1 + 2 * MARGIN
    values = np.empty(shape, np.int8)
    occupancy(made, share, least, values)
    return values[MARGIN:-MARGIN, MARGIN:-MARGIN], first_row, first_column


def is_within_a_cell(place: NDArray[np.float64]) -> bool:
    """Whether a place is off the borders of cells, where rounding tells to which one it belongs."""
    return bool((np.abs(place / CELL - np.round(place / CELL)) > 1e-4).all())


@given(st.floats(0.15, 1.2), st.floats(-math.pi, math.pi), st.booleans())
def test_free_before_occupied_at_nothing_behind(way: float, angle: float, faces: bool) -> None:
    along = np.array([math.cos(angle), math.sin(angle)])
    normal = -along if faces else np.zeros(2)
    made = drawn((*(way * along), *normal))
    end, shares = 0.01 + way * along, np.linspace(0.0, 1.0, 200)
    behind = end + 0.4 * CELL * along
    assume(is_within_a_cell(behind))
    hit = cell(*behind)
    assert np.argwhere(made.hits).tolist() == [list(hit)]
    assert made.hits[hit] == 1
    on_the_way = [0.01 + share * (way - 0.51 * CELL) * along for share in shares]
    before = {cell(*place) for place in on_the_way if is_within_a_cell(place)}
    through = {tuple(at) for at in np.argwhere(made.passes).tolist()}
    assert before <= through
    # None of the cells through which it went twice, and none beyond where it ended.
    assert made.passes.max() == 1
    far = max(math.hypot(*((np.array(at)[::-1] - SIZE // 2 + 0.5) * CELL)) for at in through)
    assert far < way + 0.05
    assert len(through) <= 2.0 * way / CELL + 4.0


def test_a_wall_is_drawn_where_it_is() -> None:
    """Its surface at the border of two cells: all of it is in the second, none in the first."""
    made = no_counts()
    random = np.random.default_rng(4)
    for _ in range(20):
        y = np.linspace(-0.8, 0.8, 100)
        x = 0.5 + random.normal(0.0, 0.005, 100)
        points = np.column_stack((x, y, np.full(100, -1.0), np.zeros(100)))
        draw(made, points.astype(np.float32), CENTRE, np.array([0.0, 0.0, 0.0]))
    values, first_row, first_column = values_of(made, least=2)
    column = cell(0.525, 0.0)[1] - first_column
    rows = slice(cell(0.0, -0.7)[0] - first_row, cell(0.0, 0.7)[0] - first_row)
    assert (values[rows, column] == OCCUPIED).all()
    assert (values[rows, column - 1] == FREE).all()
    assert values.shape[1] == column + 1


@given(st.floats(-math.pi, math.pi), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_it_is_drawn_as_seen_from_the_pose(theta: float, x: float, y: float) -> None:
    made = no_counts()
    here, lidar = np.array([x, y, theta]), np.array([0.1, 0.05])
    draw(made, np.array([[0.6, 0.2, 0.0, 0.0]], np.float32), lidar, here)
    cosine, sine = math.cos(theta), math.sin(theta)
    end = (x + 0.6 * cosine - 0.2 * sine, y + 0.6 * sine + 0.2 * cosine)
    start = (x + 0.1 * cosine - 0.05 * sine, y + 0.1 * sine + 0.05 * cosine)
    ((row, column),) = np.argwhere(made.hits).tolist()
    hit = np.array([column + 0.5, row + 0.5]) * CELL - 0.5 * SIZE * CELL
    assert np.abs(hit - end).max() < 0.05 + 1e-9
    at_row, at_column = cell(*start)
    # On the border of two cells it may be in either.
    assert made.passes[at_row - 1 : at_row + 2, at_column - 1 : at_column + 2].any()
    through = np.argwhere(made.passes)
    assert made.bounds[0] <= min(row, through[:, 0].min())
    assert made.bounds[1] >= max(row, through[:, 0].max())
    assert made.bounds[2] <= min(column, through[:, 1].min())
    assert made.bounds[3] >= max(column, through[:, 1].max())


@pytest.mark.parametrize("x", [-math.inf, -9.0, 9.0, 1e6])
def test_what_lies_off_the_sheet_is_cut_off(x: float) -> None:
    far = max(min(x, 50.0), -50.0)
    made = drawn((far, 0.3 * far, 0.0, 0.0), (0.5, 0.0, 0.0, 0.0))
    assert made.hits.sum() == 1
    assert 0 <= made.bounds[0] <= made.bounds[1] < SIZE
    assert 0 <= made.bounds[2] <= made.bounds[3] < SIZE
    assert made.passes.sum() > 20


def test_a_point_in_the_lidar_is_left_out() -> None:
    assert drawn((0.0, 0.0, 0.0, 0.0)).hits.sum() == 0


def test_counts_never_overflow() -> None:
    made = drawn((0.5, 0.01, 0.0, 0.0))
    hit = tuple(np.argwhere(made.hits)[0])
    made.hits[hit] = made.passes[cell(0.2, 0.01)] = 60000
    draw(made, np.array([[0.5, 0.01, 0.0, 0.0]], np.float32), CENTRE, np.array([0.01, 0.01, 0.0]))
    assert made.hits[hit] == 30001
    assert made.passes[cell(0.2, 0.01)] == 30001


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-math.pi, math.pi))
def test_erased_it_is_as_if_it_had_never_been_drawn(x: float, y: float, theta: float) -> None:
    random = np.random.default_rng(7)
    points = random.uniform(-1.5, 1.5, (40, 4)).astype(np.float32)
    made, here = drawn(*points.tolist()), np.array([x, y, theta])
    hits, passes = made.hits.copy(), made.passes.copy()
    draw(made, points, CENTRE, here)
    assert made.passes.sum() > passes.sum()
    draw(made, points, CENTRE, here, times=-1)
    assert (made.hits == hits).all()
    assert (made.passes == passes).all()
    empty = no_counts()
    draw(empty, points, CENTRE, here, times=-1)
    assert not empty.hits.any()
    assert not empty.passes.any()


@given(st.integers(0, 50), st.integers(0, 50), st.floats(0.05, 1.0), st.integers(1, 5))
def test_what_a_cell_is_depends_on_its_counts(
    ended: int, through: int, share: float, least: int
) -> None:
    assume(abs(ended - share * (ended + through)) > 1e-6)
    made = no_counts()
    made.hits[3, 4], made.passes[3, 4] = ended, through
    made.bounds[:] = 3, 3, 4, 4
    value = values_of(made, share, least)[0][0, 0]
    if ended == 0 and through == 0:
        assert value == UNKNOWN
    elif ended >= least and ended / (ended + through) >= share:
        assert value == OCCUPIED
    elif through:
        assert value == FREE
    else:
        assert value == OCCUPIED


@pytest.mark.parametrize(("up", "right"), [(0, 1), (1, 0), (0, -1), (-1, 0)])
@pytest.mark.parametrize(
    ("towards", "ended", "through", "expected"),
    [
        (0.45, 20, 0, FREE),
        (0.70, 20, 0, FREE),
        (0.20, 20, 0, OCCUPIED),
        (-0.45, 20, 0, OCCUPIED),
        (0.45, 20, 20, OCCUPIED),
        (0.45, 1, 0, OCCUPIED),
        (0.45, 0, 0, OCCUPIED),
    ],
    ids=["at the border", "beyond", "within", "elsewhere", "no surer", "one beam", "nothing"],
)
def test_the_edge_of_a_thing_is_not_a_second_one(
    up: int, right: int, towards: float, ended: int, through: int, expected: int
) -> None:
    """10 of 25 beams ended in a cell, met so near to the next one, of which more is known."""
    made = no_counts()
    made.hits[9, 9], made.passes[9, 9] = 10, 15
    made.offsets[9, 9] = 10 * towards * right, 10 * towards * up
    made.hits[9 + up, 9 + right], made.passes[9 + up, 9 + right] = ended, through
    made.bounds[:] = 9, 9, 9, 9
    assert values_of(made, 0.3, 2)[0][0, 0] == expected


def test_a_cell_at_the_rim_of_the_sheet_has_nothing_beside_it() -> None:
    made = no_counts()
    # What comes in memory before and after the rim.
    made.hits[-1, 5] = made.hits[6, 0] = 20
    for row, column, offset in ((0, 5, (0.0, -1.0)), (5, SIZE - 1, (1.0, 0.0))):
        made.hits[row, column], made.passes[row, column] = 4, 4
        made.offsets[row, column] = offset
        made.bounds[:] = row, row, column, column
        assert values_of(made)[0][0, 0] == OCCUPIED


@given(st.floats(0.15, 1.2), st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi))
def test_offsets_tell_where_the_surface_was_met(way: float, angle: float, faces: float) -> None:
    end = way * np.array([math.cos(angle), math.sin(angle)])
    made = drawn((*end, math.cos(faces), math.sin(faces)))
    ((row, column),) = np.argwhere(made.hits).tolist()
    middle = (np.array([column, row]) + 0.5 - SIZE // 2) * CELL
    assert made.offsets[row, column] == pytest.approx((end + 0.01 - middle) / CELL, abs=1e-4)
    assert np.count_nonzero(made.offsets.any(axis=2)) <= 1


def test_offsets_are_halved_with_the_counts() -> None:
    made = drawn((0.5, 0.01, 0.0, 0.0))
    hit = tuple(np.argwhere(made.hits)[0])
    one = made.offsets[hit].copy()
    made.hits[hit], made.offsets[hit] = 60000, 60000 * one
    draw(made, np.array([[0.5, 0.01, 0.0, 0.0]], np.float32), CENTRE, np.array([0.01, 0.01, 0.0]))
    assert made.offsets[hit] / made.hits[hit] == pytest.approx(one, rel=1e-4)


def test_who_asks_for_no_map_needs_no_offsets() -> None:
    counts, corner = np.zeros((2, SIZE, SIZE), np.uint16), -0.5 * SIZE * CELL
    place, bounds = np.array([corner, corner, CELL]), np.array([2**40, -1, 2**40, -1])
    made = CountArrays(counts[0], counts[1], place, bounds)
    draw(made, np.array([[0.5, 0.0, 0.0, 0.0]], np.float32), CENTRE, np.zeros(3))
    assert made.hits.sum() == 1
    assert values_of(made)[0].size
