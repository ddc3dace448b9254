"""Missed floor by size, and whether it is worth the way that it takes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask
from roomba.grid import GridFrame
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.path.planner import NoPathError
from roomba.raster.distance import distance_to_nearest
from roomba.raster.regions import large_regions, numbered_regions

_TOGETHER: Final = 0.5
"""Share of the ways to each sliver by itself that all take together at most: one way passes many.
In 21 plans of homes with things that the map does not show it was 0.01 to 0.46."""

PlanOver = Callable[[Mask], CoveragePlan]
"""Plans a way over a floor, bool over a frame, and on; raises NoPathError."""


def made_once(plan_over: PlanOver) -> PlanOver:
    """Return the same, which makes the plan over each floor once."""
    plans: dict[bytes, CoveragePlan] = {}

    def over(floor: Mask) -> CoveragePlan:
        key = floor.tobytes()
        if key not in plans:
            plans[key] = plan_over(floor)
        return plans[key]

    return over


def slivers_of(floor: Mask, ahead: Mask, frame: GridFrame, least: float) -> Mask:
    """Return what of a floor is not ``ahead`` and in patches of less than ``least`` m2.

    All bool over ``frame``; ``ahead`` is what the rest of a path sweeps. Beside swaths that were
    driven slivers are left, a cell wide. What is ahead is as wide as the swaths over it: with a
    sliver beside it it takes one more.
    """
    behind = floor & ~ahead
    return behind & ~large_regions(behind, frame.resolution, least)


def plan_worth_its_way(
    plan_over: PlanOver, floor: Mask, slivers: Mask, ahead: Mask, frame: GridFrame, worth: float
) -> CoveragePlan:
    """Return a plan over a floor, or over it but for ``slivers``; all bool over ``frame``.

    These are left where they take more way than ``worth`` m for each m2, unless they are all. Where
    most lie beside what the rest of a path sweeps, ``ahead``, that needs no second plan. Raises
    NoPathError.
    """
    plan, rest = plan_over(floor), floor & ~slivers
    if not (slivers.any() and rest.any()):
        return plan
    worth_of_all = way_worth(slivers, frame, worth)
    if way_at_most(slivers, ahead, frame) <= worth_of_all:
        return plan
    shorter = plan_over(rest)
    return plan if plan.length - shorter.length <= worth_of_all else shorter


def way_at_most(slivers: Mask, ahead: Mask, frame: GridFrame) -> float:
    """Return how much longer slivers make a way at most, m; infinite where nothing is ``ahead``.

    Both bool over ``frame``. Each by itself takes the way from what is ahead, along it and back.
    """
    labels = numbered_regions(slivers)
    rows, columns = np.nonzero(slivers)
    number = labels[rows, columns]
    away = np.full(number.max(initial=0) + 1, np.inf)
    np.minimum.at(away, number, distance_to_nearest(ahead)[rows, columns])
    height, width = _extents(rows, number, away.size), _extents(columns, number, away.size)
    is_sliver = np.bincount(number, minlength=away.size) > 0
    ways = 2.0 * away + np.hypot(height, width)
    return _TOGETHER * float(ways[is_sliver].sum()) * frame.resolution


def _extents(values: NDArray[np.int64], number: NDArray[np.int32], size: int) -> Floats:
    """Return how far apart the values of each number are, float64 [size]; of one value 0."""
    low, high = np.full(size, np.inf), np.full(size, -np.inf)
    np.minimum.at(low, number, values)
    np.maximum.at(high, number, values)
    extents: Floats = high - low
    return extents


def is_worth_its_way(plan_over: PlanOver, floor: Mask, frame: GridFrame, worth: float) -> bool:
    """Whether a way over a floor, bool over ``frame``, is longer than the way on alone by no more
    than ``worth`` m for each m2; also where no way is known."""
    try:
        way = plan_over(floor).length - plan_over(np.zeros_like(floor)).length
    except NoPathError:
        return True
    return way <= way_worth(floor, frame, worth)


def way_worth(floor: Mask, frame: GridFrame, worth: float) -> float:
    """Return how much way a floor, bool over ``frame``, is worth, m: ``worth`` m for each m2."""
    return worth * float(np.count_nonzero(floor)) * frame.resolution**2
