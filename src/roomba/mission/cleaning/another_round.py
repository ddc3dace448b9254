"""Another round over a stage: which of the floor that the last round left is worth it."""

from __future__ import annotations

import numpy as np

from roomba.arrays import Mask
from roomba.configuration.mission import CleaningConfig
from roomba.geometry import Point, RoundObstacle
from roomba.grid import GridFrame
from roomba.mission.cleaning.missed import is_hidden
from roomba.mission.cleaning.worth import PlanOver, is_worth_its_way
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.coverage_map import patches_of
from roomba.planning.path.planner import NoPathError
from roomba.raster.regions import large_regions


def floor_in_reach(context: PlanningContext, here: Point, obstacles: list[RoundObstacle]) -> Mask:
    """Return the floor that can be reached from before the station, bool over ``context.frame``.

    A robot that is shut in elsewhere can clean there, and has to get out from there: then that
    floor counts as well.
    """
    frame = context.frame
    reachable = context.reachable((context.staging.x, context.staging.y), obstacles)
    if not (frame.contains(*here) and reachable[frame.cell_of(*here)]):
        reachable |= context.reachable(here, obstacles)
    return reachable


def may_be_opened(
    floor: Mask, context: PlanningContext, obstacles: list[RoundObstacle], least: float
) -> bool:
    """Whether a person may open the way to a ``floor`` that is out of reach.

    That is so if at least one of its patches of ``least`` m2 or more is not just hidden by things
    that stand on it or before it.
    """
    patches = patches_of(floor, context.frame, least)
    return not all(is_hidden(patch, context, obstacles) for patch in patches)


def rounded_off(context: PlanningContext, here: Point, obstacles: list[RoundObstacle]) -> Mask:
    """Return the floor that another plan would leave as well, bool over ``context.frame``."""
    try:
        return context.coverage.rounded_off(here, obstacles)
    except NoPathError:
        return np.zeros(context.frame.shape, np.bool_)


def worth_another_round(
    left: Mask, wanted: int, frame: GridFrame, plan_over: PlanOver, config: CleaningConfig
) -> Mask:
    """Return the patches of what is ``left`` if they are worth a way of their own, else none.

    Masks are bool over ``frame``. ``wanted`` is how many cells of the stage can be reached. Once
    enough of them are clean, smaller patches are left out, and less way is worth it.
    """
    is_enough = 1.0 - np.count_nonzero(left) / max(wanted, 1) >= config.enough
    least = config.least_for_round if is_enough else config.least_patch
    worth = config.worth_way if is_enough else config.worth_way_to_enough
    patches = large_regions(left, frame.resolution, least)
    return patches & (patches.any() and is_worth_its_way(plan_over, patches, frame, worth))
