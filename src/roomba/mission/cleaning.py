"""One clean: what is wanted, what is done, and where to drive next.

The floor is cleaned in stages (rooms, passes). Each is planned as a whole and driven; what was
missed is found from what was really swept, and planned again until it is done or cannot be reached.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.distance import distance_to_nearest
from roomba.geometry import Pose
from roomba.mission.checkpoint import CheckpointError, Values, packed, request_values, unpacked
from roomba.mission.clean_request import (
    SPOT_SIZE,
    CleanMode,
    CleanRefusedError,
    CleanRequest,
    Missed,
    MissReason,
)
from roomba.mission.site import Site
from roomba.mission_config import CleaningConfig
from roomba.perception.coverage_bits import SWEPT, WANTED
from roomba.perception.coverage_map import CoverageMap, Patch, patches_of
from roomba.perception.dirt_map import DirtMap
from roomba.planning.costmap import Point, RoundObstacle
from roomba.planning.path import NoPathError

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MOSTLY: Final = 0.8
"""Share of a patch that is near to things: it is missed for what stands there."""
_LITTLE_GAIN: Final = 0.05
"""Share of what was missed; a round that gains less of it than this was for nothing."""
_WORTH_A_LOOK: Final = 0.5
"""m2; so much floor out of reach is looked for again, as behind a door: less is below a chair."""
_WORTH_A_ROUND: Final = 0.02
"""m2; one patch as large as this is worth another round, though enough is clean."""


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """A part of a clean: its ``name``, the floor of it, and whether it is driven again."""

    name: str
    floor: Mask
    again: bool = False


class Cleaning:
    """Plans piece by piece; ``coverage`` is what was swept of the present pass."""

    def __init__(
        self, request: CleanRequest, site: Site, dirt: DirtMap, config: CleaningConfig, here: Pose
    ) -> None:
        """Find out what is wanted; raises CleanRefusedError when that is nothing."""
        self.request, self._site, self._config, self._dirt = request, site, config, dirt
        self._began_at = here
        coverable = site.coverable()
        self.stages = stages_of(request, site, dirt, coverable, here)
        wanted = np.logical_or.reduce([stage.floor for stage in self.stages])
        if not wanted.any():
            raise CleanRefusedError(
                "expected floor that can be reached, got none: it is outside of the map, in "
                "furniture, or in a no-go zone"
            )
        self.coverage = CoverageMap(site.frame, wanted, site.tool_width)
        self._ever = np.zeros(site.frame.shape, np.bool_)
        self.stage_number = 0
        self._rounds = 0
        self._last_missed = np.inf
        self._looked_again = False
        self._unreachable = False
        self._scrubbed = False

    @property
    def stage(self) -> Stage | None:
        """The one that it is at, or None at the end."""
        return self.stages[self.stage_number] if self.stage_number < len(self.stages) else None

    @property
    def left(self) -> float:
        """Floor that is still to be cleaned, m2, stages and passes to come included."""
        cell = self.coverage.cell_area
        missed = self.coverage.missed
        now = sum(
            float(np.count_nonzero(stage.floor & missed if number == 0 else stage.floor))
            for number, stage in enumerate(self.stages[self.stage_number :])
        )
        return now * cell

    @property
    def clean(self) -> Mask:
        """What was ever swept of what is wanted."""
        return self.coverage.wanted & (self.coverage.swept | self._ever)

    @property
    def clean_area(self) -> float:
        """Of it, m2; it never gets less while nobody edits zones."""
        return float(np.count_nonzero(self.clean)) * self.coverage.cell_area

    def next_path(self, here: Pose, obstacles: list[RoundObstacle]) -> Floats | None:
        """Return the next points to drive, float64 [n, 2], m, or None when all is done."""
        while (stage := self.stage) is not None:
            points = self._next_round(stage, here, obstacles)
            if points is not None:
                return points
            self._next_stage()
        return None

    def wants_another_look(self) -> bool:
        """Whether floor was out of reach: once, before the end, it is to be looked for again."""
        if self._looked_again or not self._unreachable or self.stage is not None:
            return False
        self._looked_again, self._unreachable = True, False
        self.stages.append(Stage("what was out of reach", self.coverage.wanted & ~self.clean))
        self._begin_stage()
        return True

    def cut_off(self) -> None:
        """Tell that no way led to some of what was planned."""
        self._unreachable, self._last_missed = True, np.inf

    def interrupted(self) -> None:
        """Tell that the last path was not driven to its end: it says nothing of what is left."""
        self._rounds, self._last_missed = 0, np.inf

    def use_site(self, site: Site) -> None:
        """Go on with other zones or rooms; what is swept stays so."""
        coverable = site.coverable()
        self._site = site
        asked = stages_of(self.request, site, self._dirt, coverable, self._began_at)
        wanted = np.logical_or.reduce([stage.floor for stage in asked]) if asked else ~coverable
        cells = self.coverage.cells
        freed = wanted & ~self.coverage.wanted
        cells[~(coverable & wanted)] &= np.uint8(0xFF ^ WANTED)
        cells[freed] |= np.uint8(WANTED)
        self.stages = [Stage(s.name, s.floor & coverable, s.again) for s in self.stages]
        if freed.any():
            self.stages.append(Stage("what was a zone before", freed))
        self.coverage.count_again()

    def values(self) -> Values:
        """Return all that must be remembered to go on, as plain values."""
        return {
            "request": request_values(self.request),
            "stages": [[s.name, packed(s.floor), s.again] for s in self.stages],
            "stage_number": self.stage_number,
            "wanted": packed(self.coverage.wanted),
            "swept": packed(self.coverage.swept),
            "ever": packed(self._ever),
            "looked_again": self._looked_again,
            "unreachable": self._unreachable,
            "scrubbed": self._scrubbed,
        }

    def restore(self, values: Values) -> None:
        """Go on from such values, of the same map; raises CheckpointError, and others for junk."""
        shape = self._site.frame.shape
        wanted, swept = unpacked(values["wanted"], shape), unpacked(values["swept"], shape)
        ever = unpacked(values["ever"], shape)
        stages = [
            Stage(str(n), unpacked(f, shape), bool(again)) for n, f, again in values["stages"]
        ]
        number = int(values["stage_number"])
        if not 0 <= number <= len(stages):
            raise CheckpointError(f"expected a stage from 0 to {len(stages)}, got {number}")
        self.coverage.cells[:] = wanted * np.uint8(WANTED) + swept * np.uint8(SWEPT)
        self.coverage.count_again()
        self._ever, self.stages, self.stage_number = ever, stages, number
        self._looked_again = bool(values["looked_again"])
        self._unreachable, self._scrubbed = bool(values["unreachable"]), bool(values["scrubbed"])

    def missed(self, obstacles: list[RoundObstacle], is_over: bool) -> tuple[Missed, ...]:
        """Return what is not clean, the largest first, with the reason; ``is_over``: it went on to
        the end."""
        left = self.coverage.wanted & ~self.clean
        patches = patches_of(left, self.coverage.frame, self._config.least_patch)
        staging = (self._site.staging.x, self._site.staging.y)
        reachable = self._reachable(staging, obstacles)
        return tuple(
            Missed(
                patch.area,
                patch.x,
                patch.y,
                self._site.room_at(patch.x, patch.y),
                self._reason(patch, obstacles, reachable, is_over),
            )
            for patch in patches
        )

    def _reason(
        self, patch: Patch, obstacles: list[RoundObstacle], reachable: Mask, is_over: bool
    ) -> MissReason:
        if np.count_nonzero(reachable[patch.cells]) < 0.5 * np.count_nonzero(patch.cells):
            rows, columns = np.nonzero(patch.cells)
            frame = self.coverage.frame
            x = frame.origin_x + (columns + 0.5) * frame.resolution
            y = frame.origin_y + (rows + 0.5) * frame.resolution
            near = self._site.reach + 2.0 * self._site.tool_width
            is_near = np.zeros(len(x), np.bool_)
            for thing_x, thing_y, radius in obstacles:
                is_near |= np.hypot(x - thing_x, y - thing_y) < near + radius
            return MissReason.THING if is_near.mean() > _MOSTLY else MissReason.SHUT
        return MissReason.LEFT_OVER if is_over else MissReason.STOPPED

    def _next_round(
        self, stage: Stage, here: Pose, obstacles: list[RoundObstacle]
    ) -> Floats | None:
        """Plan what is missed of a stage, if that is worth it."""
        todo = stage.floor & self.coverage.missed
        missed = float(np.count_nonzero(todo)) * self.coverage.cell_area
        if self._rounds > 0:
            todo = self._worth_it(stage, todo, here, obstacles)
            gained = self._last_missed - missed
            if self._rounds > self._config.most_rounds or gained < _LITTLE_GAIN * self._last_missed:
                todo[:] = False
        if self._rounds > 0 and not todo.any() and not self._scrubbed:
            todo = self._dirty_again(stage)
        if not todo.any():
            return None
        self._rounds += 1
        self._last_missed = missed
        try:
            plan = self._site.plan_coverage(
                (here.x, here.y),
                todo,
                obstacles,
                edges_only=self.request.mode is CleanMode.EDGES,
            )
        except NoPathError:
            self._unreachable = True
            return None
        return plan.points if plan.length > 0.0 and len(plan.points) > 2 else None

    def _worth_it(
        self, stage: Stage, todo: Mask, here: Pose, obstacles: list[RoundObstacle]
    ) -> Mask:
        """Return the patches that are worth another round, of what a stage missed.

        Behind and below what stands in the way nothing can be done now.
        """
        reachable = self._reachable((here.x, here.y), obstacles)
        self._note_out_of_reach(todo & ~reachable)
        todo &= reachable
        wanted = max(int(np.count_nonzero(stage.floor & reachable)), 1)
        share = 1.0 - np.count_nonzero(todo) / wanted
        least = _WORTH_A_ROUND if share >= self._config.enough else self._config.least_patch
        worth = np.zeros_like(todo)
        for patch in patches_of(todo, self.coverage.frame, least):
            worth |= patch.cells
        return worth

    def _note_out_of_reach(self, floor: Mask) -> None:
        """Floor that somebody may open later is looked for again before the end."""
        if patches_of(floor, self.coverage.frame, _WORTH_A_LOOK):
            self._unreachable = True

    def _reachable(self, here: Point, obstacles: list[RoundObstacle]) -> Mask:
        """Return what can be cleaned from a place among what the map does not show."""
        return self._site.floor.with_obstacles(obstacles).coverable(here)

    def _dirty_again(self, stage: Stage) -> Mask:
        """Return what was so dirty that it gets another pass, once a stage."""
        self._scrubbed = True
        dirty = self._dirt.dirty_now(self.coverage.frame, self._config.dirty_times)
        again = dirty & stage.floor & self.coverage.swept
        if again.any():
            self._sweep_anew(again)
            self._last_missed = np.inf
        return again

    def _sweep_anew(self, floor: Mask) -> None:
        self._ever |= self.coverage.swept
        self.coverage.cells[floor] &= np.uint8(0xFF ^ SWEPT)
        self.coverage.count_again()

    def _next_stage(self) -> None:
        self.stage_number += 1
        self._begin_stage()

    def _begin_stage(self) -> None:
        self._rounds, self._last_missed, self._scrubbed = 0, np.inf, False
        stage = self.stage
        if stage is not None and stage.again:
            self._sweep_anew(stage.floor)
            self.stages[self.stage_number] = Stage(stage.name, stage.floor)


def stages_of(
    request: CleanRequest, site: Site, dirt: DirtMap, coverable: Mask, here: Pose
) -> list[Stage]:
    """Return the parts of a clean in their order, all passes; raises CleanRefusedError."""
    once = _parts(request, site, dirt, coverable, here)
    return [
        Stage(part.name, part.floor, again=number > 0)
        for number in range(request.passes)
        for part in once
    ]


def _parts(
    request: CleanRequest, site: Site, dirt: DirtMap, coverable: Mask, here: Pose
) -> list[Stage]:
    if request.mode in (CleanMode.WHOLE, CleanMode.EDGES):
        floor = coverable
        if request.mode is CleanMode.EDGES:
            off_edge = distance_to_nearest(~coverable) * site.frame.resolution
            floor = coverable & (off_edge <= site.tool_width)
        return [Stage("", floor)]
    if request.mode is CleanMode.ZONES:
        return [Stage("", coverable & _inside(site, request.zones))]
    if request.mode is CleanMode.SPOT:
        x, y = request.spot or (here.x, here.y)
        half = 0.5 * SPOT_SIZE
        square = (x - half, y - half, x + half, y + half)
        return [Stage("", coverable & _inside(site, (square,)))]
    if site.rooms is None or not site.rooms.names:
        raise CleanRefusedError("expected a map with rooms, got one without; clean the whole home")
    names = _room_names(request, site, dirt)
    masks = {name: coverable & site.in_room(name) for name in names}
    stages = [Stage(name, masks[name]) for name in names if masks[name].any()]
    if request.mode is CleanMode.DIRTIEST:
        rest = coverable & ~np.logical_or.reduce(list(masks.values()))
        stages.append(Stage("outside of all rooms", rest))
    return [stage for stage in stages if stage.floor.any()]


def _room_names(request: CleanRequest, site: Site, dirt: DirtMap) -> list[str]:
    """Return the rooms in the order in which they are cleaned."""
    assert site.rooms is not None
    known = site.rooms.names
    if request.mode is CleanMode.DIRTIEST:
        dirtiest = {
            name: dirt.density(
                site.fine(site.rooms.labels == site.rooms.label_of(name)), site.frame
            )
            for name in known
        }
        return sorted(known, key=lambda name: -dirtiest[name])
    for name in request.rooms:
        if name not in known:
            raise CleanRefusedError(
                f"expected the name of a room, got {name!r}; there are: {', '.join(known)}"
            )
    names = list(dict.fromkeys(request.rooms))
    return names if request.in_order else _nearest_first(names, site)


def _nearest_first(names: list[str], site: Site) -> list[str]:
    """Return rooms so that each is the nearest one to that before it, from the station on."""
    assert site.rooms is not None
    anchors = {name: site.rooms.anchor(site.rooms.label_of(name)) for name in names}
    x, y = site.staging.x, site.staging.y
    ordered: list[str] = []
    while len(ordered) < len(names):
        left = [name for name in names if name not in ordered]
        ordered.append(min(left, key=lambda name: _way(site, (x, y), anchors[name])))
        x, y = anchors[ordered[-1]]
    return ordered


def _way(site: Site, start: tuple[float, float], end: tuple[float, float]) -> float:
    try:
        return site.paths.plan(start, end).length
    except NoPathError:
        return float("inf")


def _inside(site: Site, rectangles: tuple[tuple[float, float, float, float], ...]) -> Mask:
    """Return the cells whose middles lie in one of the rectangles."""
    frame = site.frame
    x = frame.origin_x + (np.arange(frame.columns) + 0.5) * frame.resolution
    y = frame.origin_y + (np.arange(frame.rows) + 0.5) * frame.resolution
    inside = np.zeros(frame.shape, np.bool_)
    for left, bottom, right, top in rectangles:
        inside |= np.outer((y >= bottom) & (y <= top), (x >= left) & (x <= right))
    return inside
