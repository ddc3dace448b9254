"""Which rooms are due by their dirt: learned from clean to clean, over made-up days."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping

import pytest

from roomba.configuration.household import DueConfig
from roomba.plans.due import DirtRecords, RoomNeed, learned, needs_of
from roomba.vocabulary import RoomDirt

BEGIN = dt.datetime(2026, 5, 1, 9, 0, tzinfo=dt.timezone.utc)
CONFIG = DueConfig()
RATES = {"kitchen": 1000.0, "hall": 480.0, "den": 90.0}
"""Grains/m2 a day."""


def day(number: float) -> dt.datetime:
    return BEGIN + dt.timedelta(days=number)


def found(grains: Mapping[str, float], share: float = 1.0) -> list[RoomDirt]:
    return [RoomDirt(name, share, value) for name, value in grains.items()]


def after_two_days() -> DirtRecords:
    """All rooms cleaned twice, a day between."""
    records = learned(DirtRecords(), found(dict.fromkeys(RATES, 5000.0)), day(0), CONFIG)
    return learned(records, found(RATES), day(1), CONFIG)


def needs(records: DirtRecords, at: float, period: float = 1.0) -> dict[str, RoomNeed]:
    found_needs = needs_of(records, tuple(RATES), day(at), period, CONFIG)
    return {need.room: need for need in found_needs}


def test_what_lay_there_from_long_ago_says_nothing_and_all_is_due_until_it_is_known() -> None:
    records = learned(DirtRecords(), found({"kitchen": 9000.0}), day(0), CONFIG)
    assert records.rooms["kitchen"].rate is None
    told = needs(records, 1)
    assert all(need.is_due and need.every is None for need in told.values())
    assert "not known" in told["hall"].reason


def test_the_dirtiest_room_is_cleaned_each_time_and_others_as_often_as_they_need_it() -> None:
    told = needs(after_two_days(), 2)
    assert {name: need.every for name, need in told.items()} == {"kitchen": 1, "hall": 2, "den": 7}
    assert [name for name, need in told.items() if need.is_due] == ["kitchen"]
    assert told["kitchen"].reason == "it becomes dirty the fastest"
    assert told["hall"].reason == "it becomes 0.48 times as dirty as kitchen"
    assert [name for name, need in needs(after_two_days(), 3).items() if need.is_due] == [
        "kitchen",
        "hall",
    ]
    assert needs(after_two_days(), 8)["den"].is_due


def test_no_room_gets_dirtier_than_the_dirtiest_one_does() -> None:
    records = after_two_days()
    dirt, worst = dict.fromkeys(RATES, 0.0), 0.0
    cleans = dict.fromkeys(RATES, 0)
    for number in range(2, 40):
        for name, rate in RATES.items():
            dirt[name] += rate
        worst = max(worst, *dirt.values())
        due = {name: dirt[name] for name, need in needs(records, number).items() if need.is_due}
        records = learned(records, found(due), day(number + 0.02), CONFIG)
        for name in due:
            dirt[name], cleans[name] = 0.0, cleans[name] + 1
    assert worst <= RATES["kitchen"] * (1.0 + CONFIG.spare)
    assert (cleans["kitchen"], cleans["hall"]) == (38, 19)
    assert cleans["den"] in (5, 6)


def test_a_change_is_learned_within_some_cleans() -> None:
    records = after_two_days()
    for number in range(2, 6):
        records = learned(records, found({"den": 2000.0}), day(number), CONFIG)
    told = needs(records, 7)
    assert told["den"].every == 1
    assert told["hall"].every == 4


def test_little_of_a_room_and_a_second_clean_at_once_tell_nothing() -> None:
    records = after_two_days()
    assert learned(records, found({"den": 7.0}, share=0.5), day(3), CONFIG) == records
    assert learned(records, found({"den": 7.0}), day(1.1), CONFIG) == records


def test_by_a_plan_of_every_other_day_rooms_need_it_at_fewer_of_its_times() -> None:
    assert needs(after_two_days(), 3, period=2.0)["den"].every == round(7.0 / 2.0)


def test_a_clock_that_is_set_back_leaves_nothing_dirty() -> None:
    assert all(need.is_due for need in needs(after_two_days(), -3).values())


def test_after_a_clock_that_was_ahead_it_is_learned_on() -> None:
    records = learned(after_two_days(), found({"den": 90.0}), day(3650), CONFIG)
    rate = records.rooms["den"].rate
    records = learned(records, found({"den": 9000.0}), day(3), CONFIG)
    assert (records.rooms["den"].cleaned, records.rooms["den"].rate) == (day(3), rate)
    assert not needs(records, 4)["den"].is_due
    again = learned(records, found({"den": 1000.0}), day(4), CONFIG).rooms["den"].rate
    assert again is not None
    assert again > 100.0


def test_nothing_is_learned_by_a_clock_that_is_not_set() -> None:
    records = after_two_days()
    never_set = dt.datetime(1970, 1, 1, tzinfo=dt.timezone.utc)
    assert learned(records, found({"den": 7.0, "attic": 7.0}), never_set, CONFIG) == records


@pytest.mark.parametrize("rate", [0.0, 1e-307, 1e-9])
def test_a_room_that_stays_clean_is_cleaned_once_a_week(rate: float) -> None:
    records = learned(DirtRecords(), found({"den": 5.0, "hall": 5.0}), day(0), CONFIG)
    records = learned(records, found({"den": rate, "hall": 100.0}), day(1), CONFIG)
    assert needs(records, 2)["den"].every == 7
    everywhere = learned(DirtRecords(), found({"den": 5.0}), day(0), CONFIG)
    everywhere = learned(everywhere, found({"den": rate}), day(1), CONFIG)
    (need,) = needs_of(everywhere, ("den",), day(2), 1.0, CONFIG)
    assert need.every in (1, 7)
