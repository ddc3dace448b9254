"""Edits of rooms: plans and what is learned of dirt go by rooms' names, and follow them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager

from roomba.client.observed import ObservedRobot
from roomba.client.protocol import RobotUnavailableError
from roomba.client.view import RoomView
from roomba.household.dirt_keeper import DirtKeeper
from roomba.household.folder import KeptValues
from roomba.household.plan_changes import Change, with_orders_again
from roomba.household.room_names import names_now
from roomba.household.seen_rooms import RoomsEdit, SeenRooms, seen
from roomba.plans.plan import HouseholdPlans
from roomba.vocabulary import listed

Changing = Callable[[Change, str], AbstractContextManager[None]]
"""Makes a context: it changes plans for a reason, and shows them at its end; raises OSError."""


class RoomsFollower:
    """Lets plans and dirt go by the rooms' names of the map as they are now.

    An edit is kept before anything is changed by it. So an edit that the disk refused, or in which
    the program was killed, is finished later.
    """

    def __init__(
        self,
        robot: ObservedRobot,
        kept: KeptValues,
        dirt: DirtKeeper,
        plans: Callable[[], HouseholdPlans],
        changing: Changing,
    ) -> None:
        """Read what was ``kept``; ``plans`` are those on the disk."""
        self._robot, self._kept, self._dirt = robot, kept, dirt
        self._plans, self._changing = plans, changing
        self._seen = kept.read(SeenRooms())
        self._looked_at: tuple[RoomView, ...] = ()

    def follow(self) -> None:
        """Follow edits since the last look; raises OSError, and then the next call tries again."""
        try:
            rooms = self._robot.home().rooms
        except RobotUnavailableError:
            return
        try:
            self._finish_edit()
            # A map that is being made has no rooms yet, and says nothing of another map's rooms.
            if not rooms or rooms == self._looked_at:
                return
            if seen(rooms) != self._seen.rooms:
                self._begin_edit(rooms)
                self._finish_edit()
            self._looked_at = rooms
        except ValueError:
            # Rooms with invalid numbers are not followed.
            return

    def _begin_edit(self, rooms: Sequence[RoomView]) -> None:
        """Keep what an edit means for plans and dirt, before these are changed; raises OSError."""
        last, known = self._seen, seen(rooms)
        names = names_now(last.views, rooms)
        before = self._plans()
        if last.edit.is_undone_by(known):
            again = with_orders_again(last.edit.plans_after, last.edit.plans_before, names)
            after, why = again(before), "has its rooms again: the newest edit was taken back"
        else:
            told = listed([f"{name!r} is {new!r}" for name, new in names.items()])
            after, why = before.with_room_names(names), f"goes on by other names of rooms: {told}"
        self._keep(
            SeenRooms(
                rooms=known,
                edit=RoomsEdit(rooms=last.rooms, plans_before=before, plans_after=after),
                is_pending=bool(names) or after != before,
                dirt=self._dirt.renamed(names, [room.name for room in last.rooms]),
                why=why,
            )
        )

    def _finish_edit(self) -> None:
        """Change plans and what is learned as a pending edit says; raises OSError."""
        pending = self._seen
        if not pending.is_pending:
            return
        edit = pending.edit
        change = with_orders_again(edit.plans_before, edit.plans_after, {})
        with self._changing(change, pending.why):
            self._dirt.keep(pending.dirt)
            self._keep(SeenRooms(rooms=pending.rooms, edit=edit))

    def _keep(self, rooms: SeenRooms) -> None:
        self._kept.write(rooms)
        self._seen = rooms
