"""Where it was dirty: what was counted now, and what is learned over runs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.grid import FREE, GridFrame, OccupancyMap
from roomba.perception.swept.dirt_map import CELL, DirtMap, dirty_from
from roomba.planning.coverage.floor.floor import fine_frame

COARSE = GridFrame(0.05, -1.0, 2.0, 40, 61)
MAP = OccupancyMap(COARSE, np.full(COARSE.shape, FREE, np.int8))
FINE = GridFrame(0.01, -1.0, 2.0, 200, 305)
HERE = (-0.5, 2.5)
"""m; in cell (2, 2)."""


def run_over(dirt: DirtMap, grains: float) -> None:
    """Drive through the cell at HERE, where so many grains are counted, and through another."""
    for _ in range(4):
        dirt.note(*HERE, grains / 4.0, CELL / 4.0)
    dirt.note(0.5, 3.5, 0.0, CELL)


def fine(x: float, y: float) -> NDArray[np.bool_]:
    """The cell of the dirt map around a point, over the fine grid."""
    mask = np.zeros(FINE.shape, np.bool_)
    row, column = int((y - 2.0) / CELL), int((x + 1.0) / CELL)
    mask[20 * row : 20 * row + 20, 20 * column : 20 * column + 20] = True
    return mask


def test_it_lies_over_all_of_the_map() -> None:
    dirt = DirtMap(MAP)
    assert dirt.frame.shape == (10, 16)
    assert dirt.frame.extent[0] == COARSE.extent[0]
    assert dirt.frame.extent[2] == COARSE.extent[2]
    assert dirt.frame.extent[1] >= COARSE.extent[1]
    assert np.isnan(dirt.known()).all()


def test_what_is_counted_goes_to_the_cell_where_it_is() -> None:
    dirt = DirtMap(MAP)
    dirt.note(*HERE, 30.0, 0.1)
    dirt.note(*HERE, 10.0, 0.05)
    assert dirt.grains[2, 2] == 40.0
    assert dirt.way[2, 2] == pytest.approx(0.15)
    assert dirt.grains.sum() == 40.0
    dirt.note(-1.0 + 1e-6, 2.0 + 1e-6, 1.0, 0.1)
    assert dirt.grains[0, 0] == 1.0
    for x, y in ((-1.01, 2.5), (2.5, 2.5), (-0.5, 1.99), (-0.5, 4.01)):
        dirt.note(x, y, 5.0, 0.1)
    assert dirt.grains.sum() == 41.0


def test_the_last_bits_do_not_decide_which_cell_counts_on_a_way_along_its_side() -> None:
    dirt = DirtMap(MAP)
    side = MAP.frame.origin_x + 2 * CELL
    for x in (side - 1e-12, side, side + 1e-12):
        dirt.note(x, HERE[1], 1.0, 0.1)
    assert dirt.grains.max() == dirt.grains.sum() == 3.0


def test_a_part_of_another_grid_is_what_lies_below_the_cells() -> None:
    dirt, fine = DirtMap(MAP), fine_frame(COARSE, 0.01)
    cells = np.zeros(dirt.frame.shape, np.bool_)
    cells[2, 3] = cells[4, 5] = True
    window = dirt.window_of(cells, fine)
    whole = dirt.over(cells, fine)
    rows, columns = np.nonzero(whole)
    assert (window[0].start, window[0].stop) == (rows.min(), rows.max() + 1)
    assert (window[1].start, window[1].stop) == (columns.min(), columns.max() + 1)
    assert (dirt.over(cells, fine, window) == whole[window]).all()


def test_density_is_by_the_floor_that_the_tool_passed() -> None:
    dirt = DirtMap(MAP)
    run_over(dirt, 80.0)
    known = dirt.known()
    assert known[2, 2] == pytest.approx(80.0 / (CELL * CELL))
    assert known[7, 7] == 0.0
    assert np.isnan(known[0, 0])
    # Just touched it tells nothing.
    dirt.note(1.0, 2.1, 9.0, 0.4 * CELL)
    assert np.isnan(dirt.known()[0, 10])


def test_runs_are_learned_from_the_newest_the_most() -> None:
    dirt = DirtMap(MAP)
    run_over(dirt, 80.0)
    dirt.end_run()
    assert dirt.grains.sum() == dirt.way.sum() == 0.0
    first = dirt.learned[2, 2]
    assert first == pytest.approx(80.0 / CELL**2)
    run_over(dirt, 0.0)
    dirt.end_run()
    assert dirt.learned[2, 2] == pytest.approx(0.6 * first)
    assert dirt.known()[2, 2] == dirt.learned[2, 2]
    # Where it was not this time it is as it was.
    dirt.end_run()
    assert dirt.learned[2, 2] == pytest.approx(0.6 * first)
    assert np.isnan(dirt.learned[0, 0])


def test_a_room_is_as_dirty_as_its_floor_in_the_mean() -> None:
    dirt = DirtMap(MAP)
    run_over(dirt, 80.0)
    assert dirt.density(fine(*HERE), FINE) == 0.0
    dirt.end_run()
    assert dirt.density(fine(*HERE), FINE) == pytest.approx(80.0 / CELL**2)
    both = fine(*HERE) | fine(0.5, 3.5)
    assert dirt.density(both, FINE) == pytest.approx(40.0 / CELL**2)
    assert dirt.density(np.zeros(FINE.shape, np.bool_), FINE) == 0.0


def test_what_is_much_dirtier_than_usual_now_is_dirty() -> None:
    dirt = DirtMap(MAP)
    assert not dirt.over(dirt.dirty_cells(6.0, 500.0), FINE).any()
    for column in range(10):
        dirt.note(-0.9 + column * CELL, 3.1, 10.0, CELL)
    usual = 10.0 / CELL**2
    run_over(dirt, 7.0 * usual * CELL**2)
    dirty = dirt.over(dirt.dirty_cells(6.0, 500.0), FINE)
    assert (dirty == fine(*HERE)).all()
    assert not dirt.dirty_cells(8.0, 500.0).any()


def test_little_is_never_dirty() -> None:
    dirt = DirtMap(MAP)
    for column in range(10):
        dirt.note(-0.9 + column * CELL, 3.1, 0.0, CELL)
    run_over(dirt, 10.0)
    assert 10.0 / CELL**2 < 500.0
    assert not dirt.over(dirt.dirty_cells(6.0, 500.0), FINE).any()


def test_dirty_is_many_times_the_usual_of_what_is_known() -> None:
    density = np.array([[np.nan, 100.0, 300.0], [200.0, np.nan, np.nan]], np.float32)
    assert dirty_from(density, 6.0, 500.0) == 1200.0
    assert dirty_from(density, 1.0, 500.0) == 500.0
    assert dirty_from(np.full((2, 2), np.nan, np.float32), 6.0, 500.0) == 500.0
