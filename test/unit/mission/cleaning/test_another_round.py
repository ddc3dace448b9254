"""The floor for which another round is made: by what is in reach, and by made-up plans."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.driven_cleans import FENCE, context
from fixtures.robots.missions import DEN, TWO_ROOMS, WALL_X
from numpy.typing import NDArray

from roomba.configuration.mission import CleaningConfig
from roomba.grid import GridFrame
from roomba.mission.cleaning.another_round import (
    floor_in_reach,
    may_be_opened,
    rounded_off,
    worth_another_round,
)
from roomba.planning.coverage.plan import CoveragePlan

PLACE = context(TWO_ROOMS)
STATION_SIDE, DEN_SIDE = (0.85, 1.2), (WALL_X + 1.0, 1.2)
FRAME = GridFrame(0.01, 0.0, 0.0, 100, 100)
LARGE, SMALL = (slice(10, 30), slice(10, 30)), (slice(60, 70), slice(60, 70))
"""400 and 100 cells: 0.04 and 0.01 m2."""
CONFIG = CleaningConfig(
    enough=0.9, least_patch=0.005, least_for_round=0.02, worth_way=100.0, worth_way_to_enough=500.0
)
Mask = NDArray[np.bool_]


def floor_of(*windows: tuple[slice, slice]) -> Mask:
    floor = np.zeros(FRAME.shape, np.bool_)
    for window in windows:
        floor[window] = True
    return floor


def round_over(left: Mask, wanted: int, way_per_cell: float) -> Mask:
    """Return what is worth a round, where a plan is so many m long for each cell."""

    def plan_over(floor: Mask) -> CoveragePlan:
        return CoveragePlan(np.array([(0.0, 0.0), (way_per_cell * np.count_nonzero(floor), 0.0)]))

    return worth_another_round(left, wanted, FRAME, plan_over, CONFIG)


def test_behind_a_shut_door_nothing_is_in_reach_but_for_who_is_there() -> None:
    den = PLACE.in_room(DEN) & PLACE.coverable()
    assert floor_in_reach(PLACE, STATION_SIDE, [])[den].all()
    assert not floor_in_reach(PLACE, STATION_SIDE, FENCE)[den].any()
    shut_in = floor_in_reach(PLACE, DEN_SIDE, FENCE)
    assert shut_in[den].mean() > 0.9
    assert shut_in[PLACE.frame.cell_of(*STATION_SIDE)]


@pytest.mark.parametrize("beyond", [(-0.5, -0.5), (PLACE.frame.extent[1] + 0.5, 1.2)])
def test_a_robot_that_believes_itself_off_the_map_adds_no_floor(
    beyond: tuple[float, float],
) -> None:
    from_the_station = floor_in_reach(PLACE, STATION_SIDE, FENCE)
    assert np.array_equal(floor_in_reach(PLACE, beyond, FENCE), from_the_station)


def test_a_room_may_be_opened_and_floor_below_a_thing_may_not() -> None:
    den = PLACE.in_room(DEN) & PLACE.coverable()
    assert may_be_opened(den, PLACE, FENCE, 0.5)
    assert not may_be_opened(den, PLACE, FENCE, 1.1 * den.sum() * PLACE.frame.resolution**2)
    x, y = STATION_SIDE
    below = np.zeros(PLACE.frame.shape, np.bool_)
    row, column = PLACE.frame.cell_of(x, y)
    below[row - 10 : row + 10, column - 10 : column + 10] = True
    assert not may_be_opened(below, PLACE, [(x, y, 0.1)], 0.01)


def test_where_no_plan_can_begin_none_leaves_floor() -> None:
    assert not rounded_off(PLACE, (WALL_X + 0.05, 0.1), []).any()


def test_with_too_little_clean_small_patches_count_and_more_way_is_worth_it() -> None:
    left, wanted = floor_of(LARGE, SMALL), 1000
    # 500 m for each m2 is 5 cm for each cell.
    assert (round_over(left, wanted, 0.049) == left).all()
    assert not round_over(left, wanted, 0.051).any()


def test_with_enough_clean_small_patches_are_left_and_less_way_is_worth_it() -> None:
    left, wanted = floor_of(LARGE, SMALL), 10_000
    assert (round_over(left, wanted, 0.0099) == floor_of(LARGE)).all()
    assert not round_over(left, wanted, 0.0101).any()


def test_a_stage_of_which_nothing_is_in_reach_has_no_round() -> None:
    assert not round_over(floor_of(), 0, 0.0).any()
