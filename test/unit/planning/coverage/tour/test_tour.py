"""Tours over pieces: hardly longer than the shortest where all can be tried."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
import pytest

from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.tour.costs import (
    Costs,
    Tour,
    cost_of,
    costs_of,
    least_cost,
    tour_cost,
)
from roomba.planning.coverage.tour.near import neighbours, places_over, search_over
from roomba.planning.coverage.tour.net import net_over
from roomba.planning.coverage.tour.order import ordered
from roomba.planning.coverage.tour.tour import iterated_local_search

CONFIG = CoverageConfig()


def costs_between(seed: int, pieces: int) -> Costs:
    net = net_over(np.ones((400, 400), np.bool_))
    rng = np.random.default_rng(seed)
    at = rng.uniform(10.0, 390.0, (2 * pieces, 2))
    nearest, lengths = neighbours(net, search_over(net), places_over(net, at), 8, 600.0)
    headings = rng.uniform(-np.pi, np.pi, 2 * pieces)
    return costs_of(nearest, lengths, at, headings, net.fits, 6.0, False)


def tour_of(order: tuple[int, ...], flips: tuple[int, ...]) -> Tour:
    """The pieces from 0 to 6 with those between in an order, some of them the other way round."""
    between = [
        end
        for piece, flip in zip(order, flips, strict=True)
        for end in (2 * piece + flip, 2 * piece + 1 - flip)
    ]
    return np.array([0, 1, *between, 12, 13], np.int32)


@pytest.mark.parametrize("seed", range(4))
def test_few_pieces_are_put_in_hardly_a_worse_order_than_the_best(seed: int) -> None:
    costs = costs_between(seed, 7)
    tour = iterated_local_search(
        costs, np.arange(14, dtype=np.int32), CONFIG.search_rounds, CONFIG.search_pays
    )
    best = min(
        tour_cost(costs, tour_of(order, flips))
        for order in permutations(range(1, 6))
        for flips in product((0, 1), repeat=5)
    )
    assert tour[:2].tolist() == [0, 1]
    assert tour[-2:].tolist() == [12, 13]
    assert sorted(tour.tolist()) == list(range(14))
    assert best <= tour_cost(costs, tour) < 1.03 * best


def test_many_pieces_get_a_much_better_order() -> None:
    costs = costs_between(1, 60)
    first = np.arange(120, dtype=np.int32)
    tour = iterated_local_search(costs, first, CONFIG.search_rounds, CONFIG.search_pays)
    assert sorted(tour.tolist()) == first.tolist()
    assert all(tour[at] ^ 1 == tour[at + 1] for at in range(0, 120, 2))
    assert tour_cost(costs, tour) < 0.3 * tour_cost(costs, first)


def test_a_cost_is_the_way_and_its_turns_both_ways_alike() -> None:
    net = net_over(np.ones((100, 100), np.bool_))
    at = np.array([[10.0, 10.0], [10.0, 50.0], [40.0, 50.0], [40.0, 10.0]])
    nearest, lengths = neighbours(net, search_over(net), places_over(net, at), 1, 5.0)
    headings = np.array([-np.pi / 2, np.pi / 2, np.pi / 2, -np.pi / 2])
    costs = costs_of(nearest, lengths, at, headings, net.fits, 6.0, False)
    assert cost_of(costs, 1, 2) == pytest.approx(30.0 + 6.0 * np.pi, abs=0.01)
    assert cost_of(costs, 2, 1) == cost_of(costs, 1, 2)
    assert least_cost(costs, 1, 2) <= 30.0


def test_lanes_are_driven_to_and_fro() -> None:
    net = net_over(np.ones((300, 300), np.bool_))
    lanes = [np.array([[20.0 * n, 10.0], [20.0 * n, 290.0]]) for n in range(1, 13)]
    shuffled = [lanes[n] for n in np.random.default_rng(2).permutation(12)]
    way = ordered(net, shuffled, np.array([20.0, 5.0]), None, CONFIG)
    assert [float(lane[0, 0]) for lane in way] == [20.0 * n for n in range(1, 13)]
    assert [float(lane[0, 1]) for lane in way] == [10.0, 290.0] * 6
