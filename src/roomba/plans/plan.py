"""What is planned, as a person enters it: plans, presets, quiet hours. Values, validated."""

from __future__ import annotations

import datetime as dt
import reprlib
import zoneinfo
from collections.abc import Mapping
from enum import Enum
from typing import Annotated, Any, Final

from pydantic import (
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    field_validator,
    model_validator,
)

from roomba.clean_request import CleanRequest
from roomba.configuration.frozen import Frozen
from roomba.plans.days import require_days
from roomba.vocabulary import (
    LONGEST_NAME,
    MOST_PASSES,
    MOST_ZONES,
    CarpetWay,
    CleanMode,
    EdgeOrder,
    FanLevel,
    checked_name,
)

MOST_PLANS: Final = 50
"""Plans, and presets, of a household."""
MOST_TIMES: Final = 12
"""Times of a plan on one day."""
MOST_QUIET: Final = 14
"""Quiet hours."""
_LONGEST_RULE: Final = 200
"""Characters."""
PLANNED_MODES: Final = (CleanMode.WHOLE, CleanMode.ROOMS, CleanMode.EDGES, CleanMode.DIRTIEST)
"""What can be planned: zones and spots are for now."""

Name = Annotated[str, Field(min_length=1, max_length=LONGEST_NAME)]
Weekday = Annotated[int, Field(ge=0, le=6)]
"""0 is Monday."""


def _to_the_minute(value: Any, parsed: ValidatorFunctionWrapHandler) -> dt.time:
    try:
        time: dt.time | None = parsed(value)
    except ValidationError:
        time = None
    if time is None or time.tzinfo is not None:
        raise ValueError(
            f"expected a time of the clock on the wall such as 09:30, got {reprlib.repr(value)}"
        )
    return time.replace(second=0, microsecond=0)


WallTime = Annotated[dt.time, WrapValidator(_to_the_minute)]
"""A time of the clock on the wall, to the minute."""


class PlannedOrder(Frozen):
    """What is cleaned, and how."""

    mode: CleanMode = CleanMode.WHOLE
    rooms: tuple[Name, ...] = Field(default=(), max_length=MOST_ZONES)
    """In this order; for ROOMS alone."""
    passes: int = Field(default=1, ge=1, le=MOST_PASSES)
    fan: FanLevel = FanLevel.STANDARD
    carpets: CarpetWay = CarpetWay.BOOST
    edges: EdgeOrder = EdgeOrder.ANY
    only_due: bool = False
    """Whether of all rooms, or of these, only those are cleaned that are due by their dirt."""

    @model_validator(mode="after")
    def _rooms_for_rooms(self) -> PlannedOrder:
        if self.mode not in PLANNED_MODES:
            modes = ", ".join(mode.value for mode in PLANNED_MODES)
            raise ValueError(f"expected one of {modes}, got {self.mode.value}")
        if self.mode is CleanMode.ROOMS and not self.rooms:
            raise ValueError("expected a room at least, got none")
        if self.rooms and self.mode is not CleanMode.ROOMS:
            raise ValueError(f"expected rooms for the mode rooms alone, got {self.mode.value}")
        if self.only_due and self.mode not in (CleanMode.WHOLE, CleanMode.ROOMS):
            raise ValueError("expected all floor or rooms, of which those that are due are cleaned")
        return self

    def request(self) -> CleanRequest:
        """Return what the robot is asked; raises CleanRefusedError for an invalid name."""
        return CleanRequest(
            self.mode,
            self.rooms,
            passes=self.passes,
            fan=self.fan,
            # What is due is cleaned by the shortest way.
            in_order=not self.only_due,
            carpets=self.carpets,
            edges=self.edges,
        )

    def with_room_names(self, names: Mapping[str, str]) -> PlannedOrder:
        """Return the order with other names of rooms, by the old ones; each room once."""
        rooms = tuple(dict.fromkeys(names.get(name, name) for name in self.rooms))
        return self if rooms == self.rooms else self.model_copy(update={"rooms": rooms})


class Named(Frozen):
    """What has a name by which it is replaced and removed."""

    name: str = Field(json_schema_extra={"minLength": 1, "maxLength": LONGEST_NAME})

    @field_validator("name")
    @classmethod
    def _is_readable(cls, name: str) -> str:
        return checked_name(name)


