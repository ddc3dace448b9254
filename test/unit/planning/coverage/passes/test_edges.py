"""Ways along walls, against the cells that they sweep, one by one."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from fixtures.references.straight_ways import (
    Mask,
    connected_to,
    crosses_between_centres_that_fit,
    length_of,
    runs_between_centres_that_fit,
    swept_cells,
)
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.passes.edges import cut, edges, rings, turning_of

CONFIG = CoverageConfig()

RADIUS = 4.0
STRETCH = 10.0
"""cells; as in the stage."""


@st.composite
def floors(draw: st.DrawFn) -> Mask:
    """A floor of up to 50 x 50 cells with boxes cut out, one connected part of it."""
    mask = np.zeros((draw(st.integers(12, 50)), draw(st.integers(12, 50))), np.bool_)
    mask[1:-1, 1:-1] = True
    for _ in range(draw(st.integers(0, 3))):
        row, column = draw(st.integers(0, 45)), draw(st.integers(0, 45))
        mask[row : row + draw(st.integers(1, 12)), column : column + draw(st.integers(1, 12))] = 0
    cells = np.argwhere(mask).tolist()
    assume(cells)
    part = np.zeros_like(mask)
    for cell in connected_to(mask, tuple(cells[0])):
        part[cell] = True
    return part


@given(floors())
@settings(max_examples=examples(40))
def test_rings_are_closed_run_over_cells_that_fit_and_keep_to_the_border(middles: Mask) -> None:
    padded = np.pad(middles, 1)
    border = [
        (x, y)
        for y, x in np.argwhere(middles).tolist()
        if not (padded[y, x + 1] and padded[y + 2, x + 1] and padded[y + 1, x])
        or not padded[y + 1, x + 2]
    ]
    lines = rings(middles)
    for line in lines:
        assert np.array_equal(line[0], line[-1])
        assert runs_between_centres_that_fit(middles, line)
    whole = shapely.union_all([shapely.LineString(line) for line in lines])
    away = shapely.distance(whole, shapely.points(np.array(border, np.float64)))
    assert away.max() <= math.sqrt(2.0) * 0.75 + 1e-9


@pytest.mark.parametrize("degrees", [5.0, 12.0, 17.0, 25.0])
def test_along_a_line_that_lies_aslant_a_ring_is_straight(degrees: float) -> None:
    row, column = np.mgrid[0:200, 0:300]
    aslant = row > 20.3 + math.tan(math.radians(degrees)) * column
    (plain,), (straight,) = rings(aslant), rings(aslant, is_aslant=True)
    assert runs_between_centres_that_fit(aslant, straight)
    away = shapely.distance(shapely.LineString(straight), shapely.points(plain))
    assert away.max() < 1.5
    assert turning_of(straight) < 10.0
    assert turning_of(straight) < turning_of(plain)


@given(floors(), st.integers(0, 2**32 - 1), st.sampled_from([15.0, 60.0]))
@settings(max_examples=examples(30))
def test_edges_lie_on_the_rings_and_sweep_all_that_is_worth_the_way(
    middles: Mask, seed: int, piece_length: float
) -> None:
    need = middles & (np.random.default_rng(seed).random(middles.shape) < 0.8)
    need[: len(need) // 3] = False
    ways = rings(middles)
    pieces = edges(ways, need, middles, RADIUS, piece_length, CONFIG)
    whole = shapely.union_all([shapely.LineString(line) for line in ways])
    for piece in pieces:
        assert len(piece) >= 2
        assert shapely.distance(whole, shapely.points(piece)).max() < 1e-6
        assert crosses_between_centres_that_fit(middles, piece, 1e-5)
        assert 0.0 < length_of(piece) <= 1.5 * piece_length + 2 * STRETCH
    left = need & ~swept_cells(need.shape, pieces, RADIUS)
    driven = shapely.union_all([shapely.LineString(piece) for piece in pieces])
    for ring in ways:
        for one, two in pairwise(cut(ring, STRETCH)):
            middle = shapely.Point(*((one + two) / 2))
            if pieces and driven.distance(middle) < 1e-6:
                continue
            # A stretch that is not driven would sweep hardly more floor than it is long.
            worth = left & swept_cells(need.shape, [np.array([one, two])], RADIUS)
            assert worth.sum() <= math.dist(one, two) + 1e-9


def test_where_nothing_is_needed_no_edge_is_driven() -> None:
    middles = np.ones((30, 30), np.bool_)
    assert edges(rings(middles), np.zeros_like(middles), middles, RADIUS, 50.0, CONFIG) == []


def test_over_a_short_stretch_without_new_floor_an_edge_goes_on() -> None:
    """Floor at both ends of a wall of 60 cells; four stretches between them are driven, not six."""
    line = np.array([[5.0, 5.0], [125.0, 5.0]])
    for gap, expected in ((30, 1), (70, 2)):
        need = np.zeros((12, 131), np.bool_)
        need[2:9, 5:36] = True
        need[2:9, 36 + gap : 36 + gap + 25] = True
        assert len(edges([line], need, np.ones_like(need), RADIUS, 500.0, CONFIG)) == expected


@given(
    st.lists(st.tuples(st.integers(-40, 40), st.integers(-40, 40)), min_size=2, max_size=8).filter(
        lambda points: all(one != two for one, two in pairwise(points))
    ),
    st.sampled_from([1.0, 3.5, 10.0]),
)
@settings(max_examples=examples(60))
def test_a_cut_line_is_the_same_with_points_no_farther_apart(
    points: list[tuple[int, int]], spacing: float
) -> None:
    line = np.array(points, np.float64)
    found = cut(line, spacing)
    legs = [math.dist(one, two) for one, two in pairwise(found.tolist())]
    assert max(legs) <= spacing + 1e-9
    assert sum(legs) == pytest.approx(length_of(line))
    at = 0
    for point in line:
        # Each point of the line is one of the cut line, in their order.
        at = next(n for n in range(at, len(found)) if math.dist(found[n], point) < 1e-9)
    assert at == len(found) - 1
    # No more points than it takes.
    least = sum(math.ceil(math.dist(one, two) / spacing - 1e-9) for one, two in pairwise(points))
    assert len(legs) == least
