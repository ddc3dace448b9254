"""The rooms that a clean under way has still to do: told, and changed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from roomba.arrays import Mask
from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.mission.cleaning.stages import Stage
from roomba.perception.rooms.rooms import Rooms
from roomba.vocabulary import CleanMode, RoomWay


def queue_of(request: CleanRequest, left: Sequence[Stage]) -> tuple[str, ...]:
    """Return the rooms of the stages that are left, in their order; the first is under way."""
    if request.mode is not CleanMode.ROOMS:
        return ()
    return tuple(dict.fromkeys(stage.name for stage in left if stage.name in request.rooms))


def changed_request(
    request: CleanRequest, done: Collection[str], names: Sequence[str], each: Sequence[RoomWay]
) -> CleanRequest:
    """Return the request changed so that, beside rooms that are ``done``, it cleans ``names``.

    ``each`` is how each of ``names`` is cleaned. Without it, rooms of the request stay as they
    were, and new ones are cleaned as the request says for all. Raises CleanRefusedError.
    """
    if request.mode is not CleanMode.ROOMS:
        raise CleanRefusedError(
            f"expected a clean of rooms under way, got one of mode {request.mode.value}: its rooms "
            "cannot be changed"
        )
    if not names:
        raise CleanRefusedError("expected rooms to go on with, got none; dock ends the clean")
    twice = [name for name, times in Counter(names).items() if times > 1]
    if twice:
        raise CleanRefusedError(f"expected each room once, got {twice[0]!r} more often")
    if each and len(each) != len(names):
        raise CleanRefusedError(
            f"expected a way to clean for each of the {len(names)} rooms, or none; got {len(each)}"
        )
    given = dict(zip(names, each, strict=True)) if each else {}
    rooms = tuple(dict.fromkeys((*(name for name in request.rooms if name in done), *names)))
    ways = tuple(given.get(name, request.way_of(name)) for name in rooms)
    is_alike = all(way == RoomWay(request.passes, request.fan) for way in ways)
    return replace(request, rooms=rooms, each=() if is_alike else ways, in_order=True)


def changed_stages(
    before: CleanRequest,
    request: CleanRequest,
    names: Sequence[str],
    stages: Sequence[Stage],
    number: int,
    swept: Mask,
    parts_of: Callable[[str], Sequence[Stage]],
) -> tuple[list[Stage], int]:
    """Return the stages with other rooms from the present stage on, and the present one's number.

    ``before`` is the request of the ``stages``, of which ``number`` is under way, and ``request``
    the changed one; ``parts_of`` tells the parts in which one pass over a room is swept. Of a
    present room that is not wanted any more, what was ``swept`` of it stays as a stage. Each room
    has its first pass before any has its second.
    """
    done, present, later = list(stages[:number]), stages[number], stages[number + 1 :]
    finished = Counter(stage.name for stage in done)
    others = [stage for stage in (present, *later) if stage.name not in before.rooms]
    if present.name not in names and present not in others:
        # Without a name: should it be wanted again, only the rest of it is swept.
        done.append(Stage("", present.floor & swept))
    left = {
        name: _passes_left(parts_of(name), request.way_of(name).passes, finished[name])
        for name in names
    }
    if present.name in left:
        left[present.name][0][0] = present
    most = max(len(passes) for passes in left.values())
    new = [
        part
        for number_of_pass in range(most)
        for passes in left.values()
        if number_of_pass < len(passes)
        for part in passes[number_of_pass]
    ]
    return [*done, *new, *others], len(done)


def renamed_rooms(before: Rooms | None, after: Rooms | None) -> dict[str, str]:
    """Return the new names, by old ones, of rooms whose cells did not change.

    A room that keeps its name is left out, and so is one that gained or lost cells.
    """
    if before is None or after is None or before.frame != after.frame:
        return {}
    names = {}
    for label, name in enumerate(before.names, 1):
        cells = before.labels == label
        now = int(after.labels[cells][0])
        if name not in after.names and now and np.array_equal(after.labels == now, cells):
            names[name] = after.names[now - 1]
    return names


def with_renamed(request: CleanRequest, names: Mapping[str, str]) -> CleanRequest:
    """Return the request with new names of rooms, by their old ones."""
    return replace(request, rooms=tuple(names.get(name, name) for name in request.rooms))


def _passes_left(parts: Sequence[Stage], passes: int, finished: int) -> list[list[Stage]]:
    """Return the passes over a room that are left, each as its parts.

    ``finished`` counts the parts, of all passes, that are done. When all are done, all are left:
    the room is wanted once more.
    """
    begun, first = divmod(finished % (passes * len(parts)), len(parts))
    is_swept = finished >= len(parts)
    left = [[Stage(part.name, part.floor, again=is_swept) for part in parts[first:]]]
    for _ in range(begun + 1, passes):
        left.append([Stage(part.name, part.floor, again=True) for part in parts])
    return left
