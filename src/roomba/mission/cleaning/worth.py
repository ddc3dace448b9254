"""Missed floor by size, and whether it is worth the way that it takes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from roomba.arrays import Mask
from roomba.grid import GridFrame
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.path.planner import NoPathError
from roomba.raster.regions import large_regions

PlanOver = Callable[[Mask], CoveragePlan]
"""Plans a way over a floor, bool over a frame, and on; raises NoPathError."""


def made_once(plan_over: PlanOver) -> PlanOver:
    """Return ``plan_over`` with a cache, which plans over each floor once."""
    plans: dict[bytes, CoveragePlan] = {}

    def over(floor: Mask) -> CoveragePlan:
        key = floor.tobytes()
        if key not in plans:
            plans[key] = plan_over(floor)
        return plans[key]

    return over


def slivers_of(floor: Mask, ahead: Mask, frame: GridFrame, least: float) -> Mask:
    """Return what of a floor is not ``ahead`` and in patches of less than ``least`` m2.

    All bool over ``frame``; ``ahead`` is what the rest of a path sweeps. Swaths that were driven
    leave slivers beside them, a cell wide. Floor ahead is as wide as the swaths that are planned
    over it: with a sliver beside it, it would take one swath more.
    """
    behind = floor & ~ahead
    return behind & ~large_regions(behind, frame.resolution, least)


def plan_worth_its_way(
    plan_over: PlanOver,
    floor: Mask,
    slivers: Mask,
    frame: GridFrame,
    worth: float,
    planned: float,
) -> CoveragePlan:
    """Return a plan over a floor, bool over ``frame``, with or without its ``slivers``.

    The slivers are left out where they take more way than ``worth`` m for each m2, unless they are
    all there is. ``planned`` is the length, m, of the plan that this one replaces: a plan that is
    longer by no more than the slivers are worth is kept, and none without them is made. Raises
    NoPathError.
    """
    plan, rest = plan_over(floor), floor & ~slivers
    if not (slivers.any() and rest.any()):
        return plan
    worth_of_all = way_worth(slivers, frame, worth)
    if plan.length - planned <= worth_of_all:
        return plan
    shorter = plan_over(rest)
    return plan if plan.length - shorter.length <= worth_of_all else shorter


def is_worth_its_way(plan_over: PlanOver, floor: Mask, frame: GridFrame, worth: float) -> bool:
    """Whether a floor, bool over ``frame``, adds no more way than ``worth`` m for each m2.

    The way over it is compared with the way on alone. True also where no way is known.
    """
    try:
        way = plan_over(floor).length - plan_over(np.zeros_like(floor)).length
    except NoPathError:
        return True
    return way <= way_worth(floor, frame, worth)


def way_worth(floor: Mask, frame: GridFrame, worth: float) -> float:
    """Return how much way a floor, bool over ``frame``, is worth, m: ``worth`` m for each m2."""
    return worth * float(np.count_nonzero(floor)) * frame.resolution**2
