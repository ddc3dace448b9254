"""Stamps that are missing, late, equal, out of order, of another clock, or that jump."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.recordings.times.stamps import StampCounts, delay_of, in_order, mended

Floats = NDArray[np.float64]

BEGAN, PERIOD, DELAY = 1.6e9, 0.1, 0.03


def clean(count: int = 200) -> tuple[Floats, Floats]:
    """Return stamps, s, and arrivals that tremble by some ms."""
    stamps = BEGAN + PERIOD * np.arange(count)
    return stamps, stamps + DELAY + np.random.default_rng(count).uniform(0.0, 0.02, count)


def mend(stamps: Floats, arrivals: Floats) -> tuple[Floats, StampCounts]:
    counts = StampCounts()
    delay = delay_of(stamps, arrivals)
    assert delay is not None
    return mended(stamps, arrivals, delay, counts), counts


def test_good_stamps_stay_as_they_are() -> None:
    stamps, arrivals = clean()
    times, counts = mend(stamps, arrivals)
    assert np.array_equal(times, stamps)
    assert counts == StampCounts(messages=200)
    assert counts.words == "200 messages: all in order"


@given(
    st.lists(
        st.tuples(st.integers(0, 199), st.sampled_from((1.0, 0.7, 5.0))),
        max_size=12,
        unique_by=lambda jump: jump[0],
    )
)
@settings(max_examples=examples(60), deadline=None)
def test_stamps_that_jump_ahead_come_back(jumps: list[tuple[int, float]]) -> None:
    stamps, arrivals = clean()
    wrong = stamps.copy()
    for at, by in jumps:
        wrong[at] += by
    times, counts = mend(wrong, arrivals)
    assert np.abs(times - stamps).max() < 0.05
    assert counts.jumped == len(jumps)


@given(st.integers(0, 199), st.sampled_from((-0.6, -1.0, -3.0)))
@settings(max_examples=examples(40), deadline=None)
def test_a_stamp_that_jumps_back_comes_back(at: int, by: float) -> None:
    stamps, arrivals = clean()
    wrong = stamps.copy()
    wrong[at] += by
    times, counts = mend(wrong, arrivals)
    assert np.abs(times - stamps).max() < 0.05
    assert counts.jumped == 1


@given(st.integers(1, 150), st.integers(5, 40))
@settings(max_examples=examples(40), deadline=None)
def test_a_message_that_comes_late_keeps_its_stamp(at: int, later: int) -> None:
    stamps, arrivals = clean()
    order = [*range(at), *range(at + 1, at + later), at, *range(at + later, 200)]
    times, counts = mend(stamps[order], arrivals)
    assert np.array_equal(times, stamps[order])
    assert counts == StampCounts(messages=200, out_of_order=1)


@given(st.integers(0, 1000))
@settings(max_examples=examples(20), deadline=None)
def test_many_messages_that_come_late_keep_their_stamps(seed: int) -> None:
    """A fifth of them, up to 1 s, of a driver that sends some at once: steps are not alike."""
    generator = np.random.default_rng(seed)
    stamps = BEGAN + np.cumsum(generator.choice((0.0004, 0.07, 0.2), 300))
    late = np.where(generator.random(300) < 0.2, generator.uniform(0.0, 1.0, 300), 0.01)
    order = np.argsort(stamps + late)
    times, counts = mend(stamps[order], (stamps + late)[order])
    assert np.mean(times == stamps[order]) > 0.97
    assert counts.jumped <= 9


@given(st.integers(0, 1000), st.sampled_from((0.8, 1.5, 5.0)), st.sampled_from((0.1, 0.5, 1.0)))
@settings(max_examples=examples(20), deadline=None)
def test_evenly_sent_messages_keep_their_stamps_however_late_they_come(
    seed: int, most: float, share: float
) -> None:
    """As through a network that delays each by another time."""
    generator = np.random.default_rng(seed)
    stamps = BEGAN + 2.0 * PERIOD * np.arange(400)
    late = np.where(generator.random(400) < share, generator.uniform(0.0, most, 400), 0.01)
    order = np.argsort(stamps + late)
    times, counts = mend(stamps[order], (stamps + late)[order])
    assert np.array_equal(times, stamps[order])
    assert counts.jumped == 0


@given(
    st.integers(0, 1000),
    st.integers(0, 399),
    st.integers(1, 40),
    st.sampled_from((-500.0, -60.0, 60.0, 1000.0)),
    st.sampled_from((0.02, 0.1, 0.3)),
)
@settings(max_examples=examples(60), deadline=None)
def test_a_jump_comes_back_however_unevenly_messages_come(
    seed: int, first: int, length: int, by: float, most: float
) -> None:
    stamps = BEGAN + PERIOD * np.arange(400)
    wrong = stamps.copy()
    wrong[first : first + length] += by
    late = 0.01 + np.random.default_rng(seed).uniform(0.0, most, 400)
    times, counts = mend(wrong, np.maximum.accumulate(stamps + late))
    assert np.abs(times - stamps).max() < 0.05 + most
    assert counts.jumped == np.count_nonzero(wrong != stamps)


@given(st.integers(0, 1000), st.integers(1, 350), st.integers(1, 40))
@settings(max_examples=examples(20), deadline=None)
def test_a_jump_amid_messages_that_overtake_each_other_comes_back_alone(
    seed: int, first: int, length: int
) -> None:
    stamps = BEGAN + PERIOD * np.arange(400)
    late = np.random.default_rng(seed).uniform(0.0, 3.0, 400)
    order = np.argsort(stamps + late)
    wrong = stamps.copy()
    wrong[first : first + length] += 1000.0
    times, counts = mend(wrong[order], (stamps + late)[order])
    good = (wrong == stamps)[order]
    assert np.array_equal(times[good], stamps[order][good])
    assert np.abs(times - stamps[order]).max() < 3.0
    assert counts.jumped == length


@given(st.integers(0, 1000), st.integers(20, 150), st.sampled_from((-5.0, 1.0, 30.0)))
@example(53, 73, -5.0)
@settings(max_examples=examples(20), deadline=None)
def test_a_jump_of_unevenly_sent_messages_comes_back(seed: int, first: int, by: float) -> None:
    generator = np.random.default_rng(seed)
    stamps = BEGAN + np.cumsum(generator.choice((0.03, 0.07, 0.2), 200))
    wrong = stamps.copy()
    wrong[first : first + 40] += by
    times, _ = mend(wrong, stamps + generator.uniform(0.0, 0.02, 200))
    assert np.abs(times - stamps).max() < 0.05


@given(st.integers(5, 80), st.integers(5, 80), st.sampled_from((-2.0, 1.0, 3600.0)))
@settings(max_examples=examples(40), deadline=None)
def test_a_clock_that_is_set_on_the_way_comes_back(first: int, length: int, by: float) -> None:
    stamps, arrivals = clean()
    wrong = stamps.copy()
    wrong[first : first + length] += by
    times, counts = mend(wrong, arrivals)
    assert np.abs(times - stamps).max() < 0.05
    assert counts.jumped == length


def test_messages_that_are_held_up_and_come_at_once_keep_their_stamps() -> None:
    stamps, arrivals = clean()
    arrivals[50:90] = np.maximum(arrivals[50:90], arrivals[90])
    times, counts = mend(stamps, arrivals)
    assert np.array_equal(times, stamps)
    assert counts.jumped == 0


def test_messages_that_always_come_in_bunches_are_of_no_other_clock() -> None:
    """A lidar behind a wireless link: its scans of 5 s come at once, the odometry at all times."""
    stamps, arrivals = clean()
    held = stamps[-1] - stamps[0]
    bunches = np.ceil((stamps - stamps[0] + 0.01) / 5.0)
    late = arrivals[0] + np.minimum(5.0 * bunches, held) + 0.001 * np.arange(len(stamps)) % 0.01
    times, counts = mend(stamps, late)
    assert np.array_equal(times, stamps)
    assert counts.jumped == 0
    assert delay_of(stamps, late) == pytest.approx(arrivals[0] - stamps[0], abs=0.3)


def test_arrivals_that_all_are_the_same_say_nothing() -> None:
    stamps, _ = clean()
    times, counts = mend(stamps, np.full(200, 7.0))
    assert np.array_equal(times, stamps)
    assert counts.jumped == 0


def test_a_pause_of_the_recording_is_no_jump() -> None:
    stamps, arrivals = clean()
    stamps[100:] += 60.0
    arrivals[100:] += 60.0
    times, counts = mend(stamps, arrivals)
    assert np.array_equal(times, stamps)
    assert counts.jumped == 0


@pytest.mark.parametrize("missing", [0.0, np.nan, -1.0])
def test_messages_without_stamps_go_by_the_time_of_recording(missing: float) -> None:
    stamps, arrivals = clean()
    wrong = stamps.copy()
    wrong[::7] = missing
    times, counts = mend(wrong, arrivals)
    assert np.abs(times - stamps).max() < 0.02
    assert counts.without == len(wrong[::7])
    assert delay_of(np.full(5, missing), arrivals[:5]) is None


def test_a_channel_without_any_stamp_goes_by_the_delay_of_the_odometry() -> None:
    stamps, arrivals = clean()
    counts = StampCounts()
    times = mended(np.zeros(200), arrivals, DELAY, counts)
    assert np.abs(times - stamps).max() < 0.02
    assert counts.without == 200


def test_stamps_of_another_clock_are_shifted_and_keep_their_steps() -> None:
    stamps, arrivals = clean()
    counts = StampCounts()
    times = mended(stamps - 37.0, arrivals, DELAY, counts)
    assert np.abs(times - stamps).max() < 0.02
    assert np.diff(times) == pytest.approx(np.diff(stamps), abs=1e-6)
    assert counts == StampCounts(messages=200)


def test_a_clock_that_counts_whole_seconds_is_not_gone_by() -> None:
    stamps, arrivals = clean()
    counts = StampCounts()
    assert delay_of(np.floor(stamps), arrivals) is None
    times = mended(np.floor(stamps), arrivals, DELAY, counts)
    assert np.abs(times - stamps).max() < 0.03
    assert counts == StampCounts(messages=200, coarse=200)


def test_stamps_after_their_own_arrival_are_of_another_clock() -> None:
    stamps, arrivals = clean()
    counts = StampCounts()
    times = mended(stamps + 0.5, arrivals, DELAY, counts)
    assert np.abs(times - stamps).max() < 0.03
    # With the odometry's stamps it is the recorder's clock that is off.
    assert np.array_equal(mended(stamps + 0.5, arrivals, DELAY - 0.5, counts), stamps + 0.5)


@given(st.permutations(range(60)))
@settings(max_examples=examples(40), deadline=None)
def test_what_is_out_of_order_is_sorted_and_counted(order: list[int]) -> None:
    # Within a few messages, as packets overtake each other.
    stamps = BEGAN + PERIOD * np.array(sorted(range(60), key=lambda at: at + order[at] / 20.0))
    arrivals = BEGAN + DELAY + PERIOD * np.arange(60)
    times, counts = mend(stamps, arrivals)
    places = in_order(times, np.zeros(60, np.int64), np.zeros(60, np.int64), counts)
    late = sum(stamp < max(stamps[: at + 1]) for at, stamp in enumerate(stamps))
    assert counts.out_of_order == late
    assert (np.diff(times[places]) > 0.0).all()
    assert len(places) == 60


@given(
    st.lists(st.tuples(st.integers(0, 30), st.integers(0, 2)), min_size=1, max_size=80),
)
@settings(max_examples=examples(80), deadline=None)
def test_of_a_time_each_channel_counts_once_and_the_lowest_rank_first(
    messages: list[tuple[int, int]],
) -> None:
    times = np.array([0.1 * time for time, _ in messages])
    channels = np.array([channel for _, channel in messages])
    ranks = 2 - channels
    counts = StampCounts()
    order = in_order(times, channels, ranks, counts)
    rows = [(times[at], ranks[at]) for at in order]
    assert rows == sorted(set(zip(times.tolist(), ranks.tolist(), strict=True)))
    assert counts.equal == len(messages) - len(rows)
    # Of equal ones the first that was recorded is the one that counts.
    firsts = {pair: at for at, pair in reversed(list(enumerate(messages)))}
    assert {messages[at]: at for at in order} == firsts


def test_counts_are_told_in_a_line() -> None:
    counts = StampCounts(10, without=1, jumped=2, coarse=3, by_order=7, out_of_order=4, equal=5)
    counts.add(StampCounts(5, equal=1))
    assert counts.words == (
        "15 messages: 1 without a stamp (by the time of recording), 2 of a clock that had jumped "
        "(shifted back), 3 of a coarse clock (by the time of recording), 7 of times that several "
        "have, as of whole seconds (by their order), 4 out of order (sorted), "
        "6 of a time that another one has (left out)"
    )
