"""Waiting for a way to open: how long, how often, and with a clock that is set."""

from __future__ import annotations

from roomba.mission.driving.retry_policy import RetryPolicy

WAIT = 30.0


def test_it_waits_a_while_then_half_a_minute_and_then_gets_out_first() -> None:
    patience = RetryPolicy()
    assert not patience.is_waiting(0.0)
    assert not patience.gets_out
    for wait in (10.0, 10.0, WAIT, WAIT):
        patience.wait(100.0)
        assert patience.gets_out
        assert patience.is_waiting(100.0)
        assert patience.is_waiting(100.0 + wait - 0.1)
        assert not patience.has_ended(100.0 + wait - 0.1)
        assert not patience.is_waiting(100.0 + wait)
        assert [patience.has_ended(100.0 + wait) for _ in range(2)] == [True, False]
    patience.renew()
    patience.wait(100.0)
    assert not patience.is_waiting(110.0)


def test_a_clock_that_is_set_back_does_not_make_it_wait_for_ever() -> None:
    patience = RetryPolicy()
    patience.wait(1e6)
    assert not patience.is_waiting(10.0)


def test_it_looks_five_times_at_once_and_waits_forty_one_times() -> None:
    patience = RetryPolicy()
    told = []
    while not patience.is_over:
        patience.found_no_way_home()
        told.append(patience.must_wait)
    assert told.count(False) == 5
    # The last time it gives up instead.
    assert told.count(True) - 1 == 41
    assert told == sorted(told)


def test_told_to_go_on_it_counts_anew() -> None:
    patience = RetryPolicy()
    for _ in range(50):
        patience.found_no_way_home()
    assert patience.is_over
    patience.renew()
    assert not patience.must_wait
    assert not patience.is_over


def test_while_it_waits_it_looks_now_and_then_and_may_wait_no_longer() -> None:
    patience = RetryPolicy()
    patience.wait(100.0)
    assert [patience.looks_again(100.0 + 0.5 * count) for count in range(9)].count(True) == 2
    patience.end()
    assert not patience.is_waiting(105.0)
    assert patience.has_ended(105.0)
