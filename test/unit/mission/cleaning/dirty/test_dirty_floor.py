"""Dirty floor: which of it is swept again in passing, and which at the end, and when it is looked
for."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.configuration.mission import CleaningConfig
from roomba.grid import FREE, GridFrame, OccupancyMap
from roomba.mission.cleaning.dirty.dirty_floor import DirtyFloor
from roomba.perception.swept.coverage_bits import SWEPT
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.perception.swept.dirt_map import CELL, DirtMap

COARSE = GridFrame(0.05, 0.0, 0.0, 80, 80)
FINE = GridFrame(0.01, 0.0, 0.0, 400, 400)
FLOOR = np.ones(FINE.shape, np.bool_)
BY_IT, FAR = (2.0, 1.6), (0.3, 3.7)
NOW = 100.0
"""s."""
USUAL, DIRTY = 40.0, 4000.0
"""Grains of a cell."""


def swept_floor(dirty: dict[tuple[int, int], float]) -> tuple[DirtMap, CoverageMap]:
    """A room of 4 x 4 m, all swept; ``dirty`` are cells of its dirt map with their grains."""
    dirt = DirtMap(OccupancyMap(COARSE, np.full(COARSE.shape, FREE, np.int8)))
    for row in range(20):
        for column in range(20):
            grains = dirty.get((row, column), USUAL)
            dirt.note((column + 0.5) * CELL, (row + 0.5) * CELL, grains, CELL)
    coverage = CoverageMap(FINE, FLOOR, 0.2)
    coverage.cells |= np.uint8(SWEPT)
    coverage.count_again()
    return dirt, coverage


def patch(rows: range, columns: range) -> dict[tuple[int, int], float]:
    """Dirty cells."""
    return {(row, column): DIRTY for row in rows for column in columns}


TWO, SIX = patch(range(5, 6), range(9, 11)), patch(range(5, 7), range(9, 12))


def test_a_dirty_patch_is_told_once_when_the_robot_is_by_it() -> None:
    dirt, coverage = swept_floor(TWO)
    dirty = DirtyFloor(dirt, CleaningConfig())
    assert not dirty.at_hand(coverage, FLOOR, FAR, NOW)
    (again,) = dirty.at_hand(coverage, FLOOR, BY_IT, NOW)
    rows, columns = np.nonzero(again.floor)
    assert (rows.min(), rows.max(), columns.min(), columns.max()) == (100, 119, 180, 219)
    assert np.count_nonzero(again.floor) == 800
    assert dirty.places_of(again) == pytest.approx(np.array([(1.9, 1.1), (2.1, 1.1)]))
    assert not dirty.at_hand(coverage, FLOOR, BY_IT, NOW)


def test_each_of_two_patches_is_told_by_itself() -> None:
    dirt, coverage = swept_floor(TWO | patch(range(10, 11), range(9, 12)))
    dirty = DirtyFloor(dirt, CleaningConfig())
    one, other = dirty.at_hand(coverage, FLOOR, BY_IT, NOW)
    assert sorted((np.count_nonzero(one.floor), np.count_nonzero(other.floor))) == [800, 1200]
    assert not (one.floor & other.floor).any()
    # Only the one that is swept again is not left at the end.
    dirty.note_again(one)
    (left,) = dirty.left(coverage, FLOOR)
    assert (left.floor == other.floor).all()


def test_it_waits_until_the_patch_and_the_floor_around_it_are_swept() -> None:
    dirt, coverage = swept_floor(TWO)
    # The next swath, beside the dirty cells.
    coverage.cells[120:140, 160:240] &= np.uint8(255 ^ SWEPT)
    dirty = DirtyFloor(dirt, CleaningConfig())
    assert not dirty.at_hand(coverage, FLOOR, BY_IT, NOW)
    coverage.cells |= np.uint8(SWEPT)
    assert dirty.at_hand(coverage, FLOOR, BY_IT, NOW)


def test_what_is_swept_again_in_passing_is_not_at_the_end() -> None:
    dirt, coverage = swept_floor(SIX)
    dirty = DirtyFloor(dirt, CleaningConfig())
    (again,) = dirty.at_hand(coverage, FLOOR, BY_IT, NOW)
    dirty.note_again(again)
    assert not dirty.left(coverage, FLOOR)
    dirty.begin_pass()
    (left,) = dirty.left(coverage, FLOOR)
    assert (left.floor == again.floor).all()


def test_what_was_not_swept_again_in_passing_is_left_for_the_end() -> None:
    dirt, coverage = swept_floor(SIX)
    dirty = DirtyFloor(dirt, CleaningConfig())
    assert dirty.at_hand(coverage, FLOOR, BY_IT, NOW)
    (left,) = dirty.left(coverage, FLOOR)
    assert np.count_nonzero(left.floor) == 6 * 400
    assert not dirty.left(coverage, FLOOR)


@pytest.mark.parametrize(("cells", "is_told"), [(1, False), (2, True)])
def test_small_patches_are_not_told(cells: int, is_told: bool) -> None:
    dirt, coverage = swept_floor(patch(range(5, 6), range(9, 9 + cells)))
    dirty = DirtyFloor(dirt, CleaningConfig())
    assert bool(dirty.at_hand(coverage, FLOOR, BY_IT, NOW)) is is_told
    assert bool(dirty.left(coverage, FLOOR)) is is_told


def test_at_the_beginning_it_is_not_known_what_is_usual() -> None:
    dirt, coverage = swept_floor(TWO)
    assert dirt.seen_area == pytest.approx(16.0)
    config = CleaningConfig(usual_floor=17.0)
    assert not DirtyFloor(dirt, config).at_hand(coverage, FLOOR, BY_IT, NOW)


def test_near_clean_floor_it_is_looked_for_once_a_period() -> None:
    dirt, coverage = swept_floor(TWO)
    config = CleaningConfig()
    dirty = DirtyFloor(dirt, config)
    # At first it is to be measured how dirty floor usually is.
    assert dirty.may_be_at_hand(FAR, NOW)
    assert not dirty.at_hand(coverage, FLOOR, FAR, NOW)
    later = NOW + config.dirty_period
    assert not dirty.may_be_at_hand(FAR, later)
    # That was a look, so that the next one has time, even by the patch.
    assert not dirty.may_be_at_hand(BY_IT, later + 0.9 * config.dirty_period)
    assert dirty.may_be_at_hand(BY_IT, later + config.dirty_period)
    # Where it may be dirty it waits to be looked for.
    assert dirty.may_be_at_hand(BY_IT, later + config.dirty_period)


def test_what_was_told_is_not_looked_for_any_more() -> None:
    dirt, coverage = swept_floor(TWO)
    config = CleaningConfig()
    dirty = DirtyFloor(dirt, config)
    assert dirty.at_hand(coverage, FLOOR, BY_IT, NOW)
    assert not dirty.may_be_at_hand(BY_IT, NOW + config.dirty_period)


def test_what_is_usual_is_measured_again_and_when_the_clock_was_set_back() -> None:
    dirt, coverage = swept_floor(TWO)
    config = CleaningConfig()
    dirty = DirtyFloor(dirt, config)
    assert not dirty.at_hand(coverage, FLOOR, FAR, NOW)
    dirt.grains[:] = DIRTY
    assert not dirty.may_be_at_hand(FAR, NOW + 0.5 * config.dirty_period)
    assert dirty.may_be_at_hand(FAR, NOW - 10.0)
    # All is as dirty: none is dirtier than usual.
    assert not dirty.at_hand(coverage, FLOOR, FAR, NOW + config.usual_period)
    assert not dirty.may_be_at_hand(BY_IT, NOW + config.usual_period + config.dirty_period)
