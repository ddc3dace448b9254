"""The rooms that a clean under way has still to do: told, and changed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from roomba.mission.cleaning.request import CleanRefusedError, CleanRequest
from roomba.mission.cleaning.stages import Stage
from roomba.vocabulary import CleanMode, RoomWay

Mask = NDArray[np.bool_]


def queue_of(request: CleanRequest, left: Sequence[Stage]) -> tuple[str, ...]:
    """Return the rooms of the stages that are left, in their order; the first is under way."""
    if request.mode is not CleanMode.ROOMS:
        return ()
    return tuple(dict.fromkeys(stage.name for stage in left if stage.name in request.rooms))


def changed_request(
    request: CleanRequest, done: Collection[str], names: Sequence[str], each: Sequence[RoomWay]
) -> CleanRequest:
    """Return a request of which rooms are ``done``, and ``names`` are still to be cleaned.

    ``each`` is how each of those is cleaned; without it those of before stay as they were, and new
    ones are cleaned as all are. Raises CleanRefusedError.
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
    floor_of: Callable[[str], Mask],
) -> tuple[list[Stage], int]:
    """Return the stages with other rooms from the present one on, and the number of that.

    ``before`` is the request of the ``stages``, of which ``number`` is under way, and ``request``
    the changed one; ``floor_of`` tells the floor of a room. A present room that is no more wanted
    leaves what was ``swept`` of it. Each room has its first pass before any has its second.
    """
    done, present, later = list(stages[:number]), stages[number], stages[number + 1 :]
    finished = Counter(stage.name for stage in done)
    others = [stage for stage in (present, *later) if stage.name not in before.rooms]
    if present.name not in names and present not in others:
        # Without a name: should it be wanted again, only the rest of it is swept.
        done.append(Stage("", present.floor & swept))
    passes = {name: request.way_of(name).passes for name in names}
    left = {name: passes[name] - finished[name] % passes[name] for name in names}
    new = [
        present
        if number_of_pass == 0 and name == present.name
        else Stage(name, floor_of(name), again=number_of_pass > 0 or finished[name] > 0)
        for number_of_pass in range(max(left.values()))
        for name in names
        if number_of_pass < left[name]
    ]
    return [*done, *new, *others], len(done)
