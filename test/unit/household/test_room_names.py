"""Plans go on by the rooms' names after an edit, and by none where the map is another one."""

from __future__ import annotations

from dataclasses import replace

import pytest

from roomba.client.protocol import RequestRefusedError
from roomba.client.view import RoomView
from roomba.household.room_names import names_now, require_rooms
from roomba.plans.plan import PlannedOrder
from roomba.vocabulary import CleanMode


def room(name: str, x0: float, x1: float) -> RoomView:
    """A room of 4 m from one x to another."""
    ring = ((x0, 0.0), (x1, 0.0), (x1, 4.0), (x0, 4.0), (x0, 0.0))
    return RoomView(name, 4.0 * (x1 - x0), (0.5 * (x0 + x1), 2.0), (ring,))


HALL, KITCHEN, DEN = room("hall", 0.0, 2.0), room("kitchen", 2.0, 5.0), room("den", 5.0, 9.0)
ROOMS = HALL, KITCHEN, DEN


def called(one: RoomView, name: str) -> RoomView:
    return replace(one, name=name)


def test_a_room_that_lies_as_before_was_renamed() -> None:
    renamed = HALL, called(KITCHEN, "Küche"), DEN
    assert names_now(ROOMS, renamed) == {"kitchen": "Küche"}
    assert names_now(renamed, ROOMS) == {"Küche": "kitchen"}
    both = called(HALL, "Flur"), called(KITCHEN, "Küche"), DEN
    assert names_now(ROOMS, both) == {"hall": "Flur", "kitchen": "Küche"}


def test_names_that_changed_places_are_followed() -> None:
    changed = called(HALL, "kitchen"), called(KITCHEN, "hall"), DEN
    assert names_now(ROOMS, changed) == {"hall": "kitchen", "kitchen": "hall"}


def test_joined_rooms_are_called_by_the_first_ones_name() -> None:
    assert names_now(ROOMS, (room("kitchen", 0.0, 5.0), DEN)) == {"hall": "kitchen"}
    one = (room("den", 0.0, 9.0),)
    assert names_now(ROOMS, one) == {"hall": "den", "kitchen": "den"}


def test_several_edits_at_once_are_followed() -> None:
    joined, spa = room("hall", 0.0, 5.0), called(DEN, "spa")
    assert names_now(ROOMS, (joined, spa)) == {"kitchen": "hall", "den": "spa"}
    parts = room("X", 5.0, 7.5), room("X 2", 7.5, 9.0)
    assert names_now(ROOMS, (called(HALL, "Flur"), KITCHEN, *parts)) == {"hall": "Flur", "den": "X"}


@pytest.mark.parametrize(
    "after",
    [
        ROOMS,
        (HALL, KITCHEN, room("den", 5.0, 7.0), room("den 2", 7.0, 9.0)),
        (),
        (room("room 1", 0.0, 5.1), room("room 2", 5.1, 9.0)),
        (room("hall", 20.0, 22.0), KITCHEN, DEN),
        (room("attic", -1.0, 12.0),),
        (room("hall", -1.0, 12.0),),
        (room("attic", 0.0, 9.0),),
    ],
    ids=[
        "the same",
        "split",
        "none",
        "found anew",
        "another map",
        "one large room",
        "one large room of a name of ours",
        "one as large as all, of another name",
    ],
)
def test_of_what_is_no_rename_nothing_is_made(after: tuple[RoomView, ...]) -> None:
    assert names_now(ROOMS, after) == {}
    assert names_now((), after) == {}


def test_an_order_names_rooms_of_the_map() -> None:
    def order(*rooms: str) -> PlannedOrder:
        return PlannedOrder(mode=CleanMode.ROOMS, rooms=rooms)

    require_rooms(order("den", "hall"), ROOMS)
    require_rooms(PlannedOrder(), ROOMS)
    require_rooms(order("attic"), ())
    with pytest.raises(RequestRefusedError, match="of hall, kitchen, den; got 'attic'"):
        require_rooms(order("den", "attic"), ROOMS)
