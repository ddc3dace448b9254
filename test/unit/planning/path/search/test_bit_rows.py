"""Rows of cells as bits, against Python's integers and a walk cell by cell."""

from __future__ import annotations

import numpy as np
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from roomba.planning.path.search.bit_rows import NOWHERE, bit_rows, is_set, jump

Cells = NDArray[np.uint8]

COLUMNS = st.sampled_from([1, 2, 7, 61, 62, 63, 64, 126, 130])
"""Around the ends of words of 64 bits, of which the border takes two."""


def cells(rows: st.SearchStrategy[int], closed: int) -> st.SearchStrategy[Cells]:
    """Cells that may be entered, 1, and one of ``closed`` that may not."""
    return arrays(
        np.uint8,
        st.tuples(rows, COLUMNS),
        elements=st.integers(0, closed - 1).map(lambda number: int(number > 0)),
        fill=st.just(1),
    )


@given(cells(st.integers(1, 4), 2))
@settings(max_examples=examples(60))
def test_bit_x_plus_1_of_row_y_plus_1_is_a_cell_and_the_border_is_closed(free: Cells) -> None:
    packed = bit_rows(free)
    words = packed.shape[1]
    for row, own in enumerate(packed):
        number = sum(int(word) << (64 * index) for index, word in enumerate(own))
        inside = 0 < row <= len(free)
        expected = 0
        if inside:
            expected = sum(int(bit) << (x + 1) for x, bit in enumerate(free[row - 1]))
        assert number == expected
        for column in range(64 * words):
            assert is_set(packed, row, column) == bool(expected >> column & 1)


@given(cells(st.just(3), 40), st.data())
@settings(max_examples=examples(300))
def test_a_jump_ends_where_a_walk_cell_by_cell_does(free: Cells, data: st.DataObject) -> None:
    open_columns = np.flatnonzero(free[1]).tolist()
    assume(open_columns)
    begin = data.draw(st.sampled_from(open_columns))
    target = data.draw(st.sampled_from([-2, *open_columns]))
    step = data.draw(st.sampled_from([1, -1]))
    packed = bit_rows(free)
    found = jump(packed, 2, begin + 1, step, target + 1 if target >= 0 else NOWHERE)
    assert found == walked(free, begin, step, target)


def walked(free: Cells, begin: int, step: int, target: int) -> int:
    """The same in padded columns, along the middle one of three rows."""
    above, here, below = ([0, *row, 0] for row in free[::-1].tolist())
    at = begin + 1
    while True:
        at += step
        if not here[at]:
            return NOWHERE
        if at == target + 1:
            return at
        if any(row[at] and not row[at - step] for row in (above, below)):
            return at
