"""When a process is started anew, ended, reported or given up."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.nodes import SupervisionConfig
from roomba_ros.supervision.watch import Watch

CONFIG = SupervisionConfig(
    busy=1.0, stopped=2.0, hung=10.0, back_after=0.5, most_short_lives=3, short_life=15.0
)


def running(now: float = 0.0) -> Watch:
    watch = Watch("speed_pub_node", CONFIG)
    assert watch.wants_start(now)
    watch.started(now)
    watch.beat(now)
    return watch


def test_one_that_beats_is_left_alone() -> None:
    watch = running()
    for now in range(100):
        watch.beat(float(now))
        watch.seen(now + 0.5, is_stopped=False)
        assert watch.trouble(now + 0.5) == ""
        assert not watch.wants_end(now + 0.5)
        assert not watch.wants_start(now + 0.5)


def test_one_that_starts_may_take_its_time() -> None:
    watch = Watch("speed_pub_node", CONFIG)
    watch.started(0.0)
    assert watch.trouble(1000.0) == ""
    assert not watch.wants_end(1000.0)


def test_one_that_is_silent_is_told_and_then_ended() -> None:
    watch = running()
    assert watch.trouble(1.0) == ""
    assert watch.trouble(3.2) == "speed_pub_node has not answered for 3 s"
    assert not watch.wants_end(10.0)
    assert watch.wants_end(10.1)


def test_one_that_is_stopped_is_told_at_once_and_then_ended() -> None:
    watch = running()
    watch.seen(0.1, is_stopped=True)
    assert watch.trouble(0.1) == "speed_pub_node is stopped; if it stays so, it is started anew"
    watch.seen(2.1, is_stopped=True)
    assert not watch.wants_end(2.1)
    assert watch.wants_end(2.2)
    watch.seen(2.2, is_stopped=False)
    assert not watch.wants_end(2.2)
    watch.seen(3.0, is_stopped=True)
    assert not watch.wants_end(4.9)


def test_one_that_ended_is_started_anew_and_told_until_it_lives() -> None:
    watch = running()
    watch.ended(5.0, "was ended by SIGKILL")
    assert watch.trouble(5.0) == "speed_pub_node was ended by SIGKILL; it is started anew"
    assert not watch.wants_end(5.0)
    assert not watch.wants_start(5.4)
    assert watch.wants_start(5.5)
    watch.started(5.5)
    assert watch.trouble(6.0) == "speed_pub_node was ended by SIGKILL; it is starting"
    watch.beat(7.0)
    assert watch.trouble(7.0) == ""


@pytest.mark.parametrize(("life", "is_given_up"), [(14.9, True), (15.1, False)])
def test_one_that_keeps_ending_soon_is_given_up_in_words(life: float, *, is_given_up: bool) -> None:
    watch = running()
    for number in range(3):
        assert not watch.is_given_up
        watch.started(100.0 * number)
        watch.ended(100.0 * number + life, "ended with status 1")
    assert watch.is_given_up is is_given_up
    assert watch.wants_start(1e6) is not is_given_up
    assert ("keeps ending (ended with status 1)" in watch.trouble(1e6)) is is_given_up


def test_a_long_life_makes_up_for_short_ones() -> None:
    watch, now = running(), 0.0
    for life in (1.0, 1.0, 100.0, 1.0, 1.0):
        watch.started(now)
        now += life
        watch.ended(now, "ended with status 1")
    assert not watch.is_given_up
    watch.started(now)
    watch.ended(now, "ended with status 1")
    assert watch.is_given_up


def test_short_lives_that_do_not_count_are_not_given_up_for() -> None:
    watch = running()
    for number in range(10):
        watch.started(100.0 * number)
        watch.ended(100.0 * number + 1.0, "ended with status 1", counts=number % 5 == 4)
    assert not watch.is_given_up
    watch.started(2000.0)
    watch.ended(2001.0, "ended with status 1")
    assert watch.is_given_up


def test_a_long_life_makes_up_for_short_ones_whether_it_counts_or_not() -> None:
    watch, now = running(), 0.0
    for life in (1.0, 1.0, 15.0, 1.0, 1.0):
        watch.started(now)
        now += life
        watch.ended(now, "ended with status 1", counts=life < 15.0)
    assert not watch.is_given_up


def test_it_is_up_from_its_first_sign_of_life_until_it_ends() -> None:
    watch = Watch("master", CONFIG)
    assert math.isinf(watch.up_since)
    watch.started(1.0)
    assert math.isinf(watch.up_since)
    watch.beat(2.0)
    watch.beat(3.0)
    assert watch.up_since == 2.0
    watch.ended(4.0, "was ended by SIGKILL")
    assert math.isinf(watch.up_since)
    watch.started(5.0)
    assert math.isinf(watch.up_since)


@given(st.lists(st.tuples(st.sampled_from(["beat", "end", "stop", "go"]), st.floats(0.0, 5.0))))
def test_it_is_never_wanted_that_what_runs_is_started_or_what_ended_is_ended(
    events: list[tuple[str, float]],
) -> None:
    watch, now = running(), 0.0
    for what, pause in events:
        now += pause
        if what == "beat" and watch.is_running:
            watch.beat(now)
        elif what == "end" and watch.is_running:
            watch.ended(now, "ended with status 0")
        else:
            watch.seen(now, is_stopped=what == "stop")
        assert not (watch.wants_start(now) and watch.wants_end(now))
        assert not (watch.wants_start(now) and watch.is_running)
        assert watch.is_running or watch.trouble(now)
        if watch.wants_start(now):
            watch.started(now)
