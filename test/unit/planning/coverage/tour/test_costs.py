"""Costs of connections, against lengths and angles reckoned one by one."""

from __future__ import annotations

import math
from itertools import combinations
from random import Random

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.planning.coverage.tour.costs import (
    Costs,
    cost_of,
    costs_of,
    least_cost,
    note_pair,
    tour_cost,
    turns_between,
)

PART = 1 / 256
"""cells; costs are counted in such parts."""
Floats = NDArray[np.float64]


def angle(one: tuple[float, float], other: tuple[float, float]) -> float:
    """Between two directions, rad."""
    cosine = (one[0] * other[0] + one[1] * other[1]) / (math.hypot(*one) * math.hypot(*other))
    return math.acos(min(max(cosine, -1.0), 1.0))


def turns(at: Floats, headings: Floats, one: int, other: int) -> float:
    """On leaving a piece in its heading for another, and on entering that against its heading."""
    x, y = (at[other] - at[one]).tolist()
    out = (math.cos(headings[one]), math.sin(headings[one]))
    into = (-math.cos(headings[other]), -math.sin(headings[other]))
    if math.hypot(x, y) < 1e-6:
        return 0.0 if math.isnan(out[0] + into[0]) else angle(out, into)
    return sum(angle(way, (x, y)) for way in (out, into) if not math.isnan(way[0]))


@st.composite
def pieces(draw: st.DrawFn) -> tuple[Floats, Floats]:
    """Places and headings of the ends of up to five pieces; some are points, some coincide."""
    ends = 2 * draw(st.integers(2, 5))
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    at = random.integers(0, 12, (ends, 2)) * 5.0
    headings = random.uniform(-math.pi, math.pi, ends)
    headings[random.random(ends) < 0.2] = np.nan
    return at, headings


def known_nothing(at: Floats, headings: Floats, turning: float, loose: bool) -> Costs:
    """Costs of which no pair was searched for, on floor with a closed block."""
    fits = np.ones((60, 60), np.bool_)
    fits[20:40, 20:40] = False
    nearest = np.full((len(at), 3), -1, np.int32)
    return costs_of(nearest, np.full(nearest.shape, np.inf), at, headings, fits, turning, loose)


@given(pieces(), st.sampled_from([0.0, 6.0]), st.booleans())
@settings(max_examples=examples(60))
def test_in_sight_a_connection_costs_its_length_and_turns_and_behind_things_more(
    drawn: tuple[Floats, Floats], turning: float, loose: bool
) -> None:
    at, headings = drawn
    costs = known_nothing(at, headings, turning, loose)
    for one, other in combinations(range(len(at)), 2):
        angles = turns(at, headings, one, other)
        assert turns_between(costs, one, other) == pytest.approx(angles, abs=1e-6)
        straight = math.dist(at[one].tolist(), at[other].tolist())
        allowed = [straight + turning * angles, 2.0 * straight + 200.0 + turning * angles]
        if loose and other >= len(at) - 2:
            allowed = [0.0]
        found = cost_of(costs, one, other)
        assert any(found == pytest.approx(each, abs=PART) for each in allowed)
        assert found == cost_of(costs, other, one)
        assert (found / PART).is_integer()
        assert least_cost(costs, one, other) <= found


@given(pieces())
@settings(max_examples=examples(30))
def test_what_is_hidden_and_what_is_in_sight_is_told_apart(drawn: tuple[Floats, Floats]) -> None:
    """Places well inside open floor, with a wall between the two halves of it."""
    at, headings = drawn
    headings = np.full_like(headings, np.nan)
    at = np.where(at[:, :1] < 30.0, at / 3.0, at + np.array([20.0, 0.0]))
    fits = np.ones((60, 90), np.bool_)
    fits[:, 15:45] = False
    nearest = np.full((len(at), 1), -1, np.int32)
    lengths = np.full(nearest.shape, np.inf)
    costs = costs_of(nearest, lengths, at, headings, fits, 0.0, False)
    for one, other in combinations(range(len(at)), 2):
        straight = math.dist(at[one].tolist(), at[other].tolist())
        hidden = (at[one, 0] < 15.0) != (at[other, 0] < 15.0)
        expected = 2.0 * straight + 200.0 if hidden else straight
        assert cost_of(costs, one, other) == pytest.approx(expected, abs=PART)


@given(pieces(), st.integers(0, 2**32 - 1), st.booleans())
@settings(max_examples=examples(60))
def test_what_was_found_of_near_ends_counts_with_its_turns_the_cheapest_first(
    drawn: tuple[Floats, Floats], seed: int, loose: bool
) -> None:
    at, headings = drawn
    ends = len(at)
    random = np.random.default_rng(seed)
    # Each end knows of all others, by ways that are longer than straight.
    longer = random.uniform(1.0, 3.0, (ends, ends))
    longer = np.maximum(longer, longer.T)
    ways = longer * np.hypot(*(at[:, None] - at).transpose(2, 0, 1))
    nearest = np.array([[n for n in range(ends) if n != own] for own in range(ends)], np.int32)
    lengths = np.array([ways[own, nearest[own]] for own in range(ends)])
    costs = costs_of(nearest, lengths, at, headings, np.ones((60, 60), np.bool_), 6.0, loose)
    for own in range(ends):
        known = costs.costs[own].tolist()
        assert known == sorted(known)
        for other, cost in zip(costs.nearest[own].tolist(), known, strict=True):
            if other < 0:
                assert loose
                assert cost == math.inf
                continue
            expected = ways[own, other] + 6.0 * turns(at, headings, own, other)
            assert cost == pytest.approx(expected, abs=PART)
            assert cost == cost_of(costs, own, other)
    told = (costs.nearest >= 0).sum(axis=1)
    assert told.tolist() == ([ends - 3] * (ends - 2) + [0, 0] if loose else [ends - 1] * ends)


@given(pieces(), st.randoms(use_true_random=False))
@settings(max_examples=examples(30))
def test_a_tour_costs_what_its_connections_do(drawn: tuple[Floats, Floats], random: Random) -> None:
    at, headings = drawn
    costs = known_nothing(at, headings, 6.0, False)
    order = list(range(len(at) // 2))
    random.shuffle(order)
    tour = [end for piece in order for end in (2 * piece, 2 * piece + 1)]
    expected = sum(cost_of(costs, *tour[place : place + 2]) for place in range(1, len(tour) - 1, 2))
    assert tour_cost(costs, np.array(tour, np.int32)) == expected


def test_noted_costs_are_kept_while_there_is_room_and_the_others_found_anew() -> None:
    ends = 1000
    at = np.stack((np.arange(ends) / 10.0, np.zeros(ends)), axis=1)
    headings = np.full(ends, np.nan)
    nearest = np.full((ends, 1), -1, np.int32)
    fits = np.ones((2, 101), np.bool_)
    costs = costs_of(nearest, np.full((ends, 1), np.inf), at, headings, fits, 6.0, False)
    for other in range(1, ends):
        assert note_pair(costs, 0, other, 7.0 + other) == 7.0 + other
    kept = 0
    for other in range(1, ends):
        found = cost_of(costs, other, 0)
        kept += found == 7.0 + other
        assert found == 7.0 + other or found == pytest.approx(other / 10.0, abs=PART)
    assert 200 <= kept <= 256
