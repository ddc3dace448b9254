"""Missed floor, and the reasons."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from roomba.arrays import Mask
from roomba.geometry import RoundObstacle
from roomba.grid import GridFrame
from roomba.mission.cleaning.result import Missed, MissReason
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.coverage_map import Patch, patches_of

_MOSTLY: Final = 0.8
"""Share of a patch that is near to things: it is missed for what stands there."""
_HARDLY_ANY: Final = 0.02
"""Share of the wanted floor; a clean of no more than this did not do what was asked."""
_NEARLY_ALL: Final = 0.05
"""Share of the wanted floor; less that is missed needs no words."""
_MOST_TOLD: Final = 4
"""Rooms and reasons that a message lists."""
_IN_THE_WAY: Final = {
    MissReason.THING: "something stands there that the map does not show",
    MissReason.SHUT: "a door is shut, or something stands in the way",
    MissReason.EDGE: "the floor ends there",
}
"""Why floor could not be reached."""


def missed_floor(
    left: Mask,
    least: float,
    context: PlanningContext,
    obstacles: Sequence[RoundObstacle],
    edges: Sequence[RoundObstacle],
    *,
    is_over: bool,
) -> tuple[Missed, ...]:
    """Return the patches of ``least`` m2 or more of what is ``left``, the largest first.

    ``left`` is bool over the context's frame. A strip that is one cell wide, along a swath, does
    not count as missed: a fraction of a cell decides about it. ``edges`` are those of the
    ``obstacles`` where the floor ends. ``is_over``: the clean went on to its end.
    """
    patches = [
        part
        for patch in patches_of(left, context.frame, least)
        for part in _by_rooms(patch, context, least)
        if is_broad(part.cells)
    ]
    patches.sort(key=lambda patch: -patch.area)
    reachable = _reachable(context, obstacles)
    before_edges = _reachable(context, edges) if edges else None

    def reason(patch: Patch) -> MissReason:
        if _is_mostly_in(patch, reachable):
            return MissReason.LEFT_OVER if is_over else MissReason.STOPPED
        if before_edges is not None and not _is_mostly_in(patch, before_edges):
            return MissReason.EDGE
        return MissReason.THING if is_hidden(patch, context, obstacles) else MissReason.SHUT

    return tuple(
        Missed(patch.area, patch.x, patch.y, context.room_at(patch.x, patch.y), reason(patch))
        for patch in patches
    )


def _by_rooms(patch: Patch, context: PlanningContext, least: float) -> list[Patch]:
    """Return a patch as its parts in one room each, or whole if all of them are below ``least``."""
    if context.rooms is None:
        return [patch]
    rooms = context.fine(context.rooms.labels)
    labels = np.unique(rooms[patch.cells]).tolist()
    if len(labels) == 1:
        return [patch]
    parts = [
        part
        for label in labels
        for part in patches_of(patch.cells & (rooms == label), context.frame, least)
    ]
    return parts or [patch]


def is_broad(cells: Mask) -> bool:
    """Whether cells, bool [rows, columns], are two by two wide somewhere."""
    upper, lower = cells[1:], cells[:-1]
    return bool((upper[:, 1:] & upper[:, :-1] & lower[:, 1:] & lower[:, :-1]).any())


def is_hidden(patch: Patch, context: PlanningContext, things: Sequence[RoundObstacle]) -> bool:
    """Whether a patch is floor that things stand on or hide, and not a room behind them."""
    rows, columns = np.nonzero(patch.cells)
    frame: GridFrame = context.frame
    x, y = frame.centres(rows, columns)
    near = context.reach + 2.0 * context.tool_width
    is_near = np.zeros(len(x), np.bool_)
    for thing_x, thing_y, radius in things:
        is_near |= np.hypot(x - thing_x, y - thing_y) < near + radius
    return bool(is_near.mean() > _MOSTLY)


def what_is_not_clean(wanted: float, covered: float, missed: Sequence[Missed]) -> str:
    """Return how much of the ``wanted`` m2 is not clean, where and why; empty if nearly all is."""
    if missed and covered <= _HARDLY_ANY * wanted:
        return _why_hardly_any(covered, missed)
    if sum(patch.area for patch in missed) < _NEARLY_ALL * wanted:
        return ""
    areas: dict[tuple[str, MissReason], float] = {}
    for patch in missed:
        place = (patch.room, patch.reason)
        areas[place] = areas.get(place, 0.0) + patch.area
    told = [
        f"{area:.1f} m²{f' of {room}' if room else ''} ({reason.value})"
        for (room, reason), area in sorted(areas.items(), key=lambda item: -item[1])
    ]
    count = len(told) - _MOST_TOLD
    more = f" and {count} more {'place' if count == 1 else 'places'}" if count > 0 else ""
    return f"not clean: {', '.join(told[:_MOST_TOLD])}{more}"


def _why_hardly_any(covered: float, missed: Sequence[Missed]) -> str:
    share = "hardly any of it" if covered > 0.0 else "nothing of it"
    reason = missed[0].reason
    if reason in _IN_THE_WAY:
        return f"{share} could be reached: {_IN_THE_WAY[reason]}"
    return f"{share} is clean: {reason.value}"


def _reachable(context: PlanningContext, obstacles: Sequence[RoundObstacle]) -> Mask:
    """Return the floor that can be reached from the station, among ``obstacles``."""
    staging = (context.staging.x, context.staging.y)
    return context.reachable(staging, context.with_closed_gaps(obstacles))


def _is_mostly_in(patch: Patch, floor: Mask) -> bool:
    cells = np.count_nonzero(patch.cells)
    return bool(np.count_nonzero(floor[patch.cells]) >= 0.5 * cells)
