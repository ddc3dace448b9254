"""Logs whose times do not tell scans apart: their order counts."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.recordings.times.untimed import spread_times, tell_nothing, times_by_order


@pytest.mark.parametrize(
    ("times", "expected"),
    [
        ([0.0, 0.0, 0.0, 0.0], True),
        ([5.0, 5.0, 5.0, 5.0, 6.0], True),
        ([5.0, 5.0, 6.0, 6.0, 7.0, 7.0], False),  # each is written twice
        ([1.0, 2.0, 3.0], False),
        ([1.0], False),
        ([], False),
    ],
)
def test_whether_times_tell_scans_apart(times: list[float], expected: bool) -> None:
    assert tell_nothing(np.array(times)) is expected


def test_without_any_time_scans_are_ten_seconds_apart_and_the_rest_lies_between() -> None:
    is_scan = np.array([False, True, False, True, False, False, True])
    spread = spread_times(np.zeros(7), is_scan)
    assert spread.tolist() == pytest.approx([0.0, 0.0, 5.0, 10.0, 40.0 / 3.0, 50.0 / 3.0, 20.0])


def test_whole_seconds_are_filled_evenly() -> None:
    true = 100.0 + 0.25 * np.arange(20)
    spread = spread_times(np.floor(true), np.ones(20, np.bool_))
    assert spread == pytest.approx(true)


def test_times_of_other_lines_do_not_count() -> None:
    times, is_scan = np.array([7.0, 0.0, 7.0, 0.0, 8.0]), np.array([1, 0, 1, 0, 1], np.bool_)
    assert spread_times(times, is_scan).tolist() == pytest.approx([7.0, 7.25, 7.5, 7.75, 8.0])


def test_a_clock_that_breaks_off_counts_as_none() -> None:
    times = np.full(200, 4.29497e9)
    times[0] = 3.0
    assert np.diff(spread_times(times, np.ones(200, np.bool_))) == pytest.approx(np.full(199, 10.0))


def test_where_either_time_tells_messages_apart_their_order_does_not_count() -> None:
    true = 100.0 + 0.1 * np.arange(60)
    assert times_by_order(true, np.floor(true)) is None
    assert times_by_order(np.floor(true), true + 0.01) is None
    assert times_by_order(np.zeros(60), true) is None
    assert times_by_order(np.array([]), np.array([])) is None


def test_of_two_times_that_do_not_tell_apart_the_one_that_tells_more_counts() -> None:
    true = 100.0 + 0.1 * np.arange(60)
    whole = np.floor(true)
    for stamps, arrivals in ((whole, whole), (np.zeros(60), whole)):
        assert times_by_order(stamps, arrivals) == pytest.approx(true)


def test_times_by_the_order_of_stamps_are_by_the_clock_of_the_arrivals() -> None:
    true = 100.0 + 0.1 * np.arange(60)
    ahead = 4.0 * np.floor(true / 4.0) + 1000.0
    found = times_by_order(np.floor(true), ahead)
    assert found is not None
    assert found == pytest.approx(true + 1000.0, abs=2.0)
    assert np.diff(found) == pytest.approx(0.1)


@pytest.mark.parametrize("rate", [20.0, 200.0])
def test_however_many_messages_a_whole_second_has_they_are_spread(rate: float) -> None:
    true = 100.0 + np.arange(int(5 * rate)) / rate
    spread = times_by_order(np.floor(true), np.floor(true))
    assert spread == pytest.approx(true)


def test_a_clock_that_stands_tells_nothing_to_spread() -> None:
    stood = np.full(60, 4.29497e9)
    stood[0] = 3.0
    assert times_by_order(stood, stood) is None
