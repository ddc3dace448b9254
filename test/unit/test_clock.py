"""A clock that was set is told from one that goes on."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.clock import ClockJumps, RobotTime, is_recent


def test_the_first_look_tells_no_jump() -> None:
    clock = ClockJumps(longest=2.0)
    assert clock.last is None
    assert clock.at(500.0) == 0.0
    assert clock.last == 500.0


@pytest.mark.parametrize(
    ("now", "jump"), [(10.0, 0.0), (12.0, 0.0), (12.5, 2.5), (9.9, 0.0), (9.5, -0.5), (0.0, -10.0)]
)
def test_a_jump_is_back_or_farther_than_a_clock_goes(now: float, jump: float) -> None:
    assert ClockJumps(last=10.0, longest=2.0, tolerance=0.125).at(now) == pytest.approx(jump)


def test_the_tolerance_belongs_to_the_time_that_goes_on() -> None:
    assert ClockJumps(last=10.0, tolerance=0.125).at(9.875) == 0.0
    assert ClockJumps(last=10.0).at(9.875) == -0.125


def test_without_limits_only_going_back_is_a_jump() -> None:
    clock = ClockJumps(last=10.0)
    assert (clock.at(1e9), clock.at(1e9), clock.at(5.0)) == (0.0, 0.0, 5.0 - 1e9)


@given(st.lists(st.floats(-100.0, 100.0), min_size=1, max_size=30))
def test_what_went_on_and_what_was_set_are_the_whole_way(steps: list[float]) -> None:
    clock, now, went_on, was_set = ClockJumps(last=0.0, longest=2.0), 0.0, 0.0, 0.0
    for step in steps:
        before, now = now, now + step
        jump = clock.at(now)
        was_set += jump
        went_on += 0.0 if jump else now - before
        assert jump == 0.0 or not 0.0 <= jump <= 2.0
    assert went_on + was_set == pytest.approx(now, abs=1e-9)


@pytest.mark.parametrize("since", [0.0, 0.05, 0.1])
def test_what_is_younger_is_recent(since: float) -> None:
    heard = 1_795_391_806.4
    assert is_recent(heard + since, heard, 0.15)


@pytest.mark.parametrize("since", [-0.05, 0.15, 0.2])
def test_what_is_as_old_or_of_the_future_is_not_recent(since: float) -> None:
    heard = 1_795_391_806.4
    assert not is_recent(heard + since, heard, 0.15)


def test_what_is_as_old_but_for_rounding_is_not_recent() -> None:
    assert not is_recent(0.5 - 1e-6, 0.0, 0.5)


def test_the_robots_time_adds_up_what_passes() -> None:
    time = RobotTime(100.0)
    assert [time.tick(now) for now in (100.05, 100.15, 100.15)] == pytest.approx([0.05, 0.1, 0.0])
    assert time.elapsed == pytest.approx(0.15)


def test_a_clock_that_is_set_changes_the_robots_time_little() -> None:
    time = RobotTime(1000.0)
    assert time.tick(3.0) == 0.0
    assert time.tick(3.05) == pytest.approx(0.05)
    assert time.tick(9000.0) == 2.0
    assert time.tick(9000.05) == pytest.approx(0.05)


@given(st.lists(st.floats(-1e6, 1e6), max_size=30))
def test_the_robots_time_never_goes_back(ticks: list[float]) -> None:
    time, before = RobotTime(0.0), 0.0
    for now in ticks:
        time.tick(now)
        assert before <= time.elapsed <= before + 2.0
        before = time.elapsed
