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


def test_what_is_not_known_to_be_free_is_solid() -> None:
    values = np.array([[FREE, OCCUPIED, UNKNOWN]], np.int8)
    known = OccupancyMap(GridFrame(0.1, 0.0, 0.0, 1, 3), values)
    assert known.solid.tolist() == [[False, True, True]]


def test_values_that_do_not_fit_the_frame_are_refused() -> None:
    with pytest.raises(ValueError, match=r"\(40, 60\), got \(3, 3\)"):
        OccupancyMap(FRAME, np.zeros((3, 3), np.int8))
