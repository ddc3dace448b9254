"""How rooms are called after an edit of them, so that plans which name them go on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import shapely

from roomba.client.protocol import RequestRefusedError
from roomba.client.view import RoomView
from roomba.plans.plan import PlannedOrder
from roomba.vocabulary import listed

_SAME_AREA: Final = 0.05
"""Share by which the areas of parts may differ from that of the whole: cells of seams."""


def names_now(before: Sequence[RoomView], after: Sequence[RoomView]) -> dict[str, str]:
    """Return, by the names that are gone, what their rooms are called now.

    A room with the outline of a room before was renamed. A room was joined of several if they lie
    in it, are together as large, and one of them has its name. Where a room was split and its name
    is gone, its largest part stands for it. For another map, or for rooms that were found anew,
    nothing is returned.
    """
    changed = [room for room in before if _has_outline(room) and not _is_in(room, after)]
    new = [room for room in after if _has_outline(room) and not _is_in(room, before)]
    renamed = {room.rings: room.name for room in new}
    names = {}
    for room in changed:
        now = renamed.get(room.rings) or _joined_into(room, changed, new) or _part_of(room, new)
        if now and now != room.name:
            names[room.name] = now
    return names


def _joined_into(room: RoomView, changed: Sequence[RoomView], new: Sequence[RoomView]) -> str:
    """Return the name of the room of which a room is a part now; "" if it is of none."""
    for whole in new:
        parts = [each for each in changed if _holds(whole, each)]
        is_named = whole.name in [part.name for part in parts]
        if len(parts) > 1 and room in parts and is_named and _is_all_of(whole, parts):
            return whole.name
    return ""


def _part_of(room: RoomView, new: Sequence[RoomView]) -> str:
    """Return the name of the largest part of a room that was split; "" if it was not.

    If a part has the name, plans that name the room go on with that.
    """
    parts = [each for each in new if _holds(room, each)]
    if len(parts) < 2 or not _is_all_of(room, parts):
        return ""
    if room.name in [part.name for part in parts]:
        return room.name
    return max(parts, key=lambda part: part.area).name


def _is_all_of(whole: RoomView, parts: Sequence[RoomView]) -> bool:
    return abs(sum(part.area for part in parts) - whole.area) <= _SAME_AREA * whole.area


def require_rooms(order: PlannedOrder, rooms: Sequence[RoomView]) -> None:
    """Raise RequestRefusedError for rooms that the map does not have, if it has any."""
    names = [room.name for room in rooms]
    missing = [name for name in order.rooms if name not in names]
    if names and missing:
        raise RequestRefusedError(
            f"expected rooms of the map, of {listed(names)}; got {missing[0][:80]!r}"
        )


def _has_outline(room: RoomView) -> bool:
    """Whether it has an outline: closed rings, so with three corners and the first one again."""
    return bool(room.rings) and all(len(ring) > 3 for ring in room.rings)


def _is_in(room: RoomView, rooms: Sequence[RoomView]) -> bool:
    return any((each.name, each.rings) == (room.name, room.rings) for each in rooms)


def _holds(room: RoomView, part: RoomView) -> bool:
    """Whether the anchor of ``part`` lies in ``room``."""
    outline = shapely.Polygon(room.rings[0], room.rings[1:])
    return bool(shapely.contains_xy(outline, *part.anchor))
