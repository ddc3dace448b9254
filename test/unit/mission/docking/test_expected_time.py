"""The robot's time goes on, also when its clock is set."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.mission.docking.expected_time import RobotTime


def test_it_adds_up_what_passes() -> None:
    time = RobotTime(100.0)
    assert [time.tick(now) for now in (100.05, 100.15, 100.15)] == pytest.approx([0.05, 0.1, 0.0])
    assert time.elapsed == pytest.approx(0.15)


def test_a_clock_that_is_set_changes_little() -> None:
    time = RobotTime(1000.0)
    assert time.tick(3.0) == 0.0
    assert time.tick(3.05) == pytest.approx(0.05)
    assert time.tick(9000.0) == 2.0
    assert time.tick(9000.05) == pytest.approx(0.05)


@given(st.lists(st.floats(-1e6, 1e6), max_size=30))
def test_it_never_goes_back(ticks: list[float]) -> None:
    time, before = RobotTime(0.0), 0.0
    for now in ticks:
        time.tick(now)
        assert before <= time.elapsed <= before + 2.0
        before = time.elapsed
