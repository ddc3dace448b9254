"""How rooms are called after an edit of them, so that plans which name them go on."""

from __future__ import annotations

from collections.abc import Sequence

import shapely

from roomba.client.protocol import RequestRefusedError
from roomba.client.view import RoomView
from roomba.plans.plan import PlannedOrder
from roomba.vocabulary import listed


def names_now(before: Sequence[RoomView], after: Sequence[RoomView]) -> dict[str, str]:
    """Return the names that are gone, and what their rooms are called now.

    A room that lies where one lay before was renamed; rooms that lie in one that is larger now were
    joined, if nothing else changed. Of another map, or of rooms found anew, nothing is returned.
    """
    gone = [room for room in before if not _is_in(room, after)]
    new = [room for room in after if not _is_in(room, before)]
    renamed = {room.rings: room.name for room in new}
    if gone and all(room.rings in renamed for room in gone):
        names = {room.name: renamed[room.rings] for room in gone}
    elif len(new) == 1 and len(gone) > 1 and all(_holds(new[0], room) for room in gone):
        names = {room.name: new[0].name for room in gone}
    else:
        return {}
    return {name: now for name, now in names.items() if name != now}


def require_rooms(order: PlannedOrder, rooms: Sequence[RoomView]) -> None:
    """Raise RequestRefusedError for rooms that the map does not have, if it has any."""
    names = [room.name for room in rooms]
    missing = [name for name in order.rooms if name not in names]
    if names and missing:
        raise RequestRefusedError(
            f"expected rooms of the map, of {listed(names)}; got {missing[0][:80]!r}"
        )


def _is_in(room: RoomView, rooms: Sequence[RoomView]) -> bool:
    return any((each.name, each.rings) == (room.name, room.rings) for each in rooms)


def _holds(room: RoomView, part: RoomView) -> bool:
    """Whether a point of another room lies in a room."""
    outline = shapely.Polygon(room.rings[0], room.rings[1:]) if room.rings else shapely.Polygon()
    return bool(shapely.contains_xy(outline, *part.anchor))
