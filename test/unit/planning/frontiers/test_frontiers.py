"""Frontiers: where the known ends, told in the order to go there, and from where to look."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.geometry import Point
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.planning.frontiers.frontiers import (
    Frontier,
    FrontierChoice,
    frontiers,
    is_frontier,
    lengths_near,
)

CELL = 0.05

LEAST = 3
CHOICE = FrontierChoice(
    least_unknown=0.03,
    away=0.3,
    look_from=1.2,
    nearer_worth=2.0,
    small=0.4,
    small_cost=1.0,
    least_cells=LEAST,
    stride=0.3,
    tight_cost=0.5,
)


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
    return frontiers(made, fits(made), fits(made), here, left_out, CHOICE)


def test_in_a_closed_room_there_is_none() -> None:
    assert found_in(room(gaps=())) == []


def test_one_is_found_from_where_the_body_does_not_fit() -> None:
    # It touches the walls of a corner: two cells farther off it fits.
    assert [each.middle for each in found_in(room(), (0.03, 0.03))] == [
        each.middle for each in found_in(room())
    ]


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
    made = room(gaps=((0.2, 0.7), (2.2, 2.7)))
    low, high = found_in(made)
    x, y = low.middle
    # Nothing of the 0.5 m is farther than 0.3 m from here; then its middle is.
    assert [each.middle for each in found_in(made, (0.5, 0.5), (x - 0.1, y + 0.05))] == [
        high.middle
    ]
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


def test_it_is_looked_at_from_where_there_is_room() -> None:
    """Nearer to the doorway there is little; where there is little everywhere, that must do."""
    made, tight = room(), fits(room())
    roomy = fits(made, 6)
    (frontier,) = frontiers(made, tight, roomy, (0.5, 0.5), (), CHOICE)
    (nearest,) = found_in(made)
    assert roomy[made.frame.cell_of(*frontier.viewpoint)]
    assert not roomy[made.frame.cell_of(*nearest.viewpoint)]
    # The way that is told is the way.
    assert frontier.way < nearest.way
    (squeezed,) = frontiers(made, tight, np.zeros_like(roomy), (0.5, 0.5), (), CHOICE)
    assert squeezed == nearest


@pytest.mark.parametrize("here", [(-0.57, 0.5), (-5.0, 0.5), (0.5, 9.0)])
def test_off_the_map_ways_begin_at_the_nearest_place_that_fits(here: Point) -> None:
    made, tight = room(), fits(room())
    assert not made.frame.contains(*here)
    places = np.argwhere(tight)
    row, column = made.frame.cell_of(*here)
    nearest = places[np.argmin(np.hypot(places[:, 0] - row, places[:, 1] - column))]
    on_map = made.frame.centre_of(int(nearest[0]), int(nearest[1]))
    assert found_in(made, here) == found_in(made, on_map)
    nowhere = np.zeros_like(tight)
    assert frontiers(made, nowhere, nowhere, here, (), CHOICE) == []


def test_whether_one_is_left_is_told() -> None:
    made = room()
    (frontier,) = found_in(made)
    assert is_frontier(made, frontier.middle, 0.25, LEAST)
    assert not is_frontier(made, (1.0, 1.0), 0.25, LEAST)
    # Nearer to the border than so much it is told as well.
    cut = OccupancyMap(GridFrame(CELL, 0.0, 0.0, 10, 30), np.full((10, 30), FREE, np.int8))
    cut.values[0, 5:25] = UNKNOWN
    assert is_frontier(cut, (0.75, 0.075), 0.25, LEAST)
    assert not is_frontier(room(gaps=()), frontier.middle, 0.25, LEAST)
    for far in ((-9.0, 1.0), (9.0, 1.0), (1.0, -9.0), (1.0, 9.0)):
        assert not is_frontier(made, far, 0.25, LEAST)


def test_a_frontier_is_as_long_as_its_cells_and_counts_once() -> None:
    made = room(gaps=((0.4, 0.8), (1.4, 2.6)))
    long, short, same = (4.0, 2.0), (4.0, 0.6), (4.0, 1.5)
    lengths = lengths_near(made, [long, short, same, (1.0, 1.0)], 0.25, 0.03)
    assert lengths == pytest.approx([1.2, 0.4, 0.0, 0.0], abs=2.1 * CELL)
    assert lengths_near(room(gaps=()), [long], 0.25, 0.03).tolist() == [0.0]
    assert lengths_near(made, [], 0.25, 0.03).size == 0
