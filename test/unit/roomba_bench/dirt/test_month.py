"""Days of a household: dirt falls and is cleaned; and what is made of the days."""

from __future__ import annotations

import pytest

from roomba_bench.dirt.month import Day, Household, Life, all_rooms, live, what_is_due
from roomba_bench.topics.dirt import rows_of

ROOMS = {"kitchen": 10.0, "living room": 30.0}
"""m2."""


@pytest.mark.thorough
def test_dirt_falls_all_day_and_what_is_cleaned_has_less_of_it() -> None:
    household = Household("bay", 1)
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


@pytest.mark.thorough
def test_some_days_by_what_is_due_take_less_way_and_leave_no_room_much_dirtier() -> None:
    due, daily = (live("bay", 1, 6, plan) for plan in ("due", "all rooms daily"))
    assert due.times_cleaned("kitchen") == 6
    assert due.times_cleaned("living room") < 6
    assert due.way < 0.8 * daily.way
    assert due.dirtiest(3) < 1.2 * daily.dirtiest(3)


def life(way: float, after: float, before: float) -> Life:
    """Ten days that are all alike."""
    day = Day(
        tuple(ROOMS),
        way,
        100.0,
        {"kitchen": before, "living room": 1.0},
        {"kitchen": after, "living room": 1.0},
    )
    return Life(ROOMS, (day,) * 10)


def test_the_figures_of_days() -> None:
    some = life(50.0, 1.0, 3.0)
    assert some.way == 500.0
    assert some.times_cleaned("kitchen") == 10
    assert some.dirtiest(7) == 3.0
    assert some.mean_dirt(7) == pytest.approx((2.0 * 10.0 + 1.0 * 30.0) / 40.0)


def test_ours_stands_beside_the_fixed_plan() -> None:
    lives = {
        "due": [life(30.0, 1.0, 3.2), life(35.0, 1.0, 3.2)],
        "all rooms daily": [life(50.0, 1.0, 3.0), life(50.0, 1.0, 3.0)],
    }
    rows = {row.figure.split(" (")[0]: row for row in rows_of("bay", lives)}
    assert rows["way"].value == 325.0
    assert rows["way"].peers[0].value == 500.0
    saved = rows["less way than by the fixed plan, the least of a seed"]
    assert saved.value == pytest.approx(30.0)
    worst = rows["dirt of the dirtiest room before its clean"]
    assert worst.value == pytest.approx(3.2)
    assert worst.is_reached
    assert rows["dirt of all floor, mean"].is_reached
    assert rows["cleans of rooms"].value == 20.0