class Preset(Named):
    """An order with a name, begun by one tap."""

    order: PlannedOrder = PlannedOrder()


class Plan(Named):
    """An order at times of days: ``rule`` are the days (iCalendar, RFC 5545), ``at`` the times.

    Times are those of the clock on the wall, to the minute. ``begins`` is the first day that can
    count; of rules such as "every other week" it says which week.
    """

    is_on: bool = True
    begins: dt.date = dt.date(2026, 1, 1)
    rule: str = Field(default="FREQ=DAILY", max_length=_LONGEST_RULE)
    at: tuple[WallTime, ...] = Field(default=(dt.time(9, 0),), max_length=MOST_TIMES)
    order: PlannedOrder = PlannedOrder()

    @field_validator("at")
    @classmethod
    def _times_in_order(cls, at: tuple[dt.time, ...]) -> tuple[dt.time, ...]:
        if not at:
            raise ValueError("expected a time at least, got none")
        return tuple(sorted(set(at)))

    @model_validator(mode="after")
    def _has_days(self) -> Plan:
        require_days(self.rule, self.begins)
        return self


class QuietHours(Frozen):
    """When no clean begins by a plan: ``begins`` to ``ends``, over midnight if ``ends`` is less.

    ``days`` are those on which it begins.
    """

    begins: WallTime = dt.time(22, 0)
    ends: WallTime = dt.time(7, 0)
    days: tuple[Weekday, ...] = (0, 1, 2, 3, 4, 5, 6)

    @model_validator(mode="after")
    def _has_length(self) -> QuietHours:
        if self.begins == self.ends:
            raise ValueError("expected quiet hours that end at another time than they begin")
        return self


class Emptying(Enum):
    """When a station that is able to empties the robot's bin; in quiet hours never."""

    EACH_RUN = "after each run"
    FULL = "by level"
    """When it is full, or nearly so after a run."""
    NEVER = "never"


class HouseholdPlans(Frozen):
    """All that is planned; ``zone`` is the time zone by its name of the IANA."""

    zone: str = "UTC"
    plans: tuple[Plan, ...] = Field(default=(), max_length=MOST_PLANS)
    presets: tuple[Preset, ...] = Field(default=(), max_length=MOST_PLANS)
    quiet: tuple[QuietHours, ...] = Field(default=(), max_length=MOST_QUIET)
    waits_for_empty_home: bool = True
    """Whether plans wait, and what they began pauses, while a person is at home."""
    emptying: Emptying = Emptying.FULL
    is_person_home: bool = False
    """Whether a person is at home, as it was told last."""

    @field_validator("zone")
    @classmethod
    def _is_zone(cls, zone: str) -> str:
        spelled = zone if is_zone(zone) else _in_any_case(zone)
        if spelled is None:
            raise ValueError(f"expected a time zone such as Europe/Berlin, got {zone[:40]!r}")
        return spelled

    @model_validator(mode="after")
    def _names_once(self) -> HouseholdPlans:
        for named in (self.plans, self.presets):
            names = [each.name for each in named]
            if len(set(names)) < len(names):
                raise ValueError(f"expected each name once, got {', '.join(names)}")
        return self

    def with_room_names(self, names: Mapping[str, str]) -> HouseholdPlans:
        """Return the plans and presets with other names of rooms, by the old ones."""
        update = {
            kind: tuple(
                each.model_copy(update={"order": each.order.with_room_names(names)})
                for each in getattr(self, kind)
            )
            for kind in ("plans", "presets")
        }
        return self.model_copy(update=update)

    @property
    def clock(self) -> zoneinfo.ZoneInfo:
        """The time zone."""
        return zoneinfo.ZoneInfo(self.zone)


def is_zone(name: str) -> bool:
    """Whether a name is that of a time zone."""
    try:
        zoneinfo.ZoneInfo(name)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        return False
    return True


def _in_any_case(name: str) -> str | None:
    """Return the time zone that is called so but for small and capital letters."""
    zones = {zone.casefold(): zone for zone in zoneinfo.available_timezones()}
    return zones.get(name.casefold())
