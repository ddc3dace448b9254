"""Odometry by encoders that count to 65,535."""

from __future__ import annotations

import math

import pytest

from roomba.configuration.robot import RobotConfig
from roomba.drivers.create2.odometry import EncoderOdometry

CONFIG = RobotConfig()
PER_METRE = CONFIG.wheels.counts_per_turn / (math.pi * CONFIG.body.wheel_diameter)
PERIOD = 0.015


def driven(left: float, right: float, seconds: float, begin: int = 0) -> EncoderOdometry:
    """Wheels at constant speeds, m/s, from a count on."""
    odometry = EncoderOdometry(CONFIG)
    for step in range(round(seconds / PERIOD) + 1):
        now = step * PERIOD
        counts = (round(begin + speed * now * PER_METRE) % 65_536 for speed in (left, right))
        odometry.take(now, *counts)
    return odometry


@pytest.mark.parametrize("begin", [0, 100, 65_500])
@pytest.mark.parametrize("speed", [0.3, -0.3])
def test_straight_on_over_the_end_of_the_counts(begin: int, speed: float) -> None:
    odometry = driven(speed, speed, 2.0, begin)
    assert odometry.pose.x == pytest.approx(2.0 * speed, abs=0.002)
    assert odometry.pose.y == pytest.approx(0.0, abs=1e-6)
    assert odometry.twist.linear == pytest.approx(speed, abs=0.01)


def test_a_circle_leads_back() -> None:
    radius, around = 0.5, 10.0
    speed = 2.0 * math.pi * radius / around
    half = 0.5 * CONFIG.body.wheel_separation / radius
    odometry = driven(speed * (1.0 - half), speed * (1.0 + half), around)
    assert math.hypot(odometry.pose.x, odometry.pose.y) < 0.01
    assert abs(math.remainder(odometry.pose.theta, 2.0 * math.pi)) < 0.02
    assert odometry.twist.angular == pytest.approx(2.0 * math.pi / around, abs=0.05)


def test_counts_that_begin_anew_are_no_way() -> None:
    odometry = driven(0.3, 0.3, 1.0, 30_000)
    before = odometry.pose
    odometry.take(1.05, 0, 0)
    assert odometry.pose == before
    odometry.take(1.10, round(0.01 * PER_METRE), round(0.01 * PER_METRE))
    assert odometry.pose.x - before.x == pytest.approx(0.01, abs=0.001)


def test_what_was_forgotten_is_not_counted() -> None:
    odometry = driven(0.3, 0.3, 1.0)
    before = odometry.pose
    odometry.forget()
    odometry.take(3.0, 900, 900)
    assert odometry.pose == before
    assert odometry.twist.linear == 0.0


def test_what_was_rolled_in_a_pause_counts_and_makes_no_speed() -> None:
    odometry = driven(0.3, 0.3, 1.0)
    odometry.pause()
    assert odometry.twist.linear == 0.0
    # The robot's clock stood meanwhile, and the wheels did not.
    for step, way in enumerate((0.34, 0.3415, 0.343)):
        counts = round(way * PER_METRE)
        odometry.take(1.1 + 0.015 * step, counts, counts)
    assert odometry.pose.x == pytest.approx(0.343, abs=0.002)
    assert odometry.twist.linear == pytest.approx(0.1, abs=0.02)


def test_more_than_it_can_have_rolled_in_a_pause_is_no_way() -> None:
    odometry = driven(0.3, 0.3, 1.0)
    before = odometry.pose
    odometry.pause()
    odometry.take(1.1, round(3.0 * PER_METRE), round(3.0 * PER_METRE))
    assert odometry.pose == before
