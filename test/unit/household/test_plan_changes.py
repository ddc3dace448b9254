"""A plan or preset takes the place of the one of its name, and is removed by its name."""

from __future__ import annotations

import pytest

from roomba.client.protocol import RequestRefusedError
from roomba.household.plan_changes import added, removed, replaced, with_orders_again
from roomba.plans.plan import HouseholdPlans, Plan, PlannedOrder, Preset
from roomba.vocabulary import CleanMode

PLANS = HouseholdPlans(plans=(Plan(name="a"), Plan(name="b")), presets=(Preset(name="a"),))


def test_the_one_of_the_same_name_is_replaced_in_its_place() -> None:
    changed = replaced(PLANS, "plans", "a", Plan(name="a", is_on=False))
    assert [(plan.name, plan.is_on) for plan in changed.plans] == [("a", False), ("b", True)]
    assert changed.presets == PLANS.presets


def test_another_one_is_added() -> None:
    changed = replaced(PLANS, "presets", "c", Preset(name="c"))
    assert [preset.name for preset in changed.presets] == ["a", "c"]


def test_a_new_one_takes_the_place_of_none() -> None:
    assert [plan.name for plan in added(PLANS, "plans", Plan(name="c")).plans] == ["a", "b", "c"]
    with pytest.raises(RequestRefusedError, match="that none of the plans has, got 'a'"):
        added(PLANS, "plans", Plan(name="a"))


def test_one_is_removed_and_what_there_is_not_is_refused() -> None:
    assert [plan.name for plan in removed(PLANS, "plans", "a").plans] == ["b"]
    with pytest.raises(RequestRefusedError, match="one of a, b, got 'c'"):
        removed(PLANS, "plans", "c")


def test_orders_that_did_not_change_since_are_given_back_and_others_go_on_by_names() -> None:
    def plans(*rooms: str) -> HouseholdPlans:
        named = zip("abc", rooms, strict=False)
        return HouseholdPlans(
            plans=tuple(
                Plan(name=name, order=PlannedOrder(mode=CleanMode.ROOMS, rooms=tuple(room)))
                for name, room in named
            )
        )

    before, after, now = plans("HK", "K"), plans("H", "H"), plans("H", "HX", "X")
    again = with_orders_again(after, before, {"X": "Y"})(now)
    assert ["".join(plan.order.rooms) for plan in again.plans] == ["HK", "HY", "Y"]
