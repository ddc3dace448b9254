"""Doorways of floors that are drawn with them, against flood fill and distances cell by cell."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.references.straight_ways import Mask, parts_of
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from roomba.configuration.rooms import RoomsConfig
from roomba.perception.rooms.doorways import Opening, clearance_of, doorways

CELL = 0.1
CONFIG = RoomsConfig()


@given(arrays(np.bool_, st.tuples(st.integers(2, 10), st.integers(2, 10))))
@settings(max_examples=examples(40))
def test_clearance_is_the_distance_from_a_cell_s_middle_to_the_side_of_what_is_solid(
    solid: Mask,
) -> None:
    solid[0, 0] = True
    found = clearance_of(solid)
    things = [(row, column) for row, column in np.argwhere(solid).tolist()]
    for row, column in np.ndindex(*solid.shape):
        away = min(math.dist((row, column), other) for other in things)
        assert found[row, column] == pytest.approx(away - 0.5, abs=1e-4)


@st.composite
def two_rooms(draw: st.DrawFn) -> tuple[Mask, int, int, int, int]:
    """Rooms of at least 2.5 m, a wall between them and a door in it: its rows, and the wall's
    columns; first and last."""
    rows, columns = draw(st.integers(30, 45)), draw(st.integers(60, 75))
    solid = np.ones((rows, columns), np.bool_)
    solid[1:-1, 1:-1] = False
    wall = draw(st.integers(26, 33))
    thick = draw(st.integers(1, 3))
    width = draw(st.integers(6, 12))
    # Jambs of at least 0.4 m: narrower ones are things that stand beside a wall.
    first = draw(st.integers(5, rows - width - 5))
    solid[:, wall : wall + thick] = True
    solid[first : first + width, wall : wall + thick] = False
    return solid, first, first + width - 1, wall, wall + thick - 1


def cells_between(opening: Opening) -> list[tuple[int, int]]:
    """The cells nearest to the straight way between an opening's ends, without these."""
    down, right = opening.to_row - opening.row, opening.to_column - opening.column
    steps = max(abs(down), abs(right))
    return [
        (round(opening.row + step * down / steps), round(opening.column + step * right / steps))
        for step in range(1, steps)
    ]


@given(two_rooms(), st.booleans())
@settings(max_examples=examples(40))
def test_a_door_between_two_rooms_is_the_one_opening(
    drawn: tuple[Mask, int, int, int, int], is_turned: bool
) -> None:
    solid, first, last, wall, end = drawn
    found = doorways(solid.T.copy() if is_turned else solid, CELL, CONFIG)
    (opening,) = found
    ends = [(opening.row, opening.column), (opening.to_row, opening.to_column)]
    if is_turned:
        ends = [(row, column) for column, row in ends]
    (low, low_column), (high, high_column) = sorted(ends)
    assert (low, high) == (first - 1, last + 1)
    assert wall <= low_column <= end
    assert wall <= high_column <= end
    width = math.hypot(high - low, high_column - low_column) - 1.0
    assert opening.width == pytest.approx(width * CELL)


@given(two_rooms(), st.integers(0, 2**32 - 1))
@settings(max_examples=examples(40))
def test_openings_end_at_what_is_solid_lead_over_floor_and_are_of_a_door_s_width_or_narrow(
    drawn: tuple[Mask, int, int, int, int], seed: int
) -> None:
    """Things stand about, so that there may be more of them, or none at the door."""
    solid = drawn[0]
    random = np.random.default_rng(seed)
    for _ in range(int(random.integers(0, 6))):
        row, column = random.integers(1, 40), random.integers(1, 60)
        solid[row : row + random.integers(1, 9), column : column + random.integers(1, 9)] = True
    solid[0] = solid[-1] = solid[:, 0] = solid[:, -1] = True
    for opening in doorways(solid, CELL, CONFIG):
        assert solid[opening.row, opening.column]
        assert solid[opening.to_row, opening.to_column]
        assert not any(solid[cell] for cell in cells_between(opening))
        ends = (opening.row, opening.column), (opening.to_row, opening.to_column)
        assert opening.width == pytest.approx((math.dist(*ends) - 1.0) * CELL)
        assert opening.width >= CONFIG.narrowest_door - 0.5 * CELL - 1e-9


@given(two_rooms())
@settings(max_examples=examples(30))
def test_closing_the_door_parts_the_floor(drawn: tuple[Mask, int, int, int, int]) -> None:
    solid = drawn[0]
    assert len(parts_of(~solid)) == 1
    for opening in doorways(solid, CELL, CONFIG):
        for cell in cells_between(opening):
            solid[cell] = True
    assert len([part for part in parts_of(~solid) if len(part) > 100]) == 2


def test_an_empty_room_has_no_doorway() -> None:
    solid = np.ones((40, 60), np.bool_)
    solid[1:-1, 1:-1] = False
    assert doorways(solid, CELL, CONFIG) == []
