"""The pose by wheels that are read now and then, in whole millimetres."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.drivers.wheel_odometry import WheelOdometry
from roomba.geometry import STANDSTILL, Pose

TRACK = 0.25
PERIOD = 0.07
"""s; from one time that wheels are told to the next."""


def driven(linear: float, angular: float, seconds: float) -> tuple[WheelOdometry, float]:
    """Return what is known after a drive at a speed, told in whole millimetres, and its time."""
    odometry, now = WheelOdometry(TRACK), 0.0
    half = 0.5 * TRACK * angular
    while True:
        odometry.take(now, *(round(v * now, 3) for v in (linear - half, linear + half)))
        if now >= seconds:
            return odometry, now
        now += PERIOD


@given(st.floats(-0.3, 0.3), st.floats(-1.5, 1.5))
def test_it_is_on_the_arc_between_the_times_that_wheels_are_told(
    linear: float, angular: float
) -> None:
    odometry, last = driven(linear, angular, 3.0)
    half = 0.5 * TRACK * angular
    for later in (0.0, 0.05):
        pose = odometry.after(later * (linear - half), later * (linear + half))
        now = last + later
        turn = angular * now
        along = linear * now * (math.sin(0.5 * turn) / (0.5 * turn) if abs(turn) > 1e-9 else 1.0)
        assert pose.x == pytest.approx(along * math.cos(0.5 * turn), abs=0.006)
        assert pose.y == pytest.approx(along * math.sin(0.5 * turn), abs=0.006)
    assert odometry.twist.linear == pytest.approx(linear, abs=0.01)
    assert odometry.twist.angular == pytest.approx(angular, abs=0.06)


def test_wheels_that_count_anew_are_no_way() -> None:
    odometry, last = driven(0.2, 0.0, 1.0)
    before = odometry.after(0.0, 0.0)
    odometry.take(last + 0.1, 5.0, 5.0)
    assert odometry.after(0.0, 0.0) == before
    odometry.take(last + 0.2, 5.01, 5.01)
    assert odometry.after(0.0, 0.0).x == pytest.approx(before.x + 0.01)


def test_what_it_rolled_while_nothing_was_told_counts() -> None:
    odometry, last = driven(0.2, 0.0, 1.0)
    odometry.stand()
    assert odometry.twist == STANDSTILL
    odometry.take(last + 30.0, 0.2 * last + 0.05, 0.2 * last + 0.05)
    assert odometry.after(0.0, 0.0).x == pytest.approx(0.2 * last + 0.05, abs=0.003)
    assert odometry.told_at == last + 30.0


def test_nothing_told_is_standing_at_the_origin() -> None:
    odometry = WheelOdometry(TRACK)
    assert odometry.after(0.0, 0.0) == Pose()
    assert odometry.twist == STANDSTILL
    assert math.isnan(odometry.told_at)
