"""Guessed costs of a tour's connections are measured; and what the order gains by that."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.planning.coverage.tour.costs import Costs, Tour, cost_of, costs_of
from roomba.planning.coverage.tour.guesses import guesses_measured
from roomba.planning.coverage.tour.net import Net, net_over

HEIGHT, WIDTH, WALL = 500, 140, 60
"""cells; a wall of 20 columns from WALL on, with a gap at its upper end."""
PART = 1 / 256


def walled() -> Net:
    fits = np.ones((HEIGHT, WIDTH), np.bool_)
    fits[: HEIGHT - 30, WALL : WALL + 20] = False
    return net_over(fits)


def tour_through(places: list[tuple[float, float]], loose: bool = False) -> tuple[Net, Costs, Tour]:
    """Points, each a piece of its own, passed one after the other, of which nothing is known."""
    net = walled()
    at = np.repeat(np.array(places), 2, axis=0)
    nearest = np.full((len(at), 1), -1, np.int32)
    lengths = np.full(nearest.shape, np.inf)
    headings = np.full(len(at), np.nan)
    costs = costs_of(nearest, lengths, at, headings, net.fits, 2.0, loose)
    return net, costs, np.arange(len(at), dtype=np.int32)


def test_a_way_around_a_wall_costs_what_it_is_long() -> None:
    net, costs, tour = tour_through([(50.0, 20.0), (90.0, 20.0)])
    guess = cost_of(costs, 1, 2)
    assert guess == pytest.approx(2.0 * 40.0 + 200.0, abs=PART)
    assert guesses_measured(net, costs, tour) == 1
    over = math.hypot(10.0, 450.0) + 20.0 + math.hypot(10.0, 450.0)
    assert cost_of(costs, 1, 2) == pytest.approx(over, abs=3.0)
    # What is known is not measured again.
    assert guesses_measured(net, costs, tour) == 0


def test_a_way_that_is_shorter_than_guessed_is_noted_too() -> None:
    net, costs, tour = tour_through([(50.0, 465.0), (90.0, 465.0)])
    assert cost_of(costs, 1, 2) > 270.0
    assert guesses_measured(net, costs, tour) == 0
    assert cost_of(costs, 1, 2) == pytest.approx(41.0, abs=2.0)


def test_what_is_in_sight_keeps_its_cost() -> None:
    net, costs, tour = tour_through([(10.0, 20.0), (50.0, 20.0), (50.0, 400.0)])
    before = [cost_of(costs, 1, 2), cost_of(costs, 3, 4)]
    assert guesses_measured(net, costs, tour) == 0
    assert [cost_of(costs, 1, 2), cost_of(costs, 3, 4)] == before == [40.0, 380.0]


def test_to_an_end_that_may_be_anywhere_there_is_no_way() -> None:
    net, costs, tour = tour_through([(50.0, 20.0), (50.0, 60.0), (90.0, 20.0)], loose=True)
    assert guesses_measured(net, costs, tour) == 0
    assert cost_of(costs, 3, 4) == 0.0
