"""The household over HTTP: upkeep and plans, and what is changed of them."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Header
from pydantic import Field

from roomba.client.household import Household, plans_of, upkeep_of
from roomba.plans.plan import MOST_QUIET, Emptying, Plan, Preset, QuietHours
from roomba.ui.web.routes.api import obeyed
from roomba.ui.web.routes.wishes import Answer, Wish
from roomba.upkeep.parts import Part
from roomba.vocabulary import LONGEST_NAME

OnlyNew = Annotated[
    Literal["*"] | None,
    Header(alias="If-None-Match", description="Refuse to replace the one of the same name"),
]


class PartWish(Wish):
    """A part that was replaced, cleaned or emptied."""

    part: Part


class QuietWish(Wish):
    """All quiet hours."""

    quiet: list[QuietHours] = Field(max_length=MOST_QUIET)


class ZoneNameWish(Wish):
    """A time zone by its name of the IANA."""

    zone: str = Field(max_length=LONGEST_NAME, examples=["Europe/Berlin"])


class WaitsWish(Wish):
    """Whether plans wait while a person is at home."""

    wanted: bool


class PresenceWish(Wish):
    """Whether a person is at home."""

    at_home: bool


class EmptyingWish(Wish):
    """When a station that can empties the bin."""

    when: Emptying


def household_api(household: Household) -> APIRouter:
    """Return the routes of a household."""
    api = APIRouter(prefix="/api/v1")

    @api.get("/upkeep", summary="Hours that parts have left, and totals")
    def upkeep() -> dict[str, Any]:
        return upkeep_of(household.upkeep())

    @api.post("/upkeep/reset", summary="A part was replaced, cleaned or emptied")
    def reset(wish: PartWish) -> Answer:
        return obeyed(lambda: household.reset_part(wish.part))

    _add_plans(api, household)
    return api


def _add_plans(api: APIRouter, household: Household) -> None:
    @api.get("/plans", summary="Plans, presets, quiet hours, what comes next and what became")
    def plans() -> dict[str, Any]:
        return plans_of(household.plans())

    @api.put("/plans", summary="Add a plan, or replace the one of the same name")
    def put_plan(plan: Plan, only_new: OnlyNew = None) -> Answer:
        return obeyed(lambda: household.put_plan(plan, is_new=only_new is not None))

    @api.delete("/plans/{name:path}", summary="Remove a plan")
    def remove_plan(name: str) -> Answer:
        return obeyed(lambda: household.remove_plan(name))

    @api.put("/presets", summary="Add a preset, or replace the one of the same name")
    def put_preset(preset: Preset, only_new: OnlyNew = None) -> Answer:
        return obeyed(lambda: household.put_preset(preset, is_new=only_new is not None))

    @api.delete("/presets/{name:path}", summary="Remove a preset")
    def remove_preset(name: str) -> Answer:
        return obeyed(lambda: household.remove_preset(name))

    @api.post("/presets/{name:path}/begin", summary="Begin the clean of a preset now")
    def begin_preset(name: str) -> Answer:
        return obeyed(lambda: household.begin_preset(name))

    @api.put("/household/quiet", summary="Replace all quiet hours")
    def set_quiet(wish: QuietWish) -> Answer:
        return obeyed(lambda: household.set_quiet(wish.quiet))

    @api.put("/household/zone", summary="Set the time zone")
    def set_zone(wish: ZoneNameWish) -> Answer:
        return obeyed(lambda: household.set_zone(wish.zone))

    @api.put("/household/emptying", summary="When a station that can empties the bin")
    def set_emptying(wish: EmptyingWish) -> Answer:
        return obeyed(lambda: household.set_emptying(wish.when))

    @api.put("/household/waits", summary="Whether plans wait while a person is at home")
    def set_waits(wish: WaitsWish) -> Answer:
        return obeyed(lambda: household.set_waits_for_empty_home(is_wanted=wish.wanted))

    @api.put("/household/presence", summary="Whether a person is at home")
    def set_presence(wish: PresenceWish) -> Answer:
        return obeyed(lambda: household.set_person_home(is_home=wish.at_home))
