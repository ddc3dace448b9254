"""Waiting for a way to open: how long, how often, and with a clock that is set."""

from __future__ import annotations

from roomba.configuration.mission import WaitingConfig
from roomba.mission.driving.retry_policy import RetryPolicy

WAIT = 30.0


def test_it_waits_a_while_then_half_a_minute_and_then_gets_out_first() -> None:
    retries = RetryPolicy(WaitingConfig())
    assert not retries.is_waiting(0.0)
    assert not retries.gets_out
    for wait in (10.0, 10.0, WAIT, WAIT):
        retries.wait(100.0)
        assert retries.gets_out
        assert retries.length == wait
        assert retries.is_waiting(100.0)
        assert retries.is_waiting(100.0 + wait - 0.1)
        assert not retries.take_end(100.0 + wait - 0.1)
        assert not retries.is_waiting(100.0 + wait)
        assert [retries.take_end(100.0 + wait) for _ in range(2)] == [True, False]
    retries.renew()
    retries.wait(100.0)
    assert not retries.is_waiting(110.0)


def test_a_clock_that_is_set_back_does_not_make_it_wait_for_ever() -> None:
    retries = RetryPolicy(WaitingConfig())
    retries.wait(1e6)
    assert not retries.is_waiting(10.0)


def test_it_looks_five_times_at_once_and_waits_forty_one_times() -> None:
    retries = RetryPolicy(WaitingConfig())
    told = []
    while not retries.is_over:
        retries.found_no_way_home()
        told.append(retries.must_wait)
    assert told.count(False) == 5
    # The last time it gives up instead.
    assert told.count(True) - 1 == 41
    assert told == sorted(told)


def test_told_to_go_on_it_counts_anew() -> None:
    retries = RetryPolicy(WaitingConfig())
    for _ in range(50):
        retries.found_no_way_home()
    assert retries.is_over
    retries.renew()
    assert not retries.must_wait
    assert not retries.is_over


def test_while_it_waits_it_looks_now_and_then_and_may_wait_no_longer() -> None:
    retries = RetryPolicy(WaitingConfig())
    retries.wait(100.0)
    assert [retries.take_look(100.0 + 0.5 * count) for count in range(9)].count(True) == 2
    retries.end()
    assert not retries.is_waiting(105.0)
    assert retries.take_end(105.0)


def test_a_new_errand_begins_with_nothing_tried() -> None:
    retries = RetryPolicy(WaitingConfig())
    while not retries.is_over:
        retries.found_no_way_home()
        retries.wait(100.0)
    retries.renew()
    told = retries.is_over, retries.must_wait, retries.gets_out, retries.is_pending
    assert not any(told)
    assert not retries.is_waiting(100.0)
