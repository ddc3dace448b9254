"""A path made ready: its legs, and how fast its corners may be taken."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.loops import TrackingConfig
from roomba.control.course import SHORTEST_LEG, course_of

CONFIG = TrackingConfig()


def path(*legs: tuple[float, float]) -> NDArray[np.float64]:
    """Return the points along legs: how much it turns before each, rad, and its length, m."""
    headings = itertools.accumulate(turn for turn, _ in legs)
    ways = [
        (way * math.cos(a), way * math.sin(a)) for a, (_, way) in zip(headings, legs, strict=True)
    ]
    return np.concatenate((np.zeros((1, 2)), np.cumsum(np.array(ways), axis=0)))


legs = st.lists(
    st.tuples(st.floats(-math.pi, math.pi), st.floats(0.001, 2.0)), min_size=1, max_size=12
)


@given(legs)
def test_legs_and_stations_are_those_of_the_path(legs: list[tuple[float, float]]) -> None:
    points = path(*legs)
    course = course_of(points, CONFIG)
    assert course.points == pytest.approx(points)
    assert np.diff(course.stations) == pytest.approx([way for _, way in legs])
    assert course.stations[0] == 0.0
    turns = [turn for turn, _ in legs]
    off = course.headings - np.cumsum(turns)
    assert np.cos(off) == pytest.approx(1.0)
    for name in ("through", "halves"):
        values = getattr(course, name)
        assert values.shape == (len(points),)
        assert (values >= 0.0).all()
        # It begins and ends standing.
        assert values[0] == values[-1] == 0.0


@given(legs)
def test_sharp_corners_are_stops_and_soft_ones_are_not(legs: list[tuple[float, float]]) -> None:
    course = course_of(path(*legs), CONFIG)
    for index, (turn, _) in enumerate(legs[1:], start=1):
        if abs(abs(turn) - CONFIG.sharp_corner) < 1e-6:
            continue
        is_soft = abs(turn) < CONFIG.sharp_corner
        assert (course.through[index] > 0.0) == is_soft
        assert (course.halves[index] > 0.0) == is_soft
        if is_soft:
            assert course.through[index] >= CONFIG.slowest_corner


@given(legs)
def test_rounded_corners_stay_near_and_never_overlap(legs: list[tuple[float, float]]) -> None:
    course = course_of(path(*legs), CONFIG)
    ways = np.diff(course.stations)
    assert (course.halves[:-1] + course.halves[1:] <= ways + 1e-9).all()
    turns = np.array([turn for turn, _ in legs[1:]])
    # An even change of heading over half a m before and after leaves a corner of a by a * half / 4.
    left = np.abs(turns) * course.halves[1:-1] / 4.0
    assert (left <= CONFIG.off_corner + 1e-12).all()


def test_the_softer_a_corner_the_faster() -> None:
    speeds = [
        float(course_of(path((0.0, 1.0), (turn, 1.0)), CONFIG).through[1])
        for turn in (0.05, 0.1, 0.2, 0.3)
    ]
    assert speeds == sorted(speeds, reverse=True)
    assert speeds[0] > 0.3
    assert speeds[-1] < speeds[0]


@given(st.floats(0.02, 0.34), st.floats(0.02, 1.0))
def test_the_turning_speed_in_a_corner_is_within_its_limit(turn: float, way: float) -> None:
    course = course_of(path((0.0, way), (turn, way)), CONFIG)
    curvature = turn / (2.0 * course.halves[1])
    turning = course.through[1] * curvature
    assert turning <= CONFIG.corner_turning + 1e-9 or course.through[1] == CONFIG.slowest_corner


def test_corners_close_together_count_for_how_the_curvature_changes() -> None:
    def speed(second: float) -> float:
        course = course_of(path((0.0, 1.0), (0.2, 0.03), (second, 1.0)), CONFIG)
        return float(course.through[1])

    # To the other side it changes twice as much.
    assert speed(-0.2) < speed(0.2)
    assert speed(0.2) >= float(course_of(path((0.0, 1.0), (0.2, 0.03)), CONFIG).through[1])


def test_points_that_are_nearly_the_same_are_one() -> None:
    points = np.array([(0.0, 0.0), (1.0, 0.0), (1.0 + 0.5 * SHORTEST_LEG, 0.0), (2.0, 0.0)])
    course = course_of(points, CONFIG)
    assert len(course.points) == 3
    assert course.stations[-1] == pytest.approx(2.0)
    assert len(course_of(points[:1], CONFIG).headings) == 0


def test_headings_are_compared_around_the_circle() -> None:
    # From nearly pi to nearly -pi is a soft corner to the left.
    points = path((math.pi - 0.05, 1.0), (0.1, 1.0))
    course = course_of(points, CONFIG)
    assert course.headings[0] > 3.0
    assert course.headings[1] < -3.0
    assert course.through[1] > CONFIG.slowest_corner
