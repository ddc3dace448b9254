"""Values that are computed for pages."""

from __future__ import annotations

import math

import pytest

from roomba.client.protocol import ErrandOutcome, ExploreReport, RequestRefusedError
from roomba.client.view import (
    PageLimits,
    battery_fills,
    battery_seconds,
    camera_angles,
    exploration_as_clean,
)
from roomba.geometry import Twist
from roomba.vocabulary import EdgeReason, OpenEdge

LIMITS = PageLimits(0.5, 4.0)


def test_a_battery_is_empty_when_its_charge_is_used_up_and_full_when_the_rest_came() -> None:
    assert battery_seconds(0.5, -1.0 / 3600.0) == pytest.approx(1800.0)
    assert battery_seconds(0.75, 1.0 / 7200.0) == pytest.approx(1800.0)


@pytest.mark.parametrize(("level", "rate"), [(0.5, 0.0), (1.0, 0.1), (0.5, math.nan)])
def test_what_does_not_come_is_not_known(level: float, rate: float) -> None:
    assert math.isnan(battery_seconds(level, rate))


@pytest.mark.parametrize(
    ("level", "is_docked", "fills"), [(0.5, True, True), (1.0, True, False), (0.5, False, False)]
)
def test_a_battery_fills_on_the_station_until_it_is_full(
    level: float, is_docked: bool, fills: bool
) -> None:
    assert battery_fills(level, is_docked=is_docked) == fills


def test_a_hand_drives_no_faster_than_the_robot_may() -> None:
    assert LIMITS.clamped(0.2, -1.0) == Twist(0.2, -1.0)
    assert LIMITS.clamped(9.0, -9.0) == Twist(0.5, -4.0)
    assert LIMITS.clamped(-9.0, 9.0) == Twist(-0.5, 4.0)


def test_a_top_speed_that_the_robot_cannot_keep_is_refused() -> None:
    for speed in (LIMITS.min_speed, LIMITS.max_speed):
        LIMITS.require_speed(speed)
    for speed in (0.09, 0.51, math.nan):
        with pytest.raises(RequestRefusedError, match=r"from 0\.1 to 0\.5 m/s, got "):
            LIMITS.require_speed(speed)


def test_a_camera_looks_at_five_angles_from_the_left_to_the_right() -> None:
    assert camera_angles(30.0) == (30.0, 15.0, 0.0, -15.0, -30.0)


def test_of_an_exploration_a_page_shows_what_was_mapped_and_where_that_ends() -> None:
    edges = (OpenEdge(2.0, 1.0, 3.0, EdgeReason.NOT_LOOKED_AT),)
    report = ExploreReport(ErrandOutcome.COMPLETED, "the map is open", 34.5, 30.0, 40.0, edges)
    shown = exploration_as_clean(report)
    assert (shown.outcome, shown.message) == (report.outcome, report.message)
    assert (shown.mapped, shown.open_edges) == (34.5, edges)
    assert (shown.distance, shown.duration, shown.wanted, shown.covered) == (30.0, 40.0, 0.0, 0.0)
