"""Changes of what is planned: each takes the plans as they are, and returns others."""

from __future__ import annotations

from collections.abc import Callable

from roomba.client.protocol import RequestRefusedError
from roomba.plans.plan import HouseholdPlans, Plan, Preset
from roomba.vocabulary import listed

Change = Callable[[HouseholdPlans], HouseholdPlans]


def replaced(
    household: HouseholdPlans, kind: str, name: str, value: Plan | Preset
) -> HouseholdPlans:
    """Return the household with a plan or preset (``kind`` is plans or presets) in its place."""
    names = [each.name for each in getattr(household, kind)]
    values = list(getattr(household, kind))
    if name in names:
        values[names.index(name)] = value
    else:
        values.append(value)
    return household.model_copy(update={kind: tuple(values)})


def removed(household: HouseholdPlans, kind: str, name: str) -> HouseholdPlans:
    """Return the household without a plan or preset; raises RequestRefusedError without one."""
    values = getattr(household, kind)
    if name not in [each.name for each in values]:
        names = listed([each.name for each in values])
        raise RequestRefusedError(f"expected one of {names}, got {name[:80]!r}")
    return household.model_copy(update={kind: tuple(each for each in values if each.name != name)})
