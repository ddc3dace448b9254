"""Changes of what is planned: each takes the plans as they are, and returns others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

from roomba.client.protocol import RequestRefusedError
from roomba.plans.plan import HouseholdPlans, Plan, Preset
from roomba.vocabulary import listed

Change = Callable[[HouseholdPlans], HouseholdPlans]
_Ordered = TypeVar("_Ordered", Plan, Preset)


def replaced(
    household: HouseholdPlans, kind: str, name: str, value: Plan | Preset
) -> HouseholdPlans:
    """Return the household with ``value`` in place of the one called ``name``, or added.

    ``kind`` is plans or presets.
    """
    names = [each.name for each in getattr(household, kind)]
    values = list(getattr(household, kind))
    if name in names:
        values[names.index(name)] = value
    else:
        values.append(value)
    return household.model_copy(update={kind: tuple(values)})


def added(household: HouseholdPlans, kind: str, value: Plan | Preset) -> HouseholdPlans:
    """Return the household with another plan or preset; refuses a name that there is already."""
    if value.name in [each.name for each in getattr(household, kind)]:
        raise RequestRefusedError(
            f"expected a name that none of the {kind} has, got {value.name!r}: give it another one"
        )
    return replaced(household, kind, value.name, value)


def removed(household: HouseholdPlans, kind: str, name: str) -> HouseholdPlans:
    """Return the household without a plan or preset; raises RequestRefusedError without one."""
    values = getattr(household, kind)
    if name not in [each.name for each in values]:
        names = listed([each.name for each in values])
        raise RequestRefusedError(f"expected one of {names}, got {name[:80]!r}")
    return household.model_copy(update={kind: tuple(each for each in values if each.name != name)})


def with_orders_again(
    after: HouseholdPlans, before: HouseholdPlans, names: Mapping[str, str]
) -> Change:
    """Return a change that gives plans and presets the orders that they had ``before``.

    A plan or preset whose order is not that of ``after`` any more keeps its order, with the rooms'
    new names of ``names``.
    """

    def change(plans: HouseholdPlans) -> HouseholdPlans:
        return plans.model_copy(
            update={
                "plans": _again(plans.plans, after.plans, before.plans, names),
                "presets": _again(plans.presets, after.presets, before.presets, names),
            }
        )

    return change


def _again(
    now: Sequence[_Ordered],
    after: Sequence[_Ordered],
    before: Sequence[_Ordered],
    names: Mapping[str, str],
) -> tuple[_Ordered, ...]:
    was = {each.name: each.order for each in after}
    orders = {each.name: each.order for each in before}
    return tuple(
        each.model_copy(
            update={
                "order": orders[each.name]
                if each.name in orders and each.order == was.get(each.name)
                else each.order.with_room_names(names)
            }
        )
        for each in now
    )
