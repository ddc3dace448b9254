"""A stage of the caller's replaces ours, and no other stage."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from fixtures.homes.planned_rooms import room

from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.coverage.planner import CoveragePlanner
from roomba.planning.coverage.stages import OUR_STAGES, CoverageStages

NAMES = [field.name for field in fields(CoverageStages)]
FLOOR = room((0.0, 0.0, 1.0, 0.5))


def plan_by(stages: CoverageStages) -> CoveragePlan:
    planner = CoveragePlanner(FLOOR, 0.169, 0.2, 0.5, CoverageConfig(), stages)
    return planner.plan((-0.5, -1.5), (-0.5, -1.5))


@pytest.mark.parametrize("name", NAMES)
def test_each_stage_is_called_once_a_plan(name: str) -> None:
    calls: list[str] = []
    ours: Callable[..., Any] = getattr(OUR_STAGES, name)

    def counted(*arguments: Any) -> Any:
        calls.append(name)
        return ours(*arguments)

    plan = plan_by(replace(OUR_STAGES, **{name: counted}))
    assert calls == [name]
    assert np.array_equal(plan.points, plan_by(OUR_STAGES).points)


def test_a_stage_of_ones_own_decides() -> None:
    without = plan_by(replace(OUR_STAGES, swaths=lambda *_: []))
    ours = plan_by(OUR_STAGES)
    assert without.swaths == ()
    assert len(ours.swaths) > 3
    assert without.length < ours.length


def test_before_each_stage_it_is_told_that_the_plan_goes_on() -> None:
    calls: list[int] = []
    plan = plan_by(OUR_STAGES.telling(lambda: calls.append(len(calls))))
    assert len(calls) == len(NAMES)
    assert np.array_equal(plan.points, plan_by(OUR_STAGES).points)
