"""Bends in place of corners, against what the ways sweep, cell by cell."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.references.drawn_ways import ways
from fixtures.references.straight_ways import (
    Mask,
    crosses_between_centres_that_fit,
    length_of,
    swept_cells,
)
from fixtures.thoroughness import examples
from hypothesis import given, settings

from roomba.angles import wrap_angles
from roomba.arrays import Floats, Polyline
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.tour.rounding import rounded

RADIUS = 5.0
UNSWEPT = 1.0
WORTH = 8.0
CONFIG = CoverageConfig(bend_worth=WORTH, bend_unswept=UNSWEPT, spare=0.02)
SHARP = 0.5
"""rad; sharper corners become bends."""


def turns(line: Polyline) -> Floats:
    ways = np.diff(line, axis=0)
    found: Floats = np.abs(wrap_angles(np.diff(np.arctan2(ways[:, 1], ways[:, 0]))))
    return found


def sharp(line: Polyline) -> int:
    return int((turns(line) > SHARP).sum())


def left(line: Polyline, need: Mask) -> int:
    return int((need & ~swept_cells(need.shape, [line], RADIUS)).sum())


@given(ways())
@settings(max_examples=examples(80))
def test_each_corner_that_goes_costs_no_more_than_it_is_worth(
    drawn: tuple[Mask, Polyline, Mask],
) -> None:
    fits, line, need = drawn
    found = rounded(line.copy(), need, fits, RADIUS, SHARP, CONFIG)
    assert np.array_equal(found[[0, -1]], line[[0, -1]])
    # Legs of the line itself may be off its cells by what they were straightened.
    assert crosses_between_centres_that_fit(fits, found, 0.05)
    gone = sharp(line) - sharp(found)
    assert gone >= 0
    cost = length_of(found) - length_of(line) + UNSWEPT * (left(found, need) - left(line, need))
    # Two corners may go at once, and points that do not bend the way went before.
    assert cost <= WORTH * max(gone, 0) + 0.1 * len(line)


def test_where_no_floor_counts_a_corner_becomes_the_widest_bend() -> None:
    fits = np.ones((60, 60), np.bool_)
    line = np.array([[5.0, 5.0], [50.0, 5.0], [50.0, 50.0]])
    found = rounded(line, np.zeros_like(fits), fits, RADIUS, SHARP, CONFIG)
    assert turns(found).max() < 0.25
    assert turns(found).sum() == turns(line).sum() == 0.5 * math.pi
    away = np.hypot(*(found[1:-1] - (50.0 - RADIUS, 5.0 + RADIUS)).T)
    assert np.all((away > RADIUS - 1e-9) & (away < 1.02 * RADIUS))


@pytest.mark.parametrize("apart", [5.0, 8.0, 10.0, 14.0])
@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0, -1.2])
def test_two_corners_become_bends_as_wide_as_there_is_room_between_them(
    apart: float, angle: float
) -> None:
    fits = np.ones((80, 80), np.bool_)
    along = np.array([math.cos(angle), math.sin(angle)])
    across = np.array([-along[1], along[0]])
    first, second = 40.0 - 20.0 * along, 40.0 + 10.0 * along
    line = np.array([first, second, second + apart * across, first + apart * across])
    found = rounded(line, np.zeros_like(fits), fits, RADIUS, SHARP, CONFIG)
    bend = min(RADIUS, 0.5 * apart)
    assert turns(found).max() < 0.25
    assert turns(found).sum() == pytest.approx(math.pi)
    way = 2.0 * (30.0 - bend) + apart - 2.0 * bend + math.pi * bend
    assert length_of(found) == pytest.approx(way, abs=0.002 * math.pi * bend)


def test_from_one_swath_to_the_next_it_is_a_half_circle_that_leaves_hardly_anything() -> None:
    fits = np.ones((60, 60), np.bool_)
    ends = 40.0
    line = np.array([[20.2, 5.0], [20.2, ends], [30.2, ends], [30.2, 5.0]])
    need = np.zeros_like(fits)
    need[5 : int(ends) + 1, 16:36] = True
    found = rounded(line, need, fits, RADIUS, SHARP, CONFIG)
    assert sharp(found) == 0
    assert found[:, 1].max() > ends
    cost = length_of(found) - length_of(line) + UNSWEPT * (left(found, need) - left(line, need))
    assert cost < WORTH
    # A bend within the corners alone leaves more.
    within = np.concatenate((line[:1], _half_circle(25.2, ends - RADIUS), line[-1:]))
    assert left(found, need) < left(within, need)


def _half_circle(x: float, y: float) -> Polyline:
    angles = np.linspace(math.pi, 0.0, 30)
    return np.column_stack((x + RADIUS * np.cos(angles), y + RADIUS * np.sin(angles)))


def test_a_corner_of_a_room_whose_floor_nothing_else_sweeps_stays() -> None:
    fits = np.zeros((60, 60), np.bool_)
    fits[5:51, 5:51] = True
    line = np.array([[5.0, 5.0], [50.0, 5.0], [50.0, 50.0]])
    need = swept_cells(fits.shape, [line], RADIUS)
    config = CoverageConfig(bend_worth=2.0, bend_unswept=1.0)
    found = rounded(line, need, fits, RADIUS, SHARP, config)
    assert np.array_equal(found, line)


def test_where_the_body_does_not_fit_there_is_no_bend() -> None:
    fits = np.zeros((60, 60), np.bool_)
    fits[5, 5:51] = fits[5:51, 50] = True
    line = np.array([[5.0, 5.0], [50.0, 5.0], [50.0, 50.0]])
    assert np.array_equal(rounded(line, np.zeros_like(fits), fits, RADIUS, SHARP, CONFIG), line)


def test_a_corner_that_is_rounded_off_while_driving_stays() -> None:
    fits = np.ones((60, 60), np.bool_)
    line = np.array([[5.0, 5.0], [30.0, 5.0], [50.0, 15.0]])
    need, turn = np.zeros_like(fits), float(turns(line)[0])
    assert np.array_equal(rounded(line, need, fits, RADIUS, 1.01 * turn, CONFIG), line)
    assert len(rounded(line, need, fits, RADIUS, 0.99 * turn, CONFIG)) > len(line)


def test_a_way_without_corners_is_left_as_it_is() -> None:
    fits = np.ones((9, 9), np.bool_)
    for line in (np.array([[1.0, 2.0]]), np.array([[1.0, 2.0], [7.0, 3.0]])):
        assert np.array_equal(rounded(line, fits, fits, RADIUS, SHARP, CONFIG), line)
