"""How far wheels may roll ahead where drop sensors saw a floor."""

from __future__ import annotations

import math

import pytest

from roomba.configuration.sensors import CliffConfig
from roomba.drivers.neato.seen_floor import SeenFloor

SENSORS = CliffConfig(angles=(60.0, 10.0, -10.0, -60.0), radius=0.2)
REACH = 0.1
"""m; how far the outer sensors are ahead of the wheels."""


def test_nothing_was_seen_before_the_sensors_told() -> None:
    assert SeenFloor(SENSORS).left(5.0) == 0.0


def test_the_wheels_may_come_where_the_sensors_were() -> None:
    floor = SeenFloor(SENSORS)
    floor.take(1.0, has_edge=False)
    assert floor.left(9.0) == pytest.approx(REACH)
    floor.go(9.0, 0.3, 0.2)
    assert floor.left(9.0) == pytest.approx(REACH)
    assert floor.left(9.2) == pytest.approx(REACH - 0.04)
    assert floor.left(10.0) == 0.0
    floor.take(10.0, has_edge=False)
    assert floor.left(10.0) == pytest.approx(REACH)


def test_it_rolls_no_farther_than_it_was_told() -> None:
    floor = SeenFloor(SENSORS)
    floor.take(0.0, has_edge=False)
    floor.go(0.0, 0.06, 0.3)
    assert floor.left(100.0) == pytest.approx(REACH - 0.06)
    # What it had rolled of one command counts when the next one comes.
    floor.go(100.0, 0.03, 0.3)
    assert floor.left(100.05) == pytest.approx(REACH - 0.06 - 0.015)
    floor.go(100.05, 0.0, 0.0)
    assert floor.left(200.0) == pytest.approx(REACH - 0.06 - 0.015)


def test_at_an_edge_no_way_ahead_is_left() -> None:
    floor = SeenFloor(SENSORS)
    floor.take(0.0, has_edge=False)
    floor.take(0.1, has_edge=True)
    assert floor.left(0.1) == 0.0


def test_the_least_ahead_of_all_sensors_counts() -> None:
    floor = SeenFloor(CliffConfig(angles=(60.0, 15.0, -15.0, -60.0), radius=0.155))
    floor.take(0.0, has_edge=False)
    assert floor.left(0.0) == pytest.approx(0.155 * math.cos(math.radians(60.0)))
