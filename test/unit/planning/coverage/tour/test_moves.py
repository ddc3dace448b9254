"""Moves of a tour, against tours of few pieces tried one by one and lists swapped in Python."""

from __future__ import annotations

import math
from itertools import permutations, product

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.planning.coverage.tour.costs import Costs, cost_of, costs_of, tour_cost
from roomba.planning.coverage.tour.moves import TourState, exchange, improve, state_along

Ends = list[int]


def costs_between(pieces: int, seed: int, known: int) -> Costs:
    """Pieces anywhere on open floor; of each end ``known`` others are in its list."""
    random = np.random.default_rng(seed)
    ends = 2 * pieces
    at = random.uniform(0.0, 200.0, (ends, 2))
    headings = random.uniform(-math.pi, math.pi, ends)
    headings[random.random(ends) < 0.3] = np.nan
    away = np.hypot(*(at[:, None] - at).transpose(2, 0, 1))
    np.fill_diagonal(away, np.inf)
    nearest = np.full((ends, known), -1, np.int32)
    lengths = np.full((ends, known), np.inf)
    size = min(known, ends - 1)
    nearest[:, :size] = np.argsort(away, axis=1)[:, :size]
    lengths[:, :size] = np.sort(away, axis=1)[:, :size]
    return costs_of(nearest, lengths, at, headings, np.ones((202, 202), np.bool_), 6.0, False)


def state_of(costs: Costs, tour: Ends) -> TourState:
    return state_along(costs, np.array(tour, np.int32))


def improved(costs: Costs, tour: Ends) -> tuple[TourState, NDArray[np.bool_]]:
    state = state_of(costs, tour)
    waiting = np.ones(len(tour), np.bool_)
    improve(costs, state, state.tour.copy(), len(tour), waiting)
    return state, waiting


@st.composite
def tours(draw: st.DrawFn, most: int) -> tuple[Costs, Ends]:
    """A tour with the first and the last piece in their places, the others as it comes."""
    pieces = draw(st.integers(2, most))
    costs = costs_between(pieces, draw(st.integers(0, 2**32 - 1)), draw(st.sampled_from([3, 8])))
    order = draw(st.permutations(range(1, pieces - 1)))
    flips = draw(st.lists(st.booleans(), min_size=pieces, max_size=pieces))
    between = [
        end for piece in order for end in (2 * piece + flips[piece], 2 * piece + 1 - flips[piece])
    ]
    return costs, [0, 1, *between, 2 * pieces - 2, 2 * pieces - 1]


def connections(costs: Costs, tour: Ends) -> float:
    return sum(cost_of(costs, *tour[at : at + 2]) for at in range(1, len(tour) - 1, 2))


@given(tours(14))
@settings(max_examples=examples(150))
def test_moves_keep_every_piece_and_gain_what_they_say(drawn: tuple[Costs, Ends]) -> None:
    costs, first = drawn
    state, waiting = improved(costs, first)
    tour = state.tour.tolist()
    assert sorted(tour) == list(range(len(first)))
    assert all(tour[at] ^ 1 == tour[at + 1] for at in range(0, len(tour), 2))
    assert tour[:2] == first[:2]
    assert tour[-2:] == first[-2:]
    assert [tour[at] for at in state.position] == list(range(len(first)))
    assert not waiting.any()
    # Costs are whole parts of a cell, so the sums are exact.
    assert connections(costs, tour) == connections(costs, first) - state.gain[0]
    assert state.gain[0] >= 0.0
    assert_joined(costs, state)
    changed = [at for at, end in enumerate(tour) if end != first[at]]
    assert all(state.span[0] <= at <= state.span[1] for at in changed)


@given(tours(12))
@settings(max_examples=examples(40))
def test_when_no_end_allows_a_move_no_run_turned_round_is_better(
    drawn: tuple[Costs, Ends],
) -> None:
    """All ends are in all lists, so that no better connection is missed."""
    _, tour = drawn
    pieces = len(tour) // 2
    costs = costs_between(pieces, len(tour), 2 * pieces)
    for _ in range(20):
        # Only ends that a move concerned are looked at again, so some moves come to light later.
        state, _ = improved(costs, tour)
        tour = state.tour.tolist()
        if state.gain[0] == 0.0:
            break
    assert state.gain[0] == 0.0
    found = connections(costs, tour)
    for begin in range(2, len(tour) - 2, 2):
        for end in range(begin + 2, len(tour), 2):
            turned = [*tour[:begin], *tour[begin:end][::-1], *tour[end:]]
            assert connections(costs, turned) >= found - 1e-6


@pytest.mark.parametrize("seed", range(6))
def test_few_pieces_come_near_to_the_best_of_all_orders(seed: int) -> None:
    costs = costs_between(7, seed, 13)
    best = min(
        tour_cost(costs, np.array([0, 1, *between, 12, 13], np.int32))
        for order in permutations(range(1, 6))
        for flips in product((0, 1), repeat=5)
        for between in [
            [
                end
                for piece, flip in zip(order, flips, strict=True)
                for end in (2 * piece + flip, 2 * piece + 1 - flip)
            ]
        ]
    )
    found = connections(costs, improved(costs, list(range(14)))[0].tour.tolist())
    assert best <= found <= 1.15 * best


@given(st.lists(st.integers(1, 11), min_size=3, max_size=3, unique=True))
@settings(max_examples=examples(60))
def test_two_runs_change_places(cuts: list[int]) -> None:
    first, middle, stop = (2 * cut for cut in sorted(cuts))
    costs, tour = costs_between(12, 3, 8), list(range(24))
    state = state_of(costs, tour)
    exchange(costs, state, first, middle, stop)
    expected = [*tour[:first], *tour[middle:stop], *tour[first:middle], *tour[stop:]]
    assert state.tour.tolist() == expected
    assert [expected.index(end) for end in range(24)] == state.position.tolist()
    assert_joined(costs, state)


def assert_joined(costs: Costs, state: TourState) -> None:
    """Both ends of each connection know what it costs."""
    for at in range(1, len(state.tour) - 1, 2):
        one, other = state.tour[at : at + 2].tolist()
        assert state.joined[one] == state.joined[other] == cost_of(costs, one, other)
