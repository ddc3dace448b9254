"""The rooms and zones of a home as a person edits them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypeVar

from roomba.client.protocol import RequestRefusedError
from roomba.client.view import ZoneView, require_another_zone
from roomba.errors import RoombaError
from roomba.geometry import Point
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones

_Value = TypeVar("_Value")


@dataclass(frozen=True, slots=True, eq=False)
class FloorPlan:
    """Rooms, None while there are none yet, and zones; edits raise RequestRefusedError.

    ``before`` are the rooms before their newest edit, None if there was none.
    """

    rooms: Rooms | None
    zones: Zones = field(default_factory=Zones)
    before: Rooms | None = None

    def with_zone(self, zone: ZoneView) -> FloorPlan:
        """Return the plan with a zone more, or in place of the one of the same name."""
        require_another_zone(zone.name, self.zones.names)
        added = made(lambda: Zone(zone.name, ZoneKind(zone.kind), zone.points))
        return replace(self, zones=made(lambda: self.zones.with_zone(added)))

    def without_zone(self, name: str) -> FloorPlan:
        """Return the plan without a zone."""
        return replace(self, zones=made(lambda: self.zones.without(name)))

    def with_name(self, name: str, new_name: str) -> FloorPlan:
        """Return the plan with another name of a room."""
        return self._edited(lambda rooms: rooms.renamed(name, new_name))

    def with_joined(self, names: tuple[str, ...]) -> FloorPlan:
        """Return the plan with rooms that touch made one."""
        return self._edited(lambda rooms: rooms.joined(*names))

    def with_cut(self, name: str, start: Point, end: Point) -> FloorPlan:
        """Return the plan with a room cut along a line."""
        return self._edited(lambda rooms: rooms.split(name, start, end))

    def _edited(self, edit: Callable[[Rooms], Rooms]) -> FloorPlan:
        rooms = self.rooms
        if rooms is None:
            raise RequestRefusedError("there are no rooms yet: explore the home first")
        return replace(self, rooms=made(lambda: edit(rooms)), before=rooms)

    def as_before(self) -> FloorPlan:
        """Return the plan without the newest edit of its rooms."""
        if self.before is None:
            raise RequestRefusedError("expected an edit of the rooms to take back, there was none")
        return replace(self, rooms=self.before, before=None)


def made(make: Callable[[], _Value]) -> _Value:
    """Return what ``make`` returns; its errors become RequestRefusedError with the reason."""
    try:
        return make()
    except (RoombaError, ValueError, KeyError) as refusal:
        raise RequestRefusedError(str(refusal)) from refusal
