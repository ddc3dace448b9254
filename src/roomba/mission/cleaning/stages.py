"""The parts of a clean, in their order: rooms, passes, and what they are cut to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from roomba.arrays import Mask
from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.geometry import Pose
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.dirt_map import DirtMap
from roomba.planning.path.planner import NoPathError
from roomba.raster.distance import distance_to_nearest
from roomba.vocabulary import CarpetWay, CleanMode, EdgeOrder, listed


@dataclass(frozen=True, eq=False)
class Stage:
    """A part of a clean: its ``name``, the floor of it, and whether it is driven again."""

    name: str
    floor: Mask
    again: bool = False

    @cached_property
    def cells(self) -> int:
        """How many cells its floor has."""
        return int(np.count_nonzero(self.floor))


def stages_of(
    request: CleanRequest, context: PlanningContext, dirt: DirtMap, coverable: Mask, here: Pose
) -> list[Stage]:
    """Return the parts of a clean in their order, all passes; raises CleanRefusedError."""
    coverable = _allowed(request, context, coverable)
    once = [
        part
        for whole in _parts(request, context, dirt, coverable, here)
        for part in _by_edges(whole, request.edges, context)
    ]
    return [
        Stage(part.name, part.floor, again=number > 0)
        for number in range(request.most_passes)
        for part in once
        if number < request.way_of(part.name).passes
    ]


def with_floor_left(stages: Sequence[Stage], number: int) -> list[Stage]:
    """Return the stages without those to come that have no floor any more.

    Those up to ``number``, which is under way, stay: they tell what was done.
    """
    return [*stages[: number + 1], *(each for each in stages[number + 1 :] if each.floor.any())]


def parts_of_room(
    name: str, request: CleanRequest, context: PlanningContext, coverable: Mask
) -> list[Stage]:
    """Return the parts of one pass over a room, in their order; raises CleanRefusedError."""
    known = () if context.rooms is None else context.rooms.names
    _require_known((name,), known)
    floor = _allowed(request, context, coverable) & context.in_room(name)
    if not floor.any():
        raise CleanRefusedError(f"expected floor that can be reached in {name!r}, got none")
    return _by_edges(Stage(name, floor), request.edges, context)


def _allowed(request: CleanRequest, context: PlanningContext, coverable: Mask) -> Mask:
    """Return the floor that a request lets the robot clean."""
    return coverable & ~context.carpets if request.carpets is CarpetWay.AVOID else coverable


def _require_known(names: Iterable[str], known: Sequence[str]) -> None:
    for name in names:
        if name not in known:
            raise CleanRefusedError(
                f"expected the name of a room, got {name!r}; there are: {listed(known)}"
            )


def _by_edges(part: Stage, order: EdgeOrder, context: PlanningContext) -> list[Stage]:
    """Return a part of a clean as one, or its edges and what is off them, in their order."""
    if order is EdgeOrder.ANY:
        return [part]
    edges = edges_of(part.floor, context)
    both = [Stage(part.name, edges), Stage(part.name, part.floor & ~edges)]
    ordered = both if order is EdgeOrder.FIRST else both[::-1]
    return [stage for stage in ordered if stage.floor.any()]


def edges_of(floor: Mask, context: PlanningContext) -> Mask:
    """Return the strip of a floor along its edges that is as wide as the tool."""
    off_edge = distance_to_nearest(~floor) * context.frame.resolution
    strip: Mask = floor & (off_edge <= context.tool_width)
    return strip


def _parts(
    request: CleanRequest, context: PlanningContext, dirt: DirtMap, coverable: Mask, here: Pose
) -> list[Stage]:
    if request.mode in (CleanMode.WHOLE, CleanMode.EDGES):
        floor = coverable
        if request.mode is CleanMode.EDGES:
            floor = edges_of(coverable, context)
        return [Stage("", floor)]
    if request.mode is CleanMode.ZONES:
        return [Stage("", coverable & _inside(context, request.zones))]
    if request.mode is CleanMode.SPOT:
        x, y = request.spot or (here.x, here.y)
        half = 0.5 * context.spot_size
        square = (x - half, y - half, x + half, y + half)
        return [Stage("", coverable & _inside(context, (square,)))]
    if context.rooms is None or not context.rooms.names:
        raise CleanRefusedError("expected a map with rooms, got one without; clean the whole home")
    names = _room_names(request, context, dirt)
    masks = {name: coverable & context.in_room(name) for name in names}
    stages = [Stage(name, masks[name]) for name in names if masks[name].any()]
    if request.mode is CleanMode.DIRTIEST:
        rest = coverable & ~np.logical_or.reduce(list(masks.values()))
        stages.append(Stage("outside of all rooms", rest))
    return [stage for stage in stages if stage.floor.any()]


def _room_names(request: CleanRequest, context: PlanningContext, dirt: DirtMap) -> list[str]:
    """Return the rooms in the order in which they are cleaned."""
    assert context.rooms is not None
    known = context.rooms.names
    if request.mode is CleanMode.DIRTIEST:
        dirtiest = {
            name: dirt.density(
                context.fine(context.rooms.labels == context.rooms.label_of(name)), context.frame
            )
            for name in known
        }
        return sorted(known, key=lambda name: -dirtiest[name])
    _require_known(request.rooms, known)
    names = list(dict.fromkeys(request.rooms))
    return names if request.in_order else _nearest_first(names, context)


def _nearest_first(names: list[str], context: PlanningContext) -> list[str]:
    """Return rooms so that each is the nearest one to that before it, from the station on."""
    assert context.rooms is not None
    anchors = {name: context.rooms.anchor(context.rooms.label_of(name)) for name in names}
    x, y = context.staging.x, context.staging.y
    ordered: list[str] = []
    while len(ordered) < len(names):
        left = [name for name in names if name not in ordered]
        ordered.append(min(left, key=lambda name: _way(context, (x, y), anchors[name])))
        x, y = anchors[ordered[-1]]
    return ordered


def _way(context: PlanningContext, start: tuple[float, float], end: tuple[float, float]) -> float:
    try:
        return context.paths.plan(start, end).length
    except NoPathError:
        return float("inf")


def _inside(
    context: PlanningContext, rectangles: tuple[tuple[float, float, float, float], ...]
) -> Mask:
    """Return the cells whose middles lie in one of the rectangles."""
    frame = context.frame
    x, y = frame.centres()
    inside = np.zeros(frame.shape, np.bool_)
    for left, bottom, right, top in rectangles:
        inside |= np.outer((y >= bottom) & (y <= top), (x >= left) & (x <= right))
    return inside
