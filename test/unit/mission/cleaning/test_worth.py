"""Missed floor by size, and by the way that it is worth: against plain loops and made-up plans."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.grid import GridFrame
from roomba.mission.cleaning.worth import (
    is_worth_its_way,
    made_once,
    plan_worth_its_way,
    slivers_of,
)
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.path.planner import NoPathError, NoPathReason

FRAME = GridFrame(0.01, -1.0, 2.0, 60, 80)
CELL = 1e-4
WORTH = 100.0
"""m for each m2, so that a cell is worth a centimetre."""
Mask = NDArray[np.bool_]


def floor_of(*windows: tuple[slice, slice]) -> Mask:
    floor = np.zeros(FRAME.shape, np.bool_)
    for window in windows:
        floor[window] = True
    return floor


BODY = (slice(10, 30), slice(10, 70))
SLIVER = (slice(30, 31), slice(10, 70))
"""A row beside BODY, 60 cells."""


def a_way_of(length: float) -> CoveragePlan:
    return CoveragePlan(np.array([(0.0, 0.0), (length, 0.0)]))


def test_slivers_are_small_patches_that_are_not_ahead() -> None:
    far = (slice(50, 58), slice(10, 18))
    floor, ahead = floor_of(BODY, SLIVER, far), floor_of(BODY)
    assert (slivers_of(floor, ahead, FRAME, 62.0 * CELL) == floor_of(SLIVER)).all()
    assert (slivers_of(floor, ahead, FRAME, 70.0 * CELL) == floor_of(SLIVER, far)).all()
    assert not slivers_of(floor, ahead, FRAME, 50.0 * CELL).any()
    # What is ahead holds nothing together: as one patch all of it would be large.
    assert not slivers_of(floor, floor, FRAME, 1.0).any()


@pytest.mark.parametrize(("more", "is_left"), [(0.59, False), (0.61, True)])
def test_slivers_are_left_that_take_more_way_than_they_are_worth(
    more: float, is_left: bool
) -> None:
    def plan_over(floor: Mask) -> CoveragePlan:
        return a_way_of(10.0 + (more if (floor & floor_of(SLIVER)).any() else 0.0))

    floor = floor_of(BODY, SLIVER)
    plan = plan_worth_its_way(plan_over, floor, floor_of(SLIVER), FRAME, WORTH, planned=9.0)
    assert plan.length == pytest.approx(10.0 if is_left else 10.0 + more)


@pytest.mark.parametrize(("planned", "times"), [(9.41, 1), (9.39, 2)])
def test_a_plan_that_is_hardly_longer_than_the_one_before_is_the_only_one(
    planned: float, times: int
) -> None:
    asked: list[Mask] = []

    def plan_over(floor: Mask) -> CoveragePlan:
        asked.append(floor)
        return a_way_of(10.0)

    floor, sliver = floor_of(BODY, SLIVER), floor_of(SLIVER)
    assert plan_worth_its_way(plan_over, floor, sliver, FRAME, WORTH, planned).length == 10.0
    assert [np.count_nonzero(each) for each in asked] == [1260, 1200][:times]


def test_where_there_are_no_slivers_or_nothing_else_it_plans_once() -> None:
    asked: list[Mask] = []

    def plan_over(floor: Mask) -> CoveragePlan:
        asked.append(floor)
        return a_way_of(1000.0)

    for floor, slivers in ((BODY, floor_of()), (SLIVER, floor_of(SLIVER))):
        plan_worth_its_way(plan_over, floor_of(floor), slivers, FRAME, WORTH, planned=0.0)
    assert [np.count_nonzero(each) for each in asked] == [1200, 60]


@pytest.mark.parametrize(("way", "is_it"), [(0.59, True), (0.61, False)])
def test_floor_is_worth_what_its_way_is_longer_than_the_way_on(way: float, is_it: bool) -> None:
    def plan_over(floor: Mask) -> CoveragePlan:
        return a_way_of(25.0 + (way if floor.any() else 0.0))

    assert is_worth_its_way(plan_over, floor_of(SLIVER), FRAME, WORTH) is is_it


def test_floor_to_which_no_way_is_known_is_tried() -> None:
    def plan_over(floor: Mask) -> CoveragePlan:
        raise NoPathError((0.0, 0.0), NoPathReason.START_BLOCKED, None)

    assert is_worth_its_way(plan_over, floor_of(SLIVER), FRAME, WORTH)


def test_the_plan_over_each_floor_is_made_once_and_its_failure_each_time() -> None:
    asked: list[int] = []

    def plan_over(floor: Mask) -> CoveragePlan:
        asked.append(int(np.count_nonzero(floor)))
        if not floor.any():
            raise NoPathError((0.0, 0.0), NoPathReason.START_BLOCKED, None)
        return a_way_of(float(asked[-1]))

    over = made_once(plan_over)
    body, sliver = floor_of(BODY), floor_of(SLIVER)
    assert over(body) is over(body.copy())
    assert over(sliver).length == 60.0
    assert over(body).length == 1200.0
    assert asked == [1200, 60]
    for _ in range(2):
        with pytest.raises(NoPathError):
            over(np.zeros_like(body))
    assert asked == [1200, 60, 0, 0]
