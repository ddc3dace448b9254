"""A polished way, against its cost and what it sweeps reckoned anew."""

from __future__ import annotations

import numpy as np
from fixtures.references.drawn_ways import ways
from fixtures.references.straight_ways import (
    Mask,
    crosses_between_centres_that_fit,
    length_of,
    swept_cells,
    turning_of,
)
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.arrays import Polyline
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.tour.polish import polished

RADIUS, TURNING, FLOOR = 4.0, 6.0, 1.0
SPARE = 0.002
"""Share of the needed floor that may be left, as in the stage."""


def left(line: Polyline, need: Mask) -> int:
    """How many of the needed cells the line does not sweep."""
    return int((need & ~swept_cells(need.shape, [line], RADIUS)).sum())


def weights(turning: float, unswept: float = FLOOR) -> CoverageConfig:
    return CoverageConfig(polish_turning=turning, unswept=unswept, spare=SPARE)


def cost(line: Polyline, need: Mask, turning: float) -> float:
    return length_of(line) + turning * turning_of(line) + FLOOR * left(line, need)


@given(ways(), st.sampled_from([0.0, TURNING, 100.0]))
@settings(max_examples=examples(80))
def test_a_polished_way_costs_no_more_is_no_longer_and_leaves_hardly_more_floor(
    drawn: tuple[Mask, Polyline, Mask], turning: float
) -> None:
    fits, line, need = drawn
    found = polished(line.copy(), need, fits, RADIUS, weights(turning))
    assert np.array_equal(found[[0, -1]], line[[0, -1]])
    assert length_of(found) <= length_of(line) + 1e-6
    assert cost(found, need, turning) <= cost(line, need, turning) + 1e-6
    assert left(found, need) <= left(line, need) + int(SPARE * need.sum())
    # Legs of the line itself may be off its cells by what they were straightened.
    assert crosses_between_centres_that_fit(fits, found, 0.05)


def test_where_no_floor_counts_a_bend_in_the_open_vanishes() -> None:
    fits = np.ones((60, 60), np.bool_)
    line = np.array([[5.0, 5.0], [25.0, 40.0], [50.0, 5.0]])
    found = polished(line, np.zeros_like(fits), fits, RADIUS, weights(TURNING))
    assert length_of(found) <= 45.2
    assert turning_of(found) <= 0.2


def test_a_bend_that_sweeps_floor_of_its_own_stays() -> None:
    fits = np.ones((60, 60), np.bool_)
    line = np.array([[5.0, 5.0], [25.0, 40.0], [50.0, 5.0]])
    need = np.zeros_like(fits)
    need[30:44, 20:31] = True
    need &= swept_cells(need.shape, [line], RADIUS)
    found = polished(line, need, fits, RADIUS, weights(0.0, 1000.0))
    assert left(found, need) == 0
    assert found[:, 1].max() > 35.0


def test_a_way_without_bends_is_left_as_it_is() -> None:
    fits = np.ones((9, 9), np.bool_)
    for line in (np.array([[1.0, 2.0]]), np.array([[1.0, 2.0], [7.0, 3.0]])):
        assert np.array_equal(polished(line, fits, fits, RADIUS, weights(TURNING)), line)
