"""The coverage ledger: the floor that a clean wants, part by part, and what of it is clean."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from roomba.arrays import Mask
from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.geometry import Pose, old_in_new
from roomba.grid import GridFrame
from roomba.mission.cleaning.checkpoint import (
    CheckpointError,
    Values,
    packed,
    request_values,
    unpacked,
)
from roomba.mission.cleaning.room_queue import (
    changed_request,
    changed_stages,
    queue_of,
    renamed_rooms,
    with_renamed,
)
from roomba.mission.cleaning.stages import Stage, parts_of_room, stages_of, with_floor_left
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.coverage_bits import SWEPT, TRIED, WANTED
from roomba.perception.swept.coverage_kernels import missed_of, swept_or
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.perception.swept.dirt_map import DirtMap
from roomba.raster.carried import carried
from roomba.raster.distance import distance_to_nearest
from roomba.vocabulary import CleanMode, RoomWay

_ALL: Final = 0xFF
_AS_NEAR: Final = 1.5
"""Cells; a place that is farther than the nearest one by no more than this is as near."""


class CoverageLedger:
    """``coverage`` is what was swept of the present pass, ``stages`` are the parts in their order.

    On a map that is being made there is one stage, all that is known so far.
    """

    def __init__(
        self, request: CleanRequest, context: PlanningContext, dirt: DirtMap, here: Pose
    ) -> None:
        """Find out what is wanted; raises CleanRefusedError for rooms that are not there."""
        self.request, self._context, self._dirt = request, context, dirt
        self._began_at = here
        self.stages = self._asked(context)
        self.coverage = CoverageMap(context.frame, self._union(), context.tool_width)
        self._ever = np.zeros(context.frame.shape, np.bool_)
        self.stage_number = 0

    @property
    def edges_only(self) -> bool:
        """Whether only edges are asked for."""
        return self.request.mode is CleanMode.EDGES

    @property
    def stage(self) -> Stage | None:
        """The stage that the clean is at, or None at the end."""
        return self.stages[self.stage_number] if self.stage_number < len(self.stages) else None

    @property
    def left(self) -> float:
        """Floor that is still to be cleaned, m2, stages and passes to come included."""
        stage = self.stage
        if stage is None:
            return 0.0
        cells = missed_of(self.coverage.cells, stage.floor)
        cells += sum(later.cells for later in self.stages[self.stage_number + 1 :])
        return cells * self.coverage.cell_area

    @property
    def clean_area(self) -> float:
        """What was ever swept of what is wanted, m2; only edits of zones make it less."""
        return swept_or(self.coverage.cells, self._ever) * self.coverage.cell_area

    @property
    def clean(self) -> Mask:
        """What was ever swept of what is wanted."""
        return self.coverage.wanted & (self.coverage.swept | self._ever)

    @property
    def untried(self) -> Mask:
        """What is missed, and no path over it was planned while the map is being made."""
        untried: Mask = (self.coverage.cells & (WANTED | SWEPT | TRIED)) == WANTED
        return untried

    def note_tried(self, floor: Mask) -> None:
        """Note that a path over this floor was planned."""
        self.coverage.cells[floor] |= np.uint8(TRIED)

    def try_again(self) -> None:
        """Plan over all that is missed again."""
        self.coverage.cells &= np.uint8(_ALL ^ TRIED)

    def add(self, stage: Stage) -> None:
        """Clean some floor at the end."""
        self.stages.append(stage)

    def next_stage(self) -> None:
        """Go on to the next part; another pass sweeps all anew."""
        self.stage_number += 1
        stage = self.stage
        if stage is not None and stage.again:
            self.sweep_anew(stage.floor)
            self.stages[self.stage_number] = Stage(stage.name, stage.floor)

    @property
    def queue(self) -> tuple[str, ...]:
        """The rooms that are still to be cleaned, the present one first; none without rooms."""
        return queue_of(self.request, self.stages[self.stage_number :])

    @property
    def queue_ways(self) -> tuple[RoomWay, ...]:
        """How each of them is cleaned."""
        return tuple(map(self.request.way_of, self.queue))

    def change_rooms(self, names: Sequence[str], each: Sequence[RoomWay]) -> bool:
        """Clean these rooms from now on; return whether the present one is another one then.

        Raises CleanRefusedError; then nothing is changed.
        """
        present = self.stage
        if present is None:
            raise CleanRefusedError("the floor is done, and it goes home: begin another clean")
        finished = {stage.name for stage in self.stages[: self.stage_number]}
        request = changed_request(self.request, finished, names, each)
        coverable = self._context.coverable(self._began_at)
        stages, number = changed_stages(
            self.request,
            request,
            names,
            self.stages,
            self.stage_number,
            self.coverage.swept,
            lambda name: parts_of_room(name, request, self._context, coverable),
        )
        self.request, self.stages, self.stage_number = request, stages, number
        self._want(self._union())
        if self.stage is present:
            return False
        self.stage_number -= 1
        self.next_stage()
        return True

    def way_out_of(self, stage: Stage) -> tuple[float, float] | None:
        """Return where the next part begins, m, seen from this one; None if it is the last.

        That is the middle of the places where it is nearest: at the side of a door the robot would
        touch the frame. Another pass over the same floor may begin anywhere: None as well.
        """
        following = self.stages[self.stage_number + 1 : self.stage_number + 2]
        if not following or (following[0].floor & stage.floor).any():
            return None
        off = np.where(following[0].floor, distance_to_nearest(stage.floor), np.inf)
        near = np.argwhere(off <= off.min() + _AS_NEAR)
        row, column = near[np.argmin(((near - near.mean(axis=0)) ** 2).sum(axis=1))]
        return self._context.frame.centre_of(int(row), int(column))

    def sweep_anew(self, floor: Mask) -> None:
        """Let floor be dirty again; that it was ever clean is not forgotten."""
        self._ever |= self.coverage.swept
        self.coverage.cells[floor] &= np.uint8(_ALL ^ SWEPT)
        self.coverage.count_again()

    def use_context(self, context: PlanningContext, dirt: DirtMap) -> None:
        """Go on with other zones or rooms, or with more of the map; what is swept stays so."""
        self._dirt = dirt
        if self._context.is_growing:
            self._use_more_map(context)
        else:
            self._use_edits(context)
        self._context = context

    def _use_edits(self, context: PlanningContext) -> None:
        names = renamed_rooms(self._context.rooms, context.rooms)
        self.request = with_renamed(self.request, names)
        coverable = context.coverable(self._began_at)
        stages = [
            Stage(names.get(s.name, s.name), s.floor & coverable, s.again) for s in self.stages
        ]
        self.stages = with_floor_left(stages, self.stage_number)
        try:
            wanted = self._floor_of(self._asked(context), context)
        except CleanRefusedError:
            # A room that was joined to another one, or forgotten, is cleaned all the same.
            wanted = self._floor_of(self.stages, context)
        freed = wanted & ~self.coverage.wanted
        if freed.any():
            self.stages.append(Stage("what was a zone before", freed))
        self._want((self.coverage.wanted & coverable & wanted) | freed)

    def _use_more_map(self, context: PlanningContext) -> None:
        """Bring what is swept to the new map, and want all that the new map shows."""
        moved = old_in_new(self._context.station, context.station)
        self._carry(self._context.frame, context.frame, moved)
        self._began_at = moved.compose(self._began_at)
        self.request = self.request.moved(moved)
        self.stages, self.stage_number = self._asked(context), 0
        self._want(self._floor_of(self.stages, context))

    def _carry(self, before: GridFrame, after: GridFrame, moved: Pose) -> None:
        self._ever = carried(self._ever.view(np.uint8), before, after, moved).view(np.bool_)
        self.coverage.carry(after, moved)

    def _want(self, wanted: Mask) -> None:
        cells = self.coverage.cells
        cells &= np.uint8(_ALL ^ WANTED)
        cells[wanted] |= np.uint8(WANTED)
        self.coverage.count_again()

    def values(self) -> Values:
        """Return all that must be remembered to go on, as plain values."""
        frame, station, began = self._context.frame, self._context.station, self._began_at
        return {
            "request": request_values(self.request),
            "stages": [[s.name, packed(s.floor), s.again] for s in self.stages],
            "stage_number": self.stage_number,
            "wanted": packed(self.coverage.wanted),
            "swept": packed(self.coverage.swept),
            "ever": packed(self._ever),
            "is_growing": self._context.is_growing,
            "grid": [frame.origin_x, frame.origin_y, frame.rows, frame.columns],
            "station": [station.x, station.y, station.theta],
            "began_at": [began.x, began.y, began.theta],
        }

    def restore(self, values: Values) -> None:
        """Go on from such values, which are of this map or of a smaller part of it.

        Raises CheckpointError, and other errors for junk.
        """
        frame, station = self._place_of(values)
        moved = old_in_new(station, self._context.station)
        self._began_at = moved.compose(_pose(values["began_at"]))
        swept, ever = unpacked(values["swept"], frame.shape), unpacked(values["ever"], frame.shape)
        if values["is_growing"]:
            self.coverage = CoverageMap(frame, np.zeros_like(swept), self._context.tool_width)
            self.coverage.cells[swept] = np.uint8(SWEPT)
            self._ever, self.request = ever, self.request.moved(moved)
            self._carry(frame, self._context.frame, moved)
            self.stages = self._asked(self._context)
            self._want(self._union())
            return
        if frame.shape != self._context.frame.shape:
            raise CheckpointError(f"expected a grid of {self._context.frame}, got {frame}")
        # Zones may be newer than the checkpoint.
        coverable = self._context.coverable(self._began_at)
        wanted = unpacked(values["wanted"], frame.shape) & coverable
        stages = [
            Stage(str(name), unpacked(floor, frame.shape) & coverable, bool(again))
            for name, floor, again in values["stages"]
        ]
        number = int(values["stage_number"])
        if not 0 <= number <= len(stages):
            raise CheckpointError(f"expected a stage from 0 to {len(stages)}, got {number}")
        self.coverage.cells[:] = wanted * np.uint8(WANTED) + swept * np.uint8(SWEPT)
        self.coverage.count_again()
        self._ever, self.stages = ever, with_floor_left(stages, number)
        self.stage_number = number

    def _place_of(self, values: Values) -> tuple[GridFrame, Pose]:
        """Return the grid that values are of, and where the station was on that map."""
        x, y, rows, columns = values["grid"]
        resolution = self._context.frame.resolution
        frame = GridFrame(resolution, float(x), float(y), int(rows), int(columns))
        if not Pose(frame.origin_x, frame.origin_y).is_finite:
            raise CheckpointError("expected finite numbers")
        return frame, _pose(values["station"])

    def _asked(self, context: PlanningContext) -> list[Stage]:
        coverable = context.coverable(self._began_at)
        stages = stages_of(self.request, context, self._dirt, coverable, self._began_at)
        return stages[:1] if context.is_growing else stages

    def _union(self) -> Mask:
        return self._floor_of(self.stages, self._context)

    @staticmethod
    def _floor_of(stages: list[Stage], context: PlanningContext) -> Mask:
        floor = np.zeros(context.frame.shape, np.bool_)
        for stage in stages:
            floor |= stage.floor
        return floor


def _pose(values: list[float]) -> Pose:
    x, y, theta = values
    pose = Pose(float(x), float(y), float(theta))
    if not pose.is_finite:
        raise CheckpointError("expected finite numbers")
    return pose
