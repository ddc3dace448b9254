"""Rooms are kept as they were seen, and an edit that was taken back is recognized."""

from __future__ import annotations

from pathlib import Path

from roomba.client.view import RoomView
from roomba.household.folder import KeptValues
from roomba.household.seen_rooms import RoomsEdit, SeenRooms, seen
from roomba.plans.plan import HouseholdPlans, Plan

RING = ((0.1, 0.2), (1.3, 0.2), (1.3, 2.7), (0.1, 2.7), (0.1, 0.2))
ROOMS = (RoomView("Küche", 3.0, (0.7, 1.4), (RING,), "tile"),)


def test_rooms_come_back_as_they_were_seen(tmp_path: Path) -> None:
    kept = KeptValues(tmp_path / "rooms.json", print)
    kept.write(SeenRooms(rooms=seen(ROOMS)))
    found = kept.read(SeenRooms())
    assert found.rooms == seen(ROOMS)
    [view] = found.views
    assert (view.name, view.anchor, view.rings) == ("Küche", (0.7, 1.4), (RING,))


def test_an_edit_that_changed_plans_is_undone_by_the_rooms_before_it() -> None:
    plans = HouseholdPlans(plans=(Plan(name="daily"),))
    edit = RoomsEdit(rooms=seen(ROOMS), plans_before=plans, plans_after=HouseholdPlans())
    assert edit.is_undone_by(seen(ROOMS))
    assert not edit.is_undone_by(())
    assert not RoomsEdit(rooms=seen(ROOMS)).is_undone_by(seen(ROOMS))
