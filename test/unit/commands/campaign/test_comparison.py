"""Paired comparisons, against scipy's own test, and on made-up numbers with a known result."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from roomba.commands.campaign.comparison import Comparison, compared, interval_of

Runs = dict[tuple[str, int], dict[str, Any]]


def runs_of(values: dict[tuple[str, int], float | None]) -> Runs:
    """Rows with a distance each; None: without figures."""
    return {
        pair: {
            "figures": None
            if value is None
            else {"outcome": "COMPLETED", "docked": True, "distance_m": value}
        }
        for pair, value in values.items()
    }


def test_the_interval_is_that_of_scipys_paired_test() -> None:
    from scipy import stats  # a second of each process that would read this file

    random = np.random.default_rng(1)
    one = random.normal(100.0, 30.0, 12)
    other = one + random.normal(2.0, 3.0, 12)
    expected = stats.ttest_rel(other, one).confidence_interval(0.9)
    assert interval_of(other - one, 0.9) == pytest.approx((expected.low, expected.high))


def test_the_interval_holds_the_truth_as_often_as_it_says() -> None:
    random = np.random.default_rng(2)
    held = 0
    for _ in range(1000):
        low, high = interval_of(random.normal(1.0, 4.0, 6), 0.8)
        assert low is not None
        assert high is not None
        held += low <= 1.0 <= high
    assert held / 1000 == pytest.approx(0.8, abs=0.04)


def test_homes_that_differ_much_do_not_hide_a_small_difference() -> None:
    random = np.random.default_rng(3)
    pairs = [("random", seed) for seed in range(20)]
    floor = dict(zip(pairs, random.uniform(20.0, 400.0, 20).tolist(), strict=True))
    runs = runs_of(floor), runs_of({pair: value + 0.5 for pair, value in floor.items()})
    found = compared("other", "distance_m", "", runs, 0.95)
    assert found is not None
    assert found.difference == pytest.approx(0.5)
    assert found.is_told_apart
    assert found.pairs == 20


def test_a_difference_by_chance_is_not_told_apart() -> None:
    pairs = [("random", seed) for seed in range(4)]
    base = runs_of(dict.fromkeys(pairs, 10.0))
    other = runs_of(dict(zip(pairs, (9.0, 11.5, 8.5, 11.0), strict=True)))
    found = compared("other", "distance_m", "", (base, other), 0.95)
    assert found is not None
    assert not found.is_told_apart


def test_a_pair_without_a_value_is_left_out_and_counted() -> None:
    base = runs_of({("a", 0): 10.0, ("a", 1): 10.0, ("b", 0): None, ("b", 1): 10.0})
    other = runs_of({("a", 0): 12.0, ("a", 1): None, ("b", 0): 50.0})
    found = compared("other", "distance_m", "", (base, other), 0.95)
    assert found == Comparison("other", "distance_m", "", 1, 2, 10.0, 12.0, 2.0, None, None)


def test_a_run_without_figures_counts_as_not_completed() -> None:
    base = runs_of({("a", 0): 1.0, ("a", 1): 1.0})
    other = runs_of({("a", 0): 1.0, ("a", 1): None})
    found = compared("other", "completed", "", (base, other), 0.95)
    assert found is not None
    assert (found.baseline_mean, found.variant_mean, found.left_out) == (1.0, 0.5, 0)


def test_of_one_home_only_its_pairs_count() -> None:
    base = runs_of({("a", 0): 1.0, ("b", 0): 1.0})
    other = runs_of({("a", 0): 2.0, ("b", 0): 5.0})
    found = compared("other", "distance_m", "b", (base, other), 0.95)
    assert found is not None
    assert (found.pairs, found.difference) == (1, 4.0)
    assert compared("other", "distance_m", "c", (base, other), 0.95) is None


def test_percent_is_of_the_baseline() -> None:
    found = Comparison("other", "distance_m", "", 2, 0, 50.0, 55.0, 5.0, 4.0, 6.0)
    assert found.percent == (10.0, 8.0, 12.0)
    assert Comparison("other", "hits", "", 2, 0, 0.0, 1.0, 1.0, 0.5, 1.5).percent is None
