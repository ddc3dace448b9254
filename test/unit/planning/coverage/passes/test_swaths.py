"""Parallel ways over floor, against sweeping it cell by cell and trying all sets of rows."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest
from fixtures.homes.turned_rooms import turned_room
from fixtures.references.straight_ways import (
    Mask,
    connected_to,
    length_of,
    parts_of,
    runs_between_centres_that_fit,
    shrunk,
    swept_cells,
)
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.floor.masks import grown, half_widths
from roomba.planning.coverage.passes.directions import main_directions
from roomba.planning.coverage.passes.swaths import swaths

CONFIG = CoverageConfig()
SPECK, NEW_SWATH, GAP = CONFIG.speck, CONFIG.swath_cost, CONFIG.swath_gap


@st.composite
def floors(draw: st.DrawFn) -> Mask:
    """Where the middle may be: a room of up to 40 x 40 cells with boxes in it, in one part."""
    mask = np.ones((draw(st.integers(8, 40)), draw(st.integers(8, 40))), np.bool_)
    for _ in range(draw(st.integers(0, 4))):
        row, column = draw(st.integers(0, 35)), draw(st.integers(0, 35))
        mask[row : row + draw(st.integers(1, 10)), column : column + draw(st.integers(1, 10))] = 0
    cells = np.argwhere(mask).tolist()
    assume(cells)
    part = np.zeros_like(mask)
    for cell in connected_to(mask, tuple(cells[len(cells) // 2])):
        part[cell] = True
    return part


@given(floors(), st.sampled_from([2.0, 3.5]), st.integers(0, 2**32 - 1))
@settings(max_examples=examples(40))
def test_all_but_specks_is_swept_without_leaving_the_floor(
    middles: Mask, radius: float, seed: int
) -> None:
    left = shrunk(middles, radius)
    random = np.random.default_rng(seed)
    for _ in range(int(random.integers(0, 3))):
        row, column = random.integers(0, 35, 2).tolist()
        left[row : row + 6, column : column + 9] = False
    lines = swaths(left, middles, radius, CONFIG)
    for line in lines:
        (x, y), (to_x, to_y) = line.astype(int).tolist()
        assert np.array_equal(line, line.astype(int))
        assert x == to_x or y == to_y
        assert middles[min(y, to_y) : max(y, to_y) + 1, min(x, to_x) : max(x, to_x) + 1].all()
    unswept = left & ~swept_cells(left.shape, lines, radius)
    for part in parts_of(left):
        if len(part) >= SPECK:
            assert not any(unswept[cell] for cell in part)
    if all(len(part) < SPECK for part in parts_of(left)):
        assert lines == []


def cost_of_row(left: Mask, middles: Mask, row: int, radius: int) -> float:
    """Cells of way along a row past all columns with something to sweep, and for new swaths."""
    wanted = left[max(row - radius, 0) : row + radius + 1].any(axis=0) & middles[row]
    columns = np.flatnonzero(wanted).tolist()
    cost = 0.0
    for at, column in enumerate(columns):
        before = columns[at - 1] if at else None
        if before is None or column - before > GAP or not middles[row, before:column].all():
            cost += NEW_SWATH
        else:
            cost += column - before
    return cost


def least_cost(left: Mask, middles: Mask, radius: int) -> float:
    """Of all sets of rows near enough to each other that reach the first and the last of them."""
    needed = np.flatnonzero(left.any(axis=1)).tolist()
    rows = range(len(left))
    costs = [cost_of_row(left, middles, row, radius) for row in rows]
    best = np.inf
    for count in range(1, 6):
        for chosen in combinations(rows, count):
            is_dense = all(two - one <= 2 * radius for one, two in pairwise(chosen))
            if is_dense and chosen[0] <= needed[0] + radius and chosen[-1] >= needed[-1] - radius:
                best = min(best, sum(costs[row] for row in chosen))
    return float(best)


@given(
    st.integers(5, 15),
    st.integers(5, 15),
    st.lists(st.tuples(*[st.integers(0, 14)] * 2, *[st.integers(1, 9)] * 2), max_size=4),
)
@settings(max_examples=examples(40))
def test_no_set_of_rows_or_columns_sweeps_a_region_with_less_way(
    height: int, width: int, boxes: list[tuple[int, int, int, int]]
) -> None:
    radius = 2
    middles = np.ones((height, width), np.bool_)
    left = middles.copy()
    for row, column, high, wide in boxes:
        left[row : row + high, column : column + wide] = False
    parts = parts_of(left)
    assume(len(parts) == 1 and len(parts[0]) >= SPECK)
    # A region is told by its bounds: rows beyond them are not driven.
    rows, columns = (np.flatnonzero(left.any(axis=axis)) for axis in (1, 0))
    window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    left, middles = left[window], middles[window]
    lines = swaths(left, middles, float(radius), CONFIG)
    cost = sum(length_of(line) + NEW_SWATH for line in lines)
    expected = min(least_cost(left, middles, radius), least_cost(left.T, middles.T, radius))
    assert cost == pytest.approx(expected)


def test_over_a_narrow_gap_of_swept_floor_a_swath_goes_on_and_around_a_wide_one_it_does_not() -> (
    None
):
    middles = np.ones((9, 120), np.bool_)
    for gap, expected in ((29, 1), (35, 2)):
        left = np.zeros_like(middles)
        left[2:7, 2:40] = True
        left[2:7, 40 + gap : 40 + gap + 40] = True
        # The thin bridge makes it one region, without a cell where the rows run.
        left[2, 40 : 40 + gap] = True
        lines = swaths(left, middles, 1.0, CONFIG)
        assert len({float(line[0, 1]) for line in lines}) >= 2
        on_last = [line for line in lines if line[0, 1] == max(line[0, 1] for line in lines)]
        assert len(on_last) == expected


def test_rows_are_chosen_for_what_they_cost_and_not_only_as_far_apart_as_can_be() -> None:
    """Four wide rows: each needs one long swath, and evenly spaced ones would pass one twice."""
    left = np.zeros((40, 300), np.bool_)
    left[:, :9] = True
    left[[6, 15, 24, 33]] = True
    lines = swaths(left, np.ones_like(left), 2.0, CONFIG)
    assert sum(length_of(line) > 100.0 for line in lines) == 4


@pytest.mark.parametrize(("columns", "expected"), [(19, 0), (20, 1)])
def test_a_patch_is_swept_from_twenty_cells_on(columns: int, expected: int) -> None:
    left = np.zeros((9, 40), np.bool_)
    left[4, 5 : 5 + columns] = True
    assert len(swaths(left, np.ones_like(left), 3.0, CONFIG)) == expected


@pytest.mark.parametrize(
    ("changed", "expected"), [({"speck": 20}, 0), ({"speck": 19}, 1), ({"speck": 0}, 1)]
)
def test_the_least_patch_is_configured(changed: dict[str, int], expected: int) -> None:
    left = np.zeros((9, 40), np.bool_)
    left[4, 5:24] = True
    config = CONFIG.model_copy(update=changed)
    assert len(swaths(left, np.ones_like(left), 3.0, config)) == expected


@pytest.mark.parametrize(("cost", "expected"), [(30.0, 1), (0.0, 4)])
def test_what_another_swath_costs_is_configured(cost: float, expected: int) -> None:
    """Without a price for turning it would sweep a strip across, as that is less way."""
    left = np.zeros((9, 40), np.bool_)
    left[4, 5:29] = True
    config = CONFIG.model_copy(update={"swath_cost": cost})
    assert len(swaths(left, np.ones_like(left), 3.0, config)) == expected


@given(st.floats(5.0, 85.0), st.integers(0, 2**32 - 1))
@settings(max_examples=examples(6))
def test_beside_slanted_walls_swaths_keep_to_the_floor_and_sweep_it(
    degrees: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    thing = (*random.uniform(-1.5, 0.8, 2), *random.uniform(0.3, 0.8, 2))
    map = turned_room(3.6, 2.4, degrees, thing)
    solid = np.repeat(np.repeat(map.solid, 5, axis=0), 5, axis=1)
    middles = ~grown(solid, half_widths(16.5, to_squares=True))
    left = ~grown(~middles, half_widths(11.0))
    lines = swaths(left, middles, 10.0, CONFIG)
    (direction,) = main_directions(middles)
    for line in lines:
        (along, aside) = line[1] - line[0]
        off = np.arctan2(aside, along) - direction
        assert runs_between_centres_that_fit(middles, line)
        assert along * aside == 0.0 or abs(np.sin(2.0 * off)) < 1e-6
    # What is at the rim of turned cells may be half a cell off them.
    assert np.count_nonzero(left & ~swept_cells(left.shape, lines, 10.0)) < SPECK


def test_swaths_along_slanted_walls_are_fewer_than_along_the_axes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    map = turned_room(5.0, 3.5, 20.0)
    solid = np.repeat(np.repeat(map.solid, 5, axis=0), 5, axis=1)
    middles = ~grown(solid, half_widths(16.5, to_squares=True))
    left = ~grown(~middles, half_widths(11.0))
    along_walls = swaths(left, middles, 10.0, CONFIG)
    monkeypatch.setattr("roomba.planning.coverage.passes.swaths.main_directions", lambda _: [])
    along_axes = swaths(left, middles, 10.0, CONFIG)
    assert len(along_walls) < 0.9 * len(along_axes)
    cost, axes_cost = (
        sum(length_of(line) + NEW_SWATH for line in lines) for lines in (along_walls, along_axes)
    )
    assert cost < 0.98 * axes_cost
