"""A plan's figures of its way, against sums over its legs."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.references.straight_ways import length_of, turning_of
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.planning.coverage.plan import CoveragePlan

POINTS = st.lists(
    st.tuples(st.integers(-50, 50), st.integers(-50, 50)), min_size=1, max_size=12, unique=True
)


@given(POINTS)
@settings(max_examples=examples(100))
def test_length_and_turning_are_sums_over_the_way(points: list[tuple[int, int]]) -> None:
    line = np.array(points, np.float64) / 10
    plan = CoveragePlan(line)
    assert plan.length == pytest.approx(length_of(line))
    assert plan.turning == pytest.approx(turning_of(line), abs=1e-6)
    assert np.array_equal(plan.path.points, line)


def test_a_plan_of_one_point_has_no_length() -> None:
    plan = CoveragePlan(np.array([[1.0, 2.0]]))
    assert (plan.length, plan.turning) == (0.0, 0.0)
    assert (plan.swaths, plan.edges) == ((), ())
