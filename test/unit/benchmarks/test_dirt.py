"""Days of a household: dirt falls and is cleaned; and what is made of the days."""

from __future__ import annotations

import pytest

from benchmarks.dirt.month import Day, Household, all_rooms, what_is_due
from benchmarks.topics.dirt import dirtiest, mean_dirt, rows_of, times_cleaned, way_of


@pytest.fixture(scope="module")
def household() -> Household:
    return Household("bay", 1)


@pytest.mark.thorough
def test_dirt_falls_all_day_and_what_is_cleaned_has_less_of_it(household: Household) -> None:
    assert household.names == ("kitchen", "living room")
    before = household.robot.simulator.dirt.total
    idle = household.pass_day(0, lambda number, household: ())
    rates = sum(source.rate for source in household.home.dirt_sources)
    fallen = 1e-6 * (household.robot.simulator.dirt.total - before)
    assert fallen == pytest.approx(24.0 * rates, rel=1e-3)
    assert (idle.rooms, idle.way, idle.seconds) == ((), 0.0, 0.0)
    assert what_is_due(0, household) == household.names
    done = household.pass_day(1, all_rooms)
    assert done.way > 50.0
    assert all(done.after[name] < 0.3 * done.before[name] for name in household.names)
    assert set(household.records.rooms) == set(household.names)


def days(way: float, after: float, before: float) -> list[Day]:
    """Ten days that are all alike."""
    rooms = ("kitchen", "living room")
    alike = [
        Day(
            rooms,
            way,
            100.0,
            {"kitchen": before, "living room": 1.0},
            {"kitchen": after, "living room": 1.0},
        )
    ]
    return alike * 10


def test_the_figures_of_days(household: Household) -> None:
    some = days(50.0, 1.0, 3.0)
    assert way_of(some) == 500.0
    assert times_cleaned(some, "kitchen") == 10
    assert dirtiest(household, some) == 3.0
    kitchen, living = household.areas["kitchen"], household.areas["living room"]
    mean = (2.0 * kitchen + 1.0 * living) / (kitchen + living)
    assert mean_dirt(household, some) == pytest.approx(mean)


def test_ours_stands_beside_the_fixed_plan(household: Household) -> None:
    lives = {
        "due": (household, days(30.0, 1.0, 3.2)),
        "all rooms daily": (household, days(50.0, 1.0, 3.0)),
    }
    rows = {row.figure.split(" (")[0]: row for row in rows_of("bay", lives)}
    assert rows["way"].value == 300.0
    assert rows["way"].peers[0].value == 500.0
    assert rows["less way than by the fixed plan"].value == pytest.approx(40.0)
    assert rows["less way than by the fixed plan"].is_reached
    worst = rows["dirt of the dirtiest room before its clean"]
    assert worst.value == pytest.approx(3.2)
    assert worst.is_reached
    assert rows["cleans of rooms"].value == 20.0
