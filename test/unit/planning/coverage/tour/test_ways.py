"""Shortest ways from place to place, against Dijkstra over the net and over all cells."""

from __future__ import annotations

import heapq
import math

import numpy as np
from fixtures.references.straight_ways import (
    Mask,
    connected_to,
    crosses_between_centres_that_fit,
    length_of,
    runs_between_centres_that_fit,
)
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from roomba.arrays import Polyline
from roomba.geometry import Point
from roomba.planning.coverage.tour.net import STEP_X, STEP_Y, Net, net_over
from roomba.planning.coverage.tour.ways import taut, way_between


@st.composite
def floors(draw: st.DrawFn) -> tuple[Mask, list[Point]]:
    """A floor with boxes, and two of its cells, (x, y), which may lie in different parts."""
    fits = np.ones((draw(st.integers(9, 60)), draw(st.integers(9, 60))), np.bool_)
    for _ in range(draw(st.integers(0, 6))):
        row, column = draw(st.integers(0, 55)), draw(st.integers(0, 55))
        fits[row : row + draw(st.integers(1, 25)), column : column + draw(st.integers(1, 25))] = 0
    cells = np.argwhere(fits).tolist()
    assume(cells)
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    ends = [cells[random.integers(len(cells))] for _ in range(2)]
    return fits, [(float(x), float(y)) for y, x in ends]


def length_over_net(net: Net, start: Point, end: Point) -> float:
    """The least length from knot to knot, and to the ends from those of blocks around them."""
    rows, columns = net.links.shape[:2]

    def legs(point: Point) -> dict[tuple[int, int], float]:
        own = int(point[1] + 0.5) // 8, int(point[0] + 0.5) // 8
        found = {}
        for row, column in np.ndindex(rows, columns):
            knot = net.knots[row, column].tolist()
            near = max(abs(row - own[0]), abs(column - own[1])) <= 1 and knot[0] >= 0
            if near and runs_between_centres_that_fit(net.fits, np.array([point, knot], float)):
                found[row, column] = math.dist(point, knot)
        return found

    last = legs(end)
    heap = [(leg, block) for block, leg in legs(start).items()]
    heapq.heapify(heap)
    done: set[tuple[int, int]] = set()
    best = math.inf
    while heap:
        length, block = heapq.heappop(heap)
        if block in done:
            continue
        done.add(block)
        if block in last:
            best = min(best, length + last[block])
        row, column = block
        for step in np.flatnonzero(net.links[row, column]).tolist():
            to = row + STEP_Y[step], column + STEP_X[step]
            way = math.dist(net.knots[row, column].tolist(), net.knots[to].tolist())
            heapq.heappush(heap, (length + way, to))
    return best


@given(floors())
@settings(max_examples=examples(60))
def test_a_way_fits_and_is_no_longer_than_over_the_net(drawn: tuple[Mask, list[Point]]) -> None:
    fits, (start, end) = drawn
    net = net_over(fits)
    costs = np.full(net.links.size // 8, np.inf)
    way = way_between(net, costs, *start, *end)
    assert np.isinf(costs).all()
    straight = runs_between_centres_that_fit(fits, np.array([start, end]))
    over_net = math.dist(start, end) if straight else length_over_net(net, start, end)
    if not len(way):
        assert math.isinf(over_net)
        return
    assert tuple(way[0]) == start
    assert tuple(way[-1]) == end
    assert crosses_between_centres_that_fit(fits, way)
    assert math.dist(start, end) - 1e-9 <= length_of(way) <= over_net + 1e-9
    # It can only lead where the cells are connected.
    assert (int(end[1]), int(end[0])) in connected_to(
        fits, (int(start[1]), int(start[0])), over_corners=True
    )


def walk(fits: Mask, seed: int) -> Polyline:
    """A way of single steps over cells that fit, to and fro as it comes."""
    random = np.random.default_rng(seed)
    cells = np.argwhere(fits)
    row, column = cells[random.integers(len(cells))].tolist()
    way = [(column, row)]
    for _ in range(60):
        step = int(random.integers(8))
        to = row + STEP_Y[step], column + STEP_X[step]
        if 0 <= to[0] < fits.shape[0] and 0 <= to[1] < fits.shape[1] and fits[to]:
            row, column = to
            way.append((column, row))
    return np.array(way, np.float64)


@given(floors(), st.integers(0, 2**32 - 1))
@settings(max_examples=examples(60))
def test_pulled_straight_a_way_keeps_its_ends_fits_and_is_no_longer(
    drawn: tuple[Mask, list[Point]], seed: int
) -> None:
    fits, _ = drawn
    way = walk(fits, seed)
    found = taut(fits, way)
    assert np.array_equal(found[[0, -1]], way[[0, -1]])
    assert length_of(found) <= length_of(way) + 1e-9
    assert crosses_between_centres_that_fit(fits, found)


def test_around_walls_ways_are_hardly_longer_than_around_their_corners() -> None:
    """Walls of all lengths, so that some end beside a knot and others between two."""
    ratios = []
    for low in range(50, 68, 3):
        fits = np.ones((80, 80), np.bool_)
        fits[:low, 38:43] = False
        net = net_over(fits)
        way = way_between(net, np.full(net.links.size // 8, np.inf), 10.0, 20.0, 70.0, 20.0)
        least = math.dist((10, 20), (38, low)) + 4.0 + math.dist((42, low), (70, 20))
        ratios.append(length_of(way) / least)
    assert min(ratios) >= 1.0 - 1e-9
    assert sum(ratios) / len(ratios) <= 1.025
