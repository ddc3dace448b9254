"""The rooms as the household saw them last, kept: an edit is followed whenever it is seen."""

from __future__ import annotations

from collections.abc import Sequence

from roomba.client.view import RoomView
from roomba.configuration.frozen import Frozen
from roomba.geometry import Point
from roomba.plans.due import DirtRecords
from roomba.plans.plan import HouseholdPlans


class SeenRoom(Frozen):
    """A room as :class:`roomba.client.view.RoomView` has it; m, m2."""

    name: str
    area: float
    anchor: Point
    rings: tuple[tuple[Point, ...], ...]


class RoomsEdit(Frozen):
    """An edit of rooms that plans followed: ``rooms`` before it, and the plans before and after."""

    rooms: tuple[SeenRoom, ...] = ()
    plans_before: HouseholdPlans = HouseholdPlans()
    plans_after: HouseholdPlans = HouseholdPlans()

    def is_undone_by(self, rooms: Sequence[SeenRoom]) -> bool:
        """Whether ``rooms`` are as before the edit again, and the edit changed plans."""
        return self.rooms == rooms and self.plans_before != self.plans_after


class SeenRooms(Frozen):
    """Rooms, and the newest edit of them.

    While the edit ``is_pending``, not all that goes by the rooms' names was changed by it: plans
    are to become as in ``edit``, and what is learned of dirt as in ``dirt``, for the reason
    ``why``. To do that again, after a refused write or a kill, gives the same.
    """

    rooms: tuple[SeenRoom, ...] = ()
    edit: RoomsEdit = RoomsEdit()
    is_pending: bool = False
    dirt: DirtRecords = DirtRecords()
    why: str = ""

    @property
    def views(self) -> tuple[RoomView, ...]:
        """The rooms, as clients see them."""
        return tuple(RoomView(each.name, each.area, each.anchor, each.rings) for each in self.rooms)


def seen(rooms: Sequence[RoomView]) -> tuple[SeenRoom, ...]:
    """Return rooms as they are kept."""
    return tuple(
        SeenRoom(name=each.name, area=each.area, anchor=each.anchor, rings=each.rings)
        for each in rooms
    )
