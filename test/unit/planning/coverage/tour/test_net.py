"""The coarse net of cells, against trying all cells of each block and all its neighbours."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.references.straight_ways import Mask, runs_between_centres_that_fit
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.planning.coverage.tour.net import (
    STEP_X,
    STEP_Y,
    UNIT,
    blocks_near,
    leg_to,
    net_over,
)

BLOCK = 8


@st.composite
def floors(draw: st.DrawFn) -> Mask:
    """Up to 40 x 40 cells with boxes, and here and there a cell, where the middle does not fit."""
    fits = np.ones((draw(st.integers(3, 40)), draw(st.integers(3, 40))), np.bool_)
    for _ in range(draw(st.integers(0, 5))):
        row, column = draw(st.integers(0, 39)), draw(st.integers(0, 39))
        fits[row : row + draw(st.integers(1, 12)), column : column + draw(st.integers(1, 12))] = 0
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    fits &= random.random(fits.shape) > draw(st.sampled_from([0.0, 0.03, 0.6]))
    return fits


@given(floors())
@settings(max_examples=examples(40))
def test_the_knot_of_a_block_is_its_cell_nearest_to_the_middle(fits: Mask) -> None:
    knots = net_over(fits).knots
    for row, column in np.ndindex(*knots.shape[:2]):
        middle = BLOCK * row + BLOCK // 2, BLOCK * column + BLOCK // 2
        cells = [
            (y, x)
            for y in range(BLOCK * row, min(BLOCK * (row + 1), fits.shape[0]))
            for x in range(BLOCK * column, min(BLOCK * (column + 1), fits.shape[1]))
            if fits[y, x]
        ]
        x, y = knots[row, column].tolist()
        if not cells:
            assert x == -1
            continue
        assert (y, x) in cells
        assert math.dist((y, x), middle) == min(math.dist(cell, middle) for cell in cells)


@given(floors())
@settings(max_examples=examples(40))
def test_knots_of_neighbouring_blocks_are_linked_where_the_straight_way_fits(fits: Mask) -> None:
    net = net_over(fits)
    rows, columns = net.links.shape[:2]
    for row, column in np.ndindex(rows, columns):
        for step in range(8):
            to = row + STEP_Y[step], column + STEP_X[step]
            one = net.knots[row, column]
            inside = 0 <= to[0] < rows and 0 <= to[1] < columns
            other = net.knots[to] if inside else one
            expected = 0
            if inside and one[0] >= 0 and other[0] >= 0:
                way = np.array([one, other], np.float64)
                if runs_between_centres_that_fit(fits, way):
                    expected = max(1, math.floor(math.dist(*way.tolist()) * UNIT + 0.5))
            assert net.links[row, column, step] == expected


@given(floors(), st.integers(0, 2**32 - 1))
@settings(max_examples=examples(40))
def test_near_blocks_are_those_around_whose_knots_are_seen(fits: Mask, seed: int) -> None:
    net = net_over(fits)
    rows, columns = net.links.shape[:2]
    random = np.random.default_rng(seed)
    found = np.empty(9, np.int32)
    for _ in range(5):
        x, y = (random.integers(0, [4 * size - 3 for size in fits.shape[::-1]]) / 4).tolist()
        size = blocks_near(net, x, y, found)
        own = int(y + 0.5) // BLOCK, int(x + 0.5) // BLOCK
        expected = set()
        for row, column in np.ndindex(rows, columns):
            knot = net.knots[row, column].tolist()
            if max(abs(row - own[0]), abs(column - own[1])) > 1 or knot[0] < 0:
                continue
            if runs_between_centres_that_fit(fits, np.array([(x, y), knot], np.float64)):
                expected.add(row * columns + column)
                leg = leg_to(net, row * columns + column, x, y)
                assert leg == pytest.approx(math.dist((x, y), knot))
        assert set(found[:size].tolist()) == expected
