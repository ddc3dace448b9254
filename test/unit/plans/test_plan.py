"""What a person enters is taken, or refused with what was expected."""

from __future__ import annotations

import datetime as dt
from dataclasses import replace
from typing import Any

import pytest
from pydantic import ValidationError

from roomba.clean_request import CleanRequest
from roomba.plans.plan import HouseholdPlans, Plan, PlannedOrder, Preset, QuietHours
from roomba.vocabulary import CarpetWay, CleanMode, FanLevel


def test_a_plan_comes_back_as_it_was_written() -> None:
    order = PlannedOrder(mode=CleanMode.ROOMS, rooms=("kitchen",), passes=2, fan=FanLevel.QUIET)
    plan = Plan(name="kitchen", rule="FREQ=WEEKLY;BYDAY=MO", at=(dt.time(9, 30),), order=order)
    whole = HouseholdPlans(
        zone="Europe/Berlin",
        plans=(plan,),
        presets=(Preset(name="kitchen", order=order),),
        quiet=(QuietHours(),),
    )
    assert HouseholdPlans.model_validate(whole.model_dump(mode="json")) == whole


def test_a_plan_asks_for_its_rooms_in_order_and_for_those_due_by_the_shortest_way() -> None:
    order = PlannedOrder(mode=CleanMode.ROOMS, rooms=("den", "hall"), carpets=CarpetWay.AVOID)
    asked = CleanRequest(CleanMode.ROOMS, ("den", "hall"), in_order=True, carpets=CarpetWay.AVOID)
    assert order.request() == asked
    due = order.model_copy(update={"only_due": True})
    assert due.request() == replace(asked, in_order=False)


def test_times_are_in_order_once_and_to_the_minute() -> None:
    plan = Plan(name="x", at=("18:00", "09:30:20", "09:30"))  # type: ignore[arg-type]
    assert plan.at == (dt.time(9, 30), dt.time(18, 0))


def test_a_time_zone_is_found_in_any_case() -> None:
    for name in ("europe/berlin", "EUROPE/BERLIN", "Europe/Berlin"):
        assert HouseholdPlans(zone=name).zone == "Europe/Berlin"


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"plans": [{"name": " "}]}, "printable"),
        ({"plans": [{"name": "x", "at": []}]}, "expected a time at least"),
        ({"plans": [{"name": "x", "at": ["25:00"]}]}, "such as 09:30, got '25:00'"),
        ({"plans": [{"name": "x", "at": ["09:00+02:00"]}]}, "on the wall"),
        ({"plans": [{"name": "x", "rule": "FREQ=MINUTELY"}]}, "FREQ to be one of"),
        ({"plans": [{"name": "x", "order": {"mode": "rooms"}}]}, "a room at least"),
        ({"plans": [{"name": "x", "order": {"rooms": ["a"]}}]}, "rooms for the mode rooms"),
        ({"plans": [{"name": "x", "order": {"mode": "spot"}}]}, "got spot"),
        ({"plans": [{"name": "x", "order": {"passes": 99}}]}, "less than or equal to 5"),
        ({"plans": [{"name": "x"}, {"name": "x"}]}, "each name once"),
        ({"presets": [{"name": "x"}] * 60}, "at most 50 items"),
        ({"quiet": [{"begins": "09:00", "ends": "09:00:30"}]}, "another time"),
        ({"quiet": [{"begins": ""}]}, "such as 09:30, got ''"),
        ({"quiet": [{"days": [7]}]}, "less than or equal to 6"),
        ({"zone": "Mars/Olympus"}, "got 'Mars/Olympus'"),
        ({"zone": "../../etc/passwd"}, "Europe/Berlin"),
        ({"colour": "red"}, "not permitted"),
    ],
)
def test_what_makes_no_sense_is_refused(wrong: dict[str, Any], said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        HouseholdPlans.model_validate(wrong)
