"""Lines of CARMEN logs: what each kind of them tells."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.recordings.carmen.lines import PARSERS, CarmenLine, Fan, finite, is_number


def line_of(text: str) -> CarmenLine:
    words = text.split()
    return PARSERS[words[0]](words)


def test_a_front_laser_tells_both_poses_and_looks_from_right_to_left() -> None:
    line = line_of("FLASER 2 1.0 2.5 0.6 0 0 0.5 0 0.25 12.5 nohost 0.5")
    assert line.ranges is not None
    assert line.ranges.tolist() == [1.0, 2.5]
    assert (line.laser, line.odometry) == (Pose(0.6, 0.0, 0.0), Pose(0.5, 0.0, 0.25))
    assert line.fan == Fan(2, -0.5 * math.pi, 0.5 * math.pi, 0.0)
    assert (line.stamp, line.arrival) == (12.5, 0.5)


def test_a_laser_that_tells_how_it_is_set_has_its_words_after_the_remissions() -> None:
    set_so = "0 -1.0 2.0 0.5 30.0 0.01 0 3 1.0 2.0 30.0 2 7 8"
    poses = "0.6 0.0 0.0 0.5 0.0 0.0 0.3 0.1 0.4 0.2 1e6"
    both = line_of(f"ROBOTLASER1 {set_so} {poses} 13.5 robot 1.25")
    raw = line_of(f"RAWLASER1 {set_so} 13.5 robot 1.25")
    assert both.fan == raw.fan == Fan(3, -1.0, 0.5, 30.0)
    assert (both.stamp, both.arrival) == (raw.stamp, raw.arrival) == (13.5, 1.25)
    assert (both.odometry, raw.odometry) == (Pose(0.5, 0.0, 0.0), None)


@given(st.lists(st.floats(-1e6, 1e6), min_size=3, max_size=3), st.floats(0.0, 1e9))
def test_odometry_is_told_as_it_was_written(numbers: list[float], stamp: float) -> None:
    x, y, theta = numbers
    line = line_of(f"ODOM {x!r} {y!r} {theta!r} 0.3 0.1 0.0 {stamp!r} nohost 2.0")
    assert line.odometry is not None
    assert (line.odometry.x, line.odometry.y) == (x, y)
    assert math.cos(line.odometry.theta) == pytest.approx(math.cos(theta), abs=1e-6)
    assert (line.stamp, line.arrival, line.fan) == (stamp, 2.0, None)


@pytest.mark.parametrize(
    ("words", "told"),
    [("", (0.0, 0.0)), ("12.5", (12.5, 12.5)), ("12.5 host", (12.5, 12.5))],
)
def test_times_that_are_missing(words: str, told: tuple[float, float]) -> None:
    line = line_of(f"ODOM 0 0 0 0 0 0 {words}")
    assert (line.stamp, line.arrival) == told


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("FLASER 5 1.0 2.0", "expected 5 ranges, got 2"),
        ("FLASER 1 1.0 0 0", "expected x, y and theta, got 0 numbers"),
        ("ODOM nan 0 0 0 0 0 1 h 1", "expected a finite number, got nan"),
        ("ODOM one 0 0", "could not convert"),
    ],
)
def test_what_is_wrong_is_said(text: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        line_of(text)


def test_what_is_a_number() -> None:
    assert [is_number(word) for word in ("1.5", "1e6", "nan", "-inf", "1,5", "x", "")] == [
        *[True] * 4,
        *[False] * 3,
    ]
    assert finite("1e6") == 1e6
