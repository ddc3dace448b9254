"""What an owner sees and changes of a robot from day to day: its upkeep and its plans."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime, tzinfo
from typing import Any, Final, Protocol

from roomba.plans.due import RoomNeed
from roomba.plans.memory import Note
from roomba.plans.plan import Emptying, HouseholdPlans, Plan, Preset, QuietHours
from roomba.upkeep.parts import Part, PartState

_BAG_DUE: Final = "put an empty bag into the station"


@dataclass(frozen=True, slots=True)
class TotalsView:
    """Sums over all runs that were kept: m2, s of the robot's clock, m, g, Wh."""

    runs: int = 0
    covered: float = 0.0
    duration: float = 0.0
    distance: float = 0.0
    dirt: float = 0.0
    energy: float = 0.0


@dataclass(frozen=True, slots=True)
class UpkeepView:
    """How the parts that wear are, and what the robot did in all.

    ``bag`` is how full that of its station is, 0..1; NaN without one.
    """

    parts: tuple[PartState, ...]
    totals: TotalsView
    bag: float = math.nan
    is_bag_due: bool = False

    @property
    def reminders(self) -> tuple[str, ...]:
        """What is to be done now or soon, a few words each."""
        advice = tuple(state.advice for state in self.parts if state.advice)
        return (*advice, _BAG_DUE) if self.is_bag_due else advice


@dataclass(frozen=True, slots=True)
class PlanView:
    """How a plan stands: its ``next`` time, and a time that was ``due`` and waits, with the reason.

    Moments are aware of their zone, None where there is none.
    """

    name: str
    next: datetime | None
    due: datetime | None
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class PlansView:
    """The plans, and what comes of them; ``version`` grows by one with each change.

    ``running`` is the plan whose clean is under way, ``is_held`` whether it is paused for a person
    at home; ``next`` is the plan that comes next, at ``next_at``. ``notes`` are what became of
    plans, the newest last. ``needs`` are how often rooms are to be cleaned, if a plan goes by that.
    """

    version: int = 0
    household: HouseholdPlans = field(default_factory=HouseholdPlans)
    plans: tuple[PlanView, ...] = ()
    running: str = ""
    is_held: bool = False
    next: str = ""
    next_at: datetime | None = None
    notes: tuple[Note, ...] = ()
    needs: tuple[RoomNeed, ...] = ()


class Household(Protocol):
    """A robot in its household. The methods may be called from any thread.

    Changes raise RequestRefusedError with the reason; a change that returned is on the disk.
    """

    def upkeep(self) -> UpkeepView:
        """Return how the parts are, and the totals."""

    def reset_part(self, part: Part) -> None:
        """Let a part count as new, clean or empty; the robot is told of an empty bin, too."""

    def plans(self) -> PlansView:
        """Return the plans, and what comes of them."""

    def put_plan(self, plan: Plan, *, is_new: bool = False) -> None:
        """Add a plan, or replace the one of the same name; its times count from now on.

        A plan that ``is_new`` replaces none: it is refused if there is one of its name. Its rooms
        must be on the present map; a plan that is off may name any.
        """

    def remove_plan(self, name: str) -> None:
        """Remove a plan; a clean that it began goes on."""

    def put_preset(self, preset: Preset, *, is_new: bool = False) -> None:
        """Add a preset, or replace the one of the same name; its rooms must be on the present map.

        A preset that ``is_new`` replaces none: it is refused if there is one of its name.
        """

    def remove_preset(self, name: str) -> None:
        """Remove a preset."""

    def begin_preset(self, name: str) -> None:
        """Begin the clean of a preset now; also raises RobotUnavailableError."""

    def set_quiet(self, quiet: Sequence[QuietHours]) -> None:
        """Replace all quiet hours."""

    def set_emptying(self, when: Emptying) -> None:
        """Set when a station that is able to empties the bin; in quiet hours it never does."""

    def set_zone(self, zone: str) -> None:
        """Set the time zone, by its name of the IANA."""

    def set_waits_for_empty_home(self, *, is_wanted: bool) -> None:
        """Set whether plans wait while a person is at home."""

    def set_person_home(self, *, is_home: bool) -> None:
        """Tell whether a person is at home."""


def upkeep_of(view: UpkeepView) -> dict[str, Any]:
    """Return the upkeep as plain values for JSON: h of work, shares 0..1, totals in SI and Wh."""
    totals = view.totals
    return {
        "parts": [
            {
                "name": state.part.value,
                "life": round(state.life, 2),
                "left": round(state.left, 2),
                "share": round(state.share, 4),
                "is_due": state.is_due,
                "advice": state.advice,
            }
            for state in view.parts
        ],
        "reminders": list(view.reminders),
        "bag": None if math.isnan(view.bag) else round(view.bag, 4),
        "totals": {
            name: value if name == "runs" else round(value, 2)
            for name, value in ((name, getattr(totals, name)) for name in totals.__slots__)
        },
    }


def told_of(household: Household | None) -> dict[str, Any]:
    """Return what the robot's state tells of its household; nothing without one."""
    if household is None:
        return {}
    plans = household.plans()
    zone = plans.household.clock
    return {
        "upkeep": upkeep_of(household.upkeep()),
        "plans": {
            "version": plans.version,
            "emptying": plans.household.emptying.value,
            "next": plans.next,
            "next_at": _moment(plans.next_at, zone),
            "running": plans.running,
            "is_held": plans.is_held,
            "waiting": [
                {
                    "plan": plan.name,
                    "due": _moment(plan.due, zone),
                    "reason": plan.reason,
                }
                for plan in plans.plans
                if plan.due is not None
            ],
        },
    }


def plans_of(view: PlansView) -> dict[str, Any]:
    """Return the plans as plain values for JSON; moments in the household's zone, ISO 8601."""
    values = view.household.model_dump(mode="json")
    zone = view.household.clock
    beside = {plan.name: plan for plan in view.plans}
    for plan in values["plans"]:
        told = beside[plan["name"]]
        plan["next"] = _moment(told.next, zone)
        plan["due"] = _moment(told.due, zone)
        plan["reason"] = told.reason
    notes = [
        {"at": _moment(note.at, zone), "plan": note.plan, "text": note.text}
        for note in reversed(view.notes)
    ]
    needs = [{"room": need.room, "every": need.every, "reason": need.reason} for need in view.needs]
    return {**values, "version": view.version, "notes": notes, "needs": needs}


def _moment(moment: datetime | None, zone: tzinfo) -> str | None:
    return None if moment is None else moment.astimezone(zone).isoformat(timespec="seconds")
