"""Times of recording that fall: where the clock was set back they go on, else they are sorted."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.recordings.times.set_back import clock_shifts, gone_on

PERIOD = 0.1


def test_times_go_on_where_a_recorders_clock_was_set_back() -> None:
    once = 3.0 + PERIOD * np.arange(50)
    times = np.concatenate((once, once, once - 20.0))
    kinds = ["odometry", "scan"] * 75
    went_on = 3.0 + PERIOD * np.arange(150)
    assert gone_on(times, kinds) == pytest.approx(went_on)


def test_a_kind_that_comes_first_after_a_clock_was_set_back_begins_the_other_run() -> None:
    times = np.concatenate((np.arange(30.0), np.arange(30.0)))
    kinds = ["odometry"] * 29 + ["scan", "scan"] + ["odometry"] * 29
    assert gone_on(times, kinds) == pytest.approx(np.arange(60.0))


@pytest.mark.parametrize("late", [1, 9])
def test_what_comes_late_sets_no_clock_back(late: int) -> None:
    times = np.concatenate((np.arange(20.0, 40.0), np.arange(20.0 - late, 20.0), [40.0]))
    assert np.array_equal(gone_on(times, ["scan"] * len(times)), times)


def test_kinds_that_are_written_one_after_the_other_set_no_clock_back() -> None:
    times = np.concatenate((np.arange(50.0), np.arange(50.0)))
    assert np.array_equal(gone_on(times, ["odometry"] * 50 + ["scan"] * 50), times)


@given(
    st.integers(0, 200),
    st.lists(st.integers(1, 399), min_size=1, max_size=3, unique=True),
    st.randoms(use_true_random=False),
)
@settings(max_examples=examples(60), deadline=None)
def test_parts_that_lie_in_another_order_are_no_clock_that_was_set_back(
    seed: int, cuts: list[int], random: object
) -> None:
    trembling = np.random.default_rng(seed).uniform(0.0, 0.02, 400)
    times = 5e8 + 0.2 * np.arange(400) + trembling
    parts = np.split(times, sorted(cuts))
    order = list(range(len(parts)))
    random.shuffle(order)  # type: ignore[attr-defined]
    mixed = np.concatenate([parts[at] for at in order])
    assert not clock_shifts(mixed, ["scan", "odometry"] * 200).any()


@pytest.mark.parametrize("first", [300, 330, 380])
def test_a_block_that_was_moved_is_no_clock_that_was_set_back(first: int) -> None:
    times = 100.0 + 0.1 * np.arange(800)
    block = slice(first, first + 30)
    moved = np.concatenate([times[:first], times[first + 30 : 500], times[block], times[500:]])
    assert not clock_shifts(moved, ["scan"] * 800).any()


@pytest.mark.parametrize("width", [60, 800])
def test_lines_that_were_shuffled_are_no_clock_that_was_set_back(width: int) -> None:
    random, times = np.random.default_rng(3), 100.0 + 0.1 * np.arange(800)
    blocks = [random.permutation(times[at : at + width]) for at in range(0, 800, width)]
    assert not clock_shifts(np.concatenate(blocks), ["scan"] * 800).any()


@pytest.mark.parametrize("back", [3.0, 7.0, 39.0, 200.0, 1e6])
def test_a_clock_that_was_set_back_goes_on(back: float) -> None:
    times = 1e6 + 0.1 * np.arange(800)
    told = times - np.where(np.arange(800) < 400, 0.0, back)
    assert gone_on(told, ["scan", "odometry"] * 400) == pytest.approx(times)
