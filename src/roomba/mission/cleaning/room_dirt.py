"""How dirty each room was that a clean swept."""

from __future__ import annotations

import numpy as np

from roomba.arrays import Mask
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import RoomDirt


def dirt_of_rooms(clean: Mask, context: PlanningContext, dirt: DirtMap) -> tuple[RoomDirt, ...]:
    """Return what the present run of ``dirt`` counted, room by room, for rooms that were swept.

    ``clean`` is what is swept, bool over the context's grid.
    """
    if context.rooms is None or context.is_growing or not clean.any():
        return ()
    coverable, found = context.coverable(), []
    for name in context.rooms.names:
        room = coverable & context.in_room(name)
        swept = np.count_nonzero(clean & room)
        if swept:
            share = float(swept / np.count_nonzero(room))
            found.append(RoomDirt(name, share, dirt.found(room, context.frame)))
    return tuple(found)
