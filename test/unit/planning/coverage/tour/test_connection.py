"""Pieces joined to one line, against Dijkstra over all cells and a look at every leg."""

from __future__ import annotations

import heapq
import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from fixtures.references.drawn_ways import one_part_of, without_boxes
from fixtures.references.straight_ways import (
    Mask,
    crosses_between_centres_that_fit,
    length_of,
    runs_between_centres_that_fit,
)
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.arrays import Floats
from roomba.planning.coverage.tour.connection import connected, tidy
from roomba.planning.coverage.tour.net import net_over

STRAIGHTENED = 0.05
"""cells; a leg may be so far off the points that it leaves out, a hair each."""


@st.composite
def floors(draw: st.DrawFn) -> Mask:
    """One part of a floor of boxes and single closed cells: wide places and ways of one cell."""
    fits = np.ones((draw(st.integers(5, 50)), draw(st.integers(5, 50))), np.bool_)
    without_boxes(draw, fits, 6, 45)
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    fits &= random.random(fits.shape) > draw(st.sampled_from([0.0, 0.02, 0.25]))
    return one_part_of(fits)


def length_over_cells(fits: Mask, start: Floats, goal: Floats) -> float:
    """The shortest way of steps to eight neighbours that cut no closed corner."""
    first, last = ((int(y), int(x)) for x, y in (start, goal))
    heap = [(0.0, first)]
    done = set()
    while heap:
        length, (row, column) = heapq.heappop(heap)
        if (row, column) == last:
            return length
        if (row, column) in done:
            continue
        done.add((row, column))
        for up in (-1, 0, 1):
            for right in (-1, 0, 1):
                cells = [(row + up, column + right), (row + up, column), (row, column + right)]
                if all(
                    0 <= y < fits.shape[0] and 0 <= x < fits.shape[1] and fits[y, x]
                    for y, x in cells
                ):
                    heapq.heappush(heap, (length + math.hypot(up, right), cells[0]))
    return math.inf


@given(floors(), st.integers(0, 2**32 - 1), st.integers(0, 4), st.booleans())
@settings(max_examples=examples(40))
def test_the_line_drives_all_pieces_in_order_and_only_over_floor(
    fits: Mask, seed: int, count: int, has_end: bool
) -> None:
    random = np.random.default_rng(seed)
    cells = np.argwhere(fits)[:, ::-1].astype(float)
    stops = cells[random.integers(len(cells), size=2 * count + 2)]
    start, end = stops[0], stops[-1] if has_end else None
    pieces = []
    for one, other in zip(stops[1:-1:2], stops[2:-1:2], strict=True):
        straight = np.array([one, other])
        fitting = runs_between_centres_that_fit(fits, straight)
        pieces.append(straight if fitting else one[None])
    line = connected(net_over(fits), pieces, start, end)
    assert np.array_equal(line[0], start)
    last = end if end is not None else pieces[-1][-1] if pieces else start
    assert math.dist(line[-1].tolist(), last.tolist()) <= 0.01
    assert crosses_between_centres_that_fit(fits, line, STRAIGHTENED)
    assert all(math.dist(one, two) >= 0.01 for one, two in pairwise(line.tolist()))
    # All ends of the pieces are passed, one after another.
    way = shapely.LineString(np.repeat(line, 2 if len(line) == 1 else 1, axis=0))
    ends = [point for piece in pieces for point in piece]
    assert all(way.distance(shapely.Point(point)) <= STRAIGHTENED for point in ends)
    joints = [start[None], *pieces] if end is None else [start[None], *pieces, end[None]]
    shortest = sum(map(length_of, pieces))
    straight_ways = shortest
    for one, two in pairwise(joints):
        shortest += length_over_cells(fits, one[-1], two[0])
        straight_ways += math.dist(one[-1].tolist(), two[0].tolist())
    # The net is coarse, and steps over cells are longer than straight ways.
    assert straight_ways - 0.1 * len(joints) <= length_of(line) <= 1.25 * shortest + 1.0


@pytest.mark.parametrize("is_reversed", [False, True])
def test_where_the_net_is_too_coarse_the_way_is_found_over_cells(is_reversed: bool) -> None:
    """A winding passage of one cell between two wide places."""
    fits = np.zeros((40, 60), np.bool_)
    fits[:, :16] = fits[:, 44:] = True
    passage = [(16, 5), (25, 5), (25, 30), (30, 30), (30, 9), (44, 9)]
    for (x, y), (to_x, to_y) in pairwise(passage):
        fits[min(y, to_y) : max(y, to_y) + 1, min(x, to_x) : max(x, to_x) + 1] = True
    ends = np.array([[4.0, 20.0], [55.0, 20.0]])[:: -1 if is_reversed else 1]
    line = connected(net_over(fits), [], ends[0], ends[1])
    assert crosses_between_centres_that_fit(fits, line, STRAIGHTENED)
    assert np.array_equal(line[[0, -1]], ends)
    assert length_of(line) <= length_over_cells(fits, ends[0], ends[1]) + 1e-6


@given(floors(), st.integers(0, 2**32 - 1), st.sampled_from([0.3, 1.0, 4.0]))
@settings(max_examples=examples(40))
def test_a_tidy_line_has_the_same_ends_fits_and_is_no_longer(
    fits: Mask, seed: int, step: float
) -> None:
    """Lines of steps of all directions, as long as they fit; some steps are not worth driving."""
    random = np.random.default_rng(seed)
    cells = np.argwhere(fits)[:, ::-1].astype(float)
    points = [cells[random.integers(len(cells))]]
    for _ in range(40):
        to = points[-1] + random.normal(0.0, step, 2)
        if runs_between_centres_that_fit(fits, np.array([points[-1], to])):
            points.append(to)
    line = np.array(points)
    found = tidy(fits, line)
    assert np.array_equal(found[0], line[0])
    assert math.dist(found[-1].tolist(), line[-1].tolist()) <= 0.01
    assert length_of(found) <= length_of(line) + 1e-9
    assert crosses_between_centres_that_fit(fits, found, STRAIGHTENED)
    # A leg is short only where the floor bends there: without it the next one would not fit.
    for one, two, three in zip(found, found[1:], found[2:], strict=False):
        if math.dist(one.tolist(), two.tolist()) < 0.74:
            assert not runs_between_centres_that_fit(fits, np.array([one, three]))


def test_points_that_do_not_bend_a_line_are_left_out_and_turning_points_stay() -> None:
    fits = np.ones((10, 40), np.bool_)
    line = np.array([[1.0, 2.0], [5.0, 2.0], [9.0, 2.01], [30.0, 2.0], [20.0, 2.0], [20.0, 8.0]])
    assert tidy(fits, line).tolist() == line[[0, 3, 4, 5]].tolist()
