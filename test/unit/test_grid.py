import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap

FRAME = GridFrame(0.05, -1.0, 2.0, rows=40, columns=60)


@given(st.integers(0, 39), st.integers(0, 59))
def test_the_centre_of_a_cell_lies_in_that_cell(row: int, column: int) -> None:
    x, y = FRAME.centre_of(row, column)
    assert FRAME.cell_of(x, y) == (row, column)
    assert FRAME.contains(x, y)


def test_row_zero_is_the_lowest_y() -> None:
    assert FRAME.cell_of(-1.0 + 0.01, 2.0 + 0.01) == (0, 0)
    assert FRAME.cell_of(-0.7, 2.01) == (0, 6)


def test_points_beside_the_grid_are_not_on_it() -> None:
    assert not FRAME.contains(-1.001, 2.5)
    assert not FRAME.contains(0.0, 4.001)
    assert FRAME.extent == pytest.approx((-1.0, 2.0, 2.0, 4.0))


@given(st.lists(st.tuples(st.floats(-3.0, 5.0), st.floats(0.0, 6.0)), min_size=1))
def test_many_points_lie_where_each_of_them_lies(points: list[tuple[float, float]]) -> None:
    x, y = np.array(points).T
    rows, columns = FRAME.cells_of(x, y)
    assert list(zip(rows.tolist(), columns.tolist(), strict=True)) == [
        FRAME.cell_of(*point) for point in points
    ]
    assert FRAME.holds(rows, columns).tolist() == [FRAME.contains(*point) for point in points]


def test_with_other_cells_it_begins_at_the_same_corner_and_covers_as_much() -> None:
    coarse = FRAME.with_cells(0.3)
    assert coarse == GridFrame(0.3, -1.0, 2.0, rows=7, columns=10)
    assert FRAME.with_cells(FRAME.resolution) == FRAME


def test_what_is_not_known_to_be_free_is_solid() -> None:
    values = np.array([[FREE, OCCUPIED, UNKNOWN]], np.int8)
    known = OccupancyMap(GridFrame(0.1, 0.0, 0.0, 1, 3), values)
    assert known.solid.tolist() == [[False, True, True]]


def test_values_that_do_not_fit_the_frame_are_refused() -> None:
    with pytest.raises(ValueError, match=r"\(40, 60\), got \(3, 3\)"):
        OccupancyMap(FRAME, np.zeros((3, 3), np.int8))


def test_centres_are_those_of_the_cells_one_by_one() -> None:
    x, y = FRAME.centres()
    assert (x.shape, y.shape) == ((60,), (40,))
    each = [FRAME.centre_of(row, column) for row, column in ((0, 0), (7, 31), (39, 59))]
    assert each == [(x[0], y[0]), (x[31], y[7]), (x[59], y[39])]


def test_centres_of_chosen_cells_keep_the_shape_of_the_choice() -> None:
    rows, columns = np.array([[3, 4]]), np.array([5, 6, 7])
    x, y = FRAME.centres(rows, columns)
    assert y.tolist() == [[FRAME.centre_of(row, 0)[1] for row in (3, 4)]]
    assert x.tolist() == [FRAME.centre_of(0, column)[0] for column in (5, 6, 7)]


def test_between_two_centres_lies_their_middle() -> None:
    x, y = FRAME.centres(np.array([0.5]), np.array([2.5]))
    assert (x[0], y[0]) == pytest.approx((-1.0 + 0.05 * 3.0, 2.0 + 0.05))
