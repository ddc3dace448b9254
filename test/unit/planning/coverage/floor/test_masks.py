"""Masks grown, filled and crossed, against plain loops over all cells."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
import shapely
from fixtures.references.straight_ways import Mask, connected_to, runs_between_centres_that_fit
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from roomba.planning.coverage.floor.masks import (
    filled_from,
    grown,
    half_widths,
    transposed,
    way_fits,
)

SHAPES = st.tuples(st.integers(1, 12), st.integers(1, 12))
MASKS = arrays(np.bool_, SHAPES)
RADII = st.integers(1, 60).map(lambda number: number / 10 + 0.003)


def distance(cell: tuple[int, ...], other: tuple[int, ...], to_square: bool) -> float:
    """From a cell's centre to the other's centre or square."""
    edge = 0.5 if to_square else 0.0
    return math.hypot(*(max(abs(a - b) - edge, 0.0) for a, b in zip(cell, other, strict=True)))


@given(RADII, st.booleans())
@settings(max_examples=examples(50))
def test_half_widths_are_those_of_a_disc(radius: float, to_squares: bool) -> None:
    widths = half_widths(radius, to_squares)
    reach = math.ceil(radius) + 2
    for row in range(reach):
        away = [distance((0, 0), (row, column), to_squares) for column in range(reach)]
        covered = [column for column in range(reach) if away[column] <= radius]
        expected = max(covered, default=-1)
        assert (widths[row] if row < len(widths) else -1) == expected


@given(MASKS, RADII, st.booleans())
@settings(max_examples=examples(50))
def test_a_mask_grows_by_a_disc_around_each_cell(
    mask: Mask, radius: float, to_squares: bool
) -> None:
    found = grown(mask, half_widths(radius, to_squares))
    true_cells = [(row, column) for row, column in np.argwhere(mask).tolist()]
    for cell in np.ndindex(mask.shape):
        expected = any(distance(cell, other, to_squares) <= radius for other in true_cells)
        assert found[cell] == expected


@given(st.integers(1, 70), st.integers(1, 70), st.integers(0, 2**32 - 1))
@settings(max_examples=examples(15))
def test_rows_become_columns(rows: int, columns: int, seed: int) -> None:
    mask = np.random.default_rng(seed).random((rows, columns)) < 0.5
    turned = transposed(mask)
    assert turned.shape == mask.shape[::-1]
    assert all(turned[column, row] == mask[row, column] for row, column in np.ndindex(mask.shape))


@given(MASKS, st.data())
@settings(max_examples=examples(100))
def test_filling_finds_what_is_connected_over_sides(mask: Mask, data: st.DataObject) -> None:
    row = data.draw(st.integers(0, mask.shape[0] - 1))
    column = data.draw(st.integers(0, mask.shape[1] - 1))
    found = {(row, column) for row, column in np.argwhere(filled_from(mask, row, column)).tolist()}
    assert found == (connected_to(mask, (row, column)) if mask[row, column] else set())


def test_filling_wide_combs_outgrows_its_stack() -> None:
    comb = np.ones((3, 5000), np.bool_)
    comb[::2, ::2] = False
    assert np.array_equal(filled_from(comb, 1, 77), comb)


PLACES = st.tuples(st.integers(-4, 40), st.integers(-4, 40)).map(lambda at: (at[0] / 4, at[1] / 4))
"""Often on a row or column of centres, and exact in binary."""
FLOORS = arrays(
    np.bool_,
    SHAPES,
    elements=st.integers(0, 9).map(lambda number: number > 0),
    fill=st.just(True),
)


@given(FLOORS, PLACES, PLACES)
@settings(max_examples=examples(150))
def test_a_straight_way_fits_when_all_centres_beside_it_do(
    fits: Mask, start: tuple[float, float], end: tuple[float, float]
) -> None:
    expected = runs_between_centres_that_fit(fits, np.array([start, end]))
    assert way_fits(fits, *start, *end) == expected
    assert way_fits(fits, *end, *start) == expected


CELLS = st.tuples(st.integers(0, 11), st.integers(0, 11))


@given(
    st.lists(CELLS, min_size=1, max_size=3),
    st.lists(PLACES, min_size=5, max_size=5),
    st.integers(8, 32).map(lambda tenths: tenths / 10),
)
@settings(max_examples=examples(60))
def test_a_way_that_fits_comes_hardly_nearer_to_what_is_solid_than_the_centres_do(
    solid: list[tuple[int, int]], places: list[tuple[float, float]], reach: float
) -> None:
    """The centres keep ``reach``, cells, from solid squares; ways may keep a sagitta less."""
    things = shapely.union_all([shapely.box(x - 0.5, y - 0.5, x + 0.5, y + 0.5) for x, y in solid])
    x, y = np.meshgrid(np.arange(12.0), np.arange(12.0))
    fits = shapely.distance(things, shapely.points(x, y)) >= reach
    # Of a diagonal step, the longest between two centres that a way passes.
    sagitta = reach - math.sqrt(reach * reach - 0.5)
    for start, end in combinations(places, 2):
        if way_fits(fits, *start, *end):
            way = shapely.LineString([start, end])
            assert things.distance(way) >= reach - sagitta - 1e-5


@pytest.mark.parametrize("place", [(-0.5, 1.0), (1.0, 3.1), (4.0, 1.0)])
def test_no_way_leads_off_the_grid(place: tuple[float, float]) -> None:
    fits = np.ones((4, 4), np.bool_)
    assert way_fits(fits, 1.0, 1.0, 2.0, 2.5)
    assert not way_fits(fits, 1.0, 1.0, *place)
