"""One clean: where to drive next.

The floor is cleaned in stages (rooms, passes). Each is planned as a whole and driven; what was
missed is found from what was really swept, and planned again until it is done or cannot be reached.
While the map is being made, large patches of what is known are planned, each once.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from roomba.arrays import Floats, Mask
from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.configuration.mission import CleaningConfig
from roomba.geometry import Pose, RoundObstacle
from roomba.mission.cleaning.another_round import (
    floor_in_reach,
    may_be_opened,
    rounded_off,
    worth_another_round,
)
from roomba.mission.cleaning.checkpoint import Values
from roomba.mission.cleaning.dirty.dirty_floor import DirtyFloor
from roomba.mission.cleaning.ledger import CoverageLedger
from roomba.mission.cleaning.missed import missed_floor
from roomba.mission.cleaning.result import Missed
from roomba.mission.cleaning.rounds import Rounds
from roomba.mission.cleaning.second_pass import SecondPass
from roomba.mission.cleaning.stages import Stage, edges_of
from roomba.mission.cleaning.worth import PlanOver, made_once, plan_worth_its_way, slivers_of
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.coverage_map import patches_of
from roomba.perception.swept.dirt_map import DirtMap
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.path.planner import NoPathError
from roomba.planning.path.polyline import Path
from roomba.raster.regions import large_regions
from roomba.vocabulary import CleanMode, RoomWay


class Cleaning:
    """Plans piece by piece; ``ledger`` tells what is wanted, and what of it is clean.

    ``is_again``: the present path is one of a later round, over what the first one left.
    ``mean_passes`` is the number of passes over the floor that are asked for, in the mean.
    """

    def __init__(
        self,
        request: CleanRequest,
        context: PlanningContext,
        dirt: DirtMap,
        config: CleaningConfig,
        here: Pose,
    ) -> None:
        """Find out what is wanted; raises CleanRefusedError when that is nothing."""
        self._context, self._config = context, config
        self.ledger = CoverageLedger(request, context, dirt, here)
        if not (self.ledger.coverage.wanted_cells or self.explores):
            raise CleanRefusedError(_why_nothing(context))
        self.dirty = DirtyFloor(dirt, config)
        """What is so dirty that it is swept once more."""
        self._second_pass = SecondPass(self.dirty, self.ledger, config)
        self._count_passes()
        self.is_again = False
        self._rounds = Rounds(config)
        self._looked_again = False
        self._unreachable = False
        self._scrubbed = False
        self._rest: Floats | None = None
        self.broken_off = 0.0
        """m that were left of the last path that was not driven to its end."""

    @property
    def explores(self) -> bool:
        """Whether the clean also explores, to find floor that the map does not show yet."""
        may_be_more = self.ledger.request.mode in (CleanMode.WHOLE, CleanMode.EDGES)
        return self._context.is_growing and may_be_more

    def change_rooms(self, names: Sequence[str], each: Sequence[RoomWay] = ()) -> bool:
        """Clean these rooms from now on, in this order; return whether another path is wanted.

        ``each`` is how each of them is cleaned, else as before. Raises CleanRefusedError.
        """
        is_another = self.ledger.change_rooms(names, each)
        self._count_passes()
        return is_another

    def begin_room(self) -> None:
        """Plan over the present room from its beginning on."""
        self.dirty.begin_pass()
        self._begin_stage()

    def next_path(self, here: Pose, obstacles: list[RoundObstacle]) -> Floats | None:
        """Return the next points to drive, float64 [n, 2], m, or None when all is done.

        Raises NoPathError while the robot is shut in, so that it has to get out first.
        """
        obstacles = self._context.with_closed_gaps(obstacles)
        if self._context.is_growing:
            return self._next_of_known(here, obstacles)
        while (stage := self.ledger.stage) is not None:
            points = self._next_round(stage, here, obstacles)
            if points is not None:
                return points
            self._next_stage()
        return None

    @property
    def watches_dirt(self) -> bool:
        """Whether dirty floor close by, which gets another pass, is put into the path."""
        return self.ledger.stage is not None and not self._context.is_growing

    def dirty_at_hand(
        self, here: Pose, rest: Floats, obstacles: list[RoundObstacle], now: float
    ) -> Floats | None:
        """Return a path that leads over dirty floor close by as well, float64 [n, 2], m, or None.

        That is floor which was swept by ``now``, s. ``rest``, float64 [n, 2], m, is the path before
        the robot.
        """
        return self._second_pass.at_hand(self._context, (here.x, here.y), rest, obstacles, now)

    def wants_another_look(self, lasting: list[RoundObstacle]) -> bool:
        """Whether floor that was out of reach is to be tried again, once, before the end.

        Floor that is out of reach because of ``lasting`` things alone is left out: they stay.
        """
        if self._looked_again or not self._unreachable or self.ledger.stage is not None:
            return False
        self._looked_again, self._unreachable = True, False
        staging = (self._context.staging.x, self._context.staging.y)
        left = (
            self.ledger.coverage.wanted
            & ~self.ledger.clean
            & self._context.reachable(staging, lasting)
        )
        large = self._large(left, self._config.least_area_to_retry)
        if not large.any():
            return False
        self.ledger.add(Stage("what was out of reach", large))
        self._begin_stage()
        return True

    def cut_off(self) -> None:
        """Tell that no way led to some of what was planned."""
        self._unreachable = True
        self._rounds.cut_off()

    def interrupted(self, rest: Floats) -> None:
        """Tell that the last path was not driven to its end; ``rest``, float64 [n, 2], m, is left.

        So that path does not count as a round; what is large enough for a round is planned first.
        """
        self._begin_anew(rest)
        self.broken_off = Path(rest).length

    def plans_anew(self, now: float, rest: Floats) -> bool:
        """Whether to plan anew the ``rest``, float64 [n, 2], m, of a path that something blocks.

        A plan with all that is known by now takes less way than to go around the thing and to come
        back for the floor next to it.
        """
        if not self._rounds.begin_replan(now, Path(rest).length):
            return False
        self._begin_anew(rest)
        return True

    def _begin_anew(self, rest: Floats) -> None:
        """Do not count the last plan, of which there is a ``rest``, as a round."""
        self._rest = rest
        self._rounds.begin_anew()
        self.ledger.try_again()

    def use_context(self, context: PlanningContext, dirt: DirtMap) -> None:
        """Go on with other zones or rooms, or with more of the map; what is swept stays so.

        ``dirt`` is that of the planning context's map.
        """
        if self._context.is_growing:
            # With the whole map the first way through is done.
            self._begin_stage(is_driven=not context.is_growing)
        self._context = context
        self.dirty.begin(dirt)
        self.ledger.use_context(context, dirt)

    def values(self) -> Values:
        """Return all that must be remembered to go on, as plain values."""
        return {
            **self.ledger.values(),
            "looked_again": self._looked_again,
            "unreachable": self._unreachable,
            "scrubbed": self._scrubbed,
        }

    def restore(self, values: Values) -> None:
        """Go on from such values, which are of this map or of a smaller part of it.

        Raises CheckpointError, and other errors for junk.
        """
        self.ledger.restore(values)
        self._looked_again = bool(values["looked_again"])
        self._unreachable, self._scrubbed = bool(values["unreachable"]), bool(values["scrubbed"])

    def missed(
        self,
        obstacles: Sequence[RoundObstacle],
        is_over: bool,
        edges: Sequence[RoundObstacle] = (),
    ) -> tuple[Missed, ...]:
        """Return what is not clean, the largest first, with the reason.

        ``is_over``: the clean went on to its end; ``edges`` are ``obstacles`` where the floor ends.
        """
        left, least = self.ledger.coverage.wanted & ~self.ledger.clean, self._config.least_patch
        return missed_floor(left, least, self._context, obstacles, edges, is_over=is_over)

    def _next_of_known(self, here: Pose, obstacles: list[RoundObstacle]) -> Floats | None:
        """Plan over what is known and large enough, but for the edges; None if there is none."""
        at = (here.x, here.y)
        planner = self._context.growing_coverage
        floor = planner.floor.with_obstacles(obstacles).coverable(at)
        # Edges wait for the whole map, by which the robot knows its place better.
        todo = self.ledger.untried & floor & ~edges_of(floor, self._context)
        todo = self._large(todo, self._config.least_while_growing)
        if not todo.any():
            return None
        self.ledger.note_tried(todo)
        try:
            plan = planner.plan(at, None, todo, obstacles, edges_only=self.ledger.edges_only)
        except NoPathError:
            return None
        return _points_of(plan)

    def _next_round(
        self, stage: Stage, here: Pose, obstacles: list[RoundObstacle]
    ) -> Floats | None:
        """Plan what is missed of a stage, if that is worth it."""
        plan_over = made_once(lambda floor: self._plan_over(stage, floor, here, obstacles))
        left = stage.floor & self.ledger.coverage.missed
        missed = float(np.count_nonzero(left)) * self.ledger.coverage.cell_area
        todo = self._worth_a_round(stage, left, missed, here, obstacles, plan_over)
        if not todo.any():
            todo = self._dirty_at_the_end(stage, here, obstacles, plan_over)
        if not todo.any():
            return None
        self._rounds.begin(missed)
        plan = self._plan_where_it_can(todo, here, obstacles, plan_over)
        return None if plan is None else _points_of(plan)

    def _worth_a_round(
        self,
        stage: Stage,
        left: Mask,
        missed: float,
        here: Pose,
        obstacles: list[RoundObstacle],
        plan_over: PlanOver,
    ) -> Mask:
        """Return what is planned of the floor that is ``left`` of a stage, ``missed`` m2.

        In the first round that is all of it, in a plan that is made anew its large patches, and
        later what is worth a way of its own.
        """
        ledger, config, at = self.ledger, self._config, (here.x, here.y)
        if self._rounds.take_anew():
            large = self._large(left, config.least_for_round)
            if large.any():
                return large
        if self._rounds.is_first:
            return left
        self.is_again = True
        reachable = floor_in_reach(self._context, at, obstacles)
        if may_be_opened(left & ~reachable, self._context, obstacles, config.least_area_to_retry):
            self._unreachable = True
        left &= reachable & ~rounded_off(self._context, at, obstacles)
        wanted = int(np.count_nonzero(stage.floor & reachable))
        worth = worth_another_round(left, wanted, ledger.coverage.frame, plan_over, config)
        return worth & (not self._rounds.is_over(missed))

    def _dirty_at_the_end(
        self, stage: Stage, here: Pose, obstacles: list[RoundObstacle], plan_over: PlanOver
    ) -> Mask:
        """Return the dirty floor of a stage that is swept again, once, at the stage's end."""
        if self._rounds.is_first or self._scrubbed:
            return np.zeros(stage.floor.shape, np.bool_)
        self._scrubbed = True
        reachable = self._context.reachable((here.x, here.y), obstacles)
        return self._second_pass.at_the_end(stage.floor, reachable, plan_over)

    def _plan_where_it_can(
        self, todo: Mask, here: Pose, obstacles: list[RoundObstacle], plan_over: PlanOver
    ) -> CoveragePlan | None:
        """Plan a round over ``todo``, or over its part in reach if no way leads on.

        None if that part is small.

        Raises NoPathError while the robot is to try to get out first.
        """
        at = (here.x, here.y)
        try:
            return self._planned(todo, here, obstacles, plan_over)
        except NoPathError:
            self._unreachable = True
            todo &= self._context.reachable(at, obstacles)
            if patches_of(todo, self.ledger.coverage.frame, self._config.least_area_to_retry):
                # The way home is shut, perhaps by a door: meanwhile it cleans where it is.
                return self._context.coverage.plan(
                    at, None, todo, obstacles, edges_only=self.ledger.edges_only
                )
            if self._rounds.count_way_out():
                self._rounds.take_back()
                raise
            return None

    def _planned(
        self, todo: Mask, here: Pose, obstacles: list[RoundObstacle], plan_over: PlanOver
    ) -> CoveragePlan:
        """Plan over ``todo``; slivers beside the rest of the path before may be left out.

        Raises NoPathError.
        """
        rest, self._rest = self._rest, None
        if rest is None:
            return plan_over(todo)
        frame, config = self.ledger.coverage.frame, self._config
        floor = todo & self._context.reachable((here.x, here.y), obstacles)
        slivers = slivers_of(floor, self.ledger.coverage.along(rest), frame, config.least_for_round)
        planned = Path(rest).length
        return plan_worth_its_way(plan_over, todo, slivers, frame, config.worth_way, planned)

    def _large(self, floor: Mask, least: float) -> Mask:
        """Return what of a floor is in patches of ``least`` m2 or more."""
        return large_regions(floor, self.ledger.coverage.frame.resolution, least)

    def _plan_over(
        self, stage: Stage, todo: Mask, here: Pose, obstacles: list[RoundObstacle]
    ) -> CoveragePlan:
        """Plan over floor of a stage, and on to where the next part begins."""
        return self._context.plan_coverage(
            (here.x, here.y),
            todo,
            obstacles,
            edges_only=self.ledger.edges_only,
            end=self.ledger.way_out_of(stage),
        )

    def _next_stage(self) -> None:
        self.ledger.next_stage()
        self.begin_room()

    def _count_passes(self) -> None:
        wanted = self.ledger.coverage.wanted_cells
        asked = sum(stage.cells for stage in self.ledger.stages)
        self.mean_passes = (
            asked / wanted if wanted and not self.explores else self.ledger.request.passes
        )

    def _begin_stage(self, *, is_driven: bool = False) -> None:
        self._rounds.begin_stage(is_driven=is_driven)
        self._scrubbed = self.is_again = False
        self._rest = None


def _points_of(plan: CoveragePlan) -> Floats | None:
    """Return the points of a plan, float64 [n, 2], m; None for one that sweeps nothing."""
    return plan.points if plan.length > 0.0 and len(plan.points) > 2 else None


def _why_nothing(context: PlanningContext) -> str:
    """Return why there is no floor to clean, and what to do."""
    if context.coverable().any():
        return (
            "expected floor that can be reached, got none: it is outside of the map, in furniture, "
            "or in a no-go zone"
        )
    return (
        "expected a way from the charging station onto the floor, got none: it faces what is "
        "solid, a no-go zone lies before it, or there is hardly more floor than it stands on; turn "
        "or move it, or the zone"
    )
