"""What is reckoned for pages."""

from __future__ import annotations

import math

import pytest

from roomba.client.view import battery_seconds, camera_angles


def test_a_battery_is_empty_when_its_charge_is_used_up_and_full_when_the_rest_came() -> None:
    assert battery_seconds(0.5, -1.0 / 3600.0) == pytest.approx(1800.0)
    assert battery_seconds(0.75, 1.0 / 7200.0) == pytest.approx(1800.0)


@pytest.mark.parametrize(("level", "rate"), [(0.5, 0.0), (1.0, 0.1), (0.5, math.nan)])
def test_what_does_not_come_is_not_known(level: float, rate: float) -> None:
    assert math.isnan(battery_seconds(level, rate))


def test_a_camera_looks_at_five_angles_from_the_left_to_the_right() -> None:
    assert camera_angles(30.0) == (30.0, 15.0, 0.0, -15.0, -30.0)
