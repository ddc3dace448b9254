"""The dust bin: full by its level, or as no grain comes in any more."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.configuration.mission import BinConfig
from roomba.mission.phases.dust_bin import DustBin

CONFIG = BinConfig()
CAPACITY = 50.0
CELL = 1e-4
"""m2"""
SILENT_CELLS = round(CONFIG.silent / CELL)


def swept(dust_bin: DustBin, way: float, grains: float, cells: int, *, start: float = 0.0) -> None:
    """Let it sweep straight ahead along x, 1 cm a tick, so many cells in all."""
    ticks = round(way / 0.01)
    for tick in range(ticks):
        dust_bin.note(start + 0.01 * tick, 0.0, grains, 0.01, cells // ticks)


def dusty() -> float:
    return 10_000.0


def filled() -> DustBin:
    """One that some grains came into."""
    dust_bin = DustBin(CONFIG, CAPACITY)
    swept(dust_bin, 1.0, 100.0, 2000)
    return dust_bin


def test_it_is_full_by_its_level_before_it_takes_nothing() -> None:
    dust_bin = DustBin(CONFIG, CAPACITY)
    assert not dust_bin.look(0.97 * CAPACITY, CELL, dusty)
    assert dust_bin.look(0.98 * CAPACITY, CELL, dusty)
    assert dust_bin.is_full
    # It has become so once.
    assert not dust_bin.look(0.99 * CAPACITY, CELL, dusty)


@pytest.mark.parametrize(
    ("in_bin", "is_full"),
    [(0.0, True), (0.3 * CAPACITY, False), (0.79 * CAPACITY, False), (0.81 * CAPACITY, True)],
)
def test_silence_counts_where_the_level_says_nothing_or_almost_full(
    in_bin: float, is_full: bool
) -> None:
    dust_bin = filled()
    swept(dust_bin, 10.0, 0.2, SILENT_CELLS - 1000)
    assert not dust_bin.look(in_bin, CELL, dusty)
    swept(dust_bin, 1.0, 0.2, 1000)
    assert dust_bin.look(in_bin, CELL, dusty) is is_full


def test_a_grain_ends_the_silence() -> None:
    dust_bin = filled()
    swept(dust_bin, 10.0, 0.0, SILENT_CELLS - 1000)
    swept(dust_bin, 0.01, 30.0, 1)
    swept(dust_bin, 1.0, 0.0, 2000)
    assert not dust_bin.look(0.0, CELL, dusty)


def test_silence_says_nothing_where_floor_is_mostly_clean() -> None:
    dust_bin = filled()
    swept(dust_bin, 10.0, 0.0, 2 * SILENT_CELLS)
    assert not dust_bin.look(0.9 * CAPACITY, CELL, lambda: 100.0)
    assert dust_bin.look(0.9 * CAPACITY, CELL, dusty)


def test_a_robot_that_never_counted_a_grain_has_a_dead_sensor_and_no_full_bin() -> None:
    dust_bin = DustBin(CONFIG, CAPACITY)
    swept(dust_bin, 10.0, 0.0, 2 * SILENT_CELLS)
    assert not dust_bin.look(0.0, CELL, dusty)


def test_what_was_swept_since_the_last_grain_was_swept_in_vain() -> None:
    dust_bin = filled()
    assert dust_bin.swept_in_vain().shape == (0, 2)
    swept(dust_bin, 3.0, 0.0, 6000, start=1.0)
    way = dust_bin.swept_in_vain()
    length = float(np.hypot(*np.diff(way, axis=0).T).sum())
    # And a little more: the sensor's rate fades away.
    assert 3.0 <= length <= 3.7
    assert tuple(way[0]) == pytest.approx((3.99, 0.0))


def test_ticks_that_passed_in_a_burst_are_part_of_the_way() -> None:
    dust_bin = filled()
    dust_bin.rows[0]["silent_way"] = 2.0
    dust_bin.passed(np.column_stack((np.linspace(1.0, 3.0, 201), np.zeros(201))))
    way = dust_bin.swept_in_vain()
    assert way[:, 0].min() < 1.0
    dust_bin.forget_places()
    assert dust_bin.swept_in_vain().shape == (0, 2)


def test_emptied_it_begins_anew() -> None:
    dust_bin = filled()
    dust_bin.look(CAPACITY, CELL, dusty)
    # A level sensor that reads a little less than before has not been emptied.
    dust_bin.look(0.7 * CAPACITY, CELL, dusty)
    assert dust_bin.is_full
    dust_bin.look(0.1 * CAPACITY, CELL, dusty)
    assert not dust_bin.is_full
    assert dust_bin.look(CAPACITY, CELL, dusty)
    dust_bin.emptied()
    assert not dust_bin.is_full
    assert not dust_bin.heeds_silence(0.0)
