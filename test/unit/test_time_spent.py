"""How the time of a clean was spent, in parts that add up."""

from __future__ import annotations

import math
from dataclasses import astuple

import pytest

from roomba.time_spent import NAMES, TimeSpent, square_metres_a_minute

SPENT = TimeSpent(
    least=600.0, straight=720.0, slowed=90.0, turning=200.0, again=60.0, station=40.0,
    charging=3000.0, waiting=30.0,
)  # fmt: skip


def test_its_parts_add_up_to_all_but_the_least() -> None:
    assert sum(seconds for _, seconds in SPENT.parts) == sum(astuple(SPENT)[1:])
    assert SPENT.beside == 120.0
    assert dict(SPENT.parts)["ways, and floor passed twice"] == 120.0
    assert len({name for name, _ in SPENT.parts}) == 8


def test_a_part_of_the_floor_that_was_swept_in_later_rounds_takes_no_time_twice() -> None:
    spent = TimeSpent(least=600.0, straight=500.0, again=200.0)
    assert spent.beside == 0.0
    assert sum(seconds for _, seconds in spent.parts) == 700.0


def test_charging_and_waiting_are_not_times_under_way() -> None:
    assert SPENT.under_way == 1110.0
    assert SPENT.times_least == pytest.approx(1.85)
    assert TimeSpent().times_least is None
    assert TimeSpent(least=600.0).times_least is None
    assert TimeSpent(straight=5.0).times_least is None


def test_the_names_are_those_of_the_numbers() -> None:
    assert TimeSpent(*range(8)) == TimeSpent(**dict(zip(NAMES, range(8), strict=True)))


@pytest.mark.parametrize(
    ("covered", "duration", "rate"),
    [(54.0, 1800.0, 1.8), (0.0, 60.0, 0.0), (5.0, 0.0, None), (math.nan, 60.0, None)],
)
def test_floor_a_minute(covered: float, duration: float, rate: float | None) -> None:
    assert square_metres_a_minute(covered, duration) == rate
