"""Places along a path."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.planning.path.polyline import Path

CORNER = Path(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 2.0]]))


def test_stations_and_length() -> None:
    assert CORNER.stations == pytest.approx([0.0, 2.0, 3.0, 3.0 + math.sqrt(2.0)])
    assert CORNER.length == pytest.approx(3.0 + math.sqrt(2.0))


def test_left_turns_are_positive_and_the_ends_do_not_turn() -> None:
    assert CORNER.corner_angles == pytest.approx([0.0, math.pi / 2, math.pi / 4, 0.0])
    right = Path(np.array([[0.0, 0.0], [-1.0, -0.5], [-1.0, 3.0]]))
    assert -math.pi < right.corner_angles[1] < 0.0


def test_points_are_found_by_their_arc_length() -> None:
    assert CORNER.point_at(0.5) == pytest.approx((0.5, 0.0))
    assert CORNER.point_at(2.5) == pytest.approx((2.0, 0.5))
    assert CORNER.point_at(-1.0) == pytest.approx((0.0, 0.0))
    assert CORNER.point_at(99.0) == pytest.approx((1.0, 2.0))


def test_projecting_looks_only_ahead_and_within_the_window() -> None:
    there_and_back = Path(np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 0.1], [0.0, 0.1]]))
    assert there_and_back.project(1.0, 0.09) == pytest.approx(1.0)
    assert there_and_back.project(1.0, 0.0, from_s=5.0, window=9.0) == pytest.approx(7.1)
    assert there_and_back.project(3.0, 0.0, from_s=1.0, window=0.5) == pytest.approx(1.5)
    assert there_and_back.project(0.0, 0.0, from_s=1.0, window=0.5) == pytest.approx(1.0)
    assert there_and_back.project(0.0, 0.0, from_s=99.0) == pytest.approx(there_and_back.length)


@given(st.floats(-1, 3), st.floats(-1, 3), st.floats(0, 5), st.floats(0, 5))
def test_nothing_in_the_window_is_nearer_than_the_projection(
    x: float, y: float, from_s: float, window: float
) -> None:
    s = CORNER.project(x, y, from_s, window)
    assert min(from_s, CORNER.length) - 1e-9 <= s <= min(from_s + window, CORNER.length) + 1e-9
    nearest = math.dist(CORNER.point_at(s), (x, y))
    for other in np.linspace(from_s, from_s + window, 200):
        assert math.dist(CORNER.point_at(float(other)), (x, y)) >= nearest - 1e-9


def test_a_path_may_be_a_single_point() -> None:
    path = Path(np.array([[1.0, 2.0]]))
    assert path.length == 0.0
    assert path.point_at(3.0) == (1.0, 2.0)
    assert path.project(7.0, 7.0) == 0.0
    assert path.corner_angles.tolist() == [0.0]


@pytest.mark.parametrize("shape", [(0, 2), (3,), (2, 3)])
def test_points_of_another_shape_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="expected points of shape"):
        Path(np.zeros(shape))


def test_a_path_cannot_be_changed() -> None:
    with pytest.raises(ValueError, match="read-only"):
        CORNER.points[0, 0] = 5.0
