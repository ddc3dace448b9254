"""The second pass over dirty floor: put into the path where it comes by, or planned at the end."""

from __future__ import annotations

import numpy as np

from roomba.arrays import Floats, Mask
from roomba.configuration.mission import CleaningConfig
from roomba.geometry import Point, RoundObstacle
from roomba.mission.cleaning.dirty.detour import with_detour
from roomba.mission.cleaning.dirty.dirty_floor import DirtyFloor, DirtyPatch
from roomba.mission.cleaning.ledger import CoverageLedger
from roomba.mission.cleaning.worth import PlanOver, is_worth_its_way, way_worth
from roomba.mission.inputs.planning_context import PlanningContext


class SecondPass:
    """Plans another sweep over dirty floor where that is worth the way, once a pass for a place."""

    def __init__(self, dirty: DirtyFloor, ledger: CoverageLedger, config: CleaningConfig) -> None:
        """Look at what ``dirty`` tells; the ``ledger`` is told what is swept anew."""
        self._dirty, self._ledger, self._config = dirty, ledger, config

    def at_hand(
        self,
        context: PlanningContext,
        here: Point,
        rest: Floats,
        obstacles: list[RoundObstacle],
        now: float,
    ) -> Floats | None:
        """Return a path that leads over dirty floor close by as well, float64 [n, 2], m, or None.

        That is floor of the present stage which was swept by ``now``, s. ``rest``, float64 [n, 2],
        m, is the path before the robot.
        """
        stage = self._ledger.stage
        assert stage is not None
        patches = self._dirty.at_hand(self._ledger.coverage, stage.floor, here, now)
        if not patches:
            return None
        obstacles = context.with_closed_gaps(obstacles)
        reachable = context.reachable(here, obstacles)
        path, again = np.vstack((here, rest)), None
        for patch in patches:
            floor = patch.floor & reachable
            longer = (
                self._with_detour(context, path, patch, floor, obstacles) if floor.any() else None
            )
            if longer is not None:
                path = again = longer
                self._dirty.note_again(patch)
                self._ledger.sweep_anew(floor)
        return again

    def at_the_end(self, floor: Mask, reachable: Mask, plan_over: PlanOver) -> Mask:
        """Return what of a floor, and of what is ``reachable``, is swept again at its end.

        All masks are bool over the coverage map. A patch is left out if a plan over it alone takes
        too long a way for its area.
        """
        coverage, worth = self._ledger.coverage, self._config.worth_way_again
        again = np.zeros(coverage.frame.shape, np.bool_)
        for patch in self._dirty.left(coverage, floor):
            dirty = patch.floor & reachable
            if dirty.any() and is_worth_its_way(plan_over, dirty, coverage.frame, worth):
                again |= dirty
        if again.any():
            self._ledger.sweep_anew(again)
        return again

    def _with_detour(
        self,
        context: PlanningContext,
        path: Floats,
        patch: DirtyPatch,
        floor: Mask,
        obstacles: list[RoundObstacle],
    ) -> Floats | None:
        """Return a path, float64 [n, 2], m, with a way over the ``floor`` of a patch put in.

        None if that is too long, or no way leads there.
        """
        ledger, config = self._ledger, self._config
        return with_detour(
            path,
            self._dirty.places_of(patch),
            lambda at: context.coverage.plan(
                at, at, floor, obstacles, edges_only=ledger.edges_only
            ),
            config.dirty_ahead,
            way_worth(floor, ledger.coverage.frame, config.worth_way_again),
        )
