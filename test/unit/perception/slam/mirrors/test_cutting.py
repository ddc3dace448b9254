"""Beams that pass a mirror end on it; those that pass just beside it are left out."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.arrays import Floats32
from roomba.perception.slam.mirrors.cutting import cut_at

MIRROR = np.array([[[2.0, -0.5], [2.0, 0.5]]])
"""1 m of it, 2 m ahead of (0, 0)."""
HERE, LIDAR = np.zeros(3), np.zeros(2)
NO_WAYS = np.zeros((0, 2), np.float32)
places, headings = st.floats(-5.0, 5.0), st.floats(-math.pi, math.pi)


def point(x: float, y: float) -> Floats32:
    return np.array([[x, y, -1.0, 0.0]], np.float32)


def test_a_beam_that_passes_ends_on_it_and_faces_the_lidar() -> None:
    points, _ = cut_at(MIRROR, HERE, LIDAR, point(4.0, 0.4), NO_WAYS)
    assert points == pytest.approx(np.array([[2.0, 0.2, -1.0, 0.0]]))


def test_what_is_before_it_and_what_is_beside_it_stay() -> None:
    for x, y in ((1.9, 0.0), (4.0, 1.5), (-3.0, 0.0)):
        given_points = point(x, y)
        points, ways = cut_at(MIRROR, HERE, LIDAR, given_points, NO_WAYS)
        assert points is given_points
        assert ways is NO_WAYS


def test_a_beam_that_passes_just_beside_it_is_left_out() -> None:
    # At x = 2 it is 5 cm beside the end.
    points, _ = cut_at(MIRROR, HERE, LIDAR, np.vstack((point(4.0, 1.1), point(1.0, 0.0))), NO_WAYS)
    assert points == pytest.approx(point(1.0, 0.0))


def test_open_ways_end_on_it_too() -> None:
    ways = np.array([[4.0, 0.4], [1.0, 0.0]], np.float32)
    _, after = cut_at(MIRROR, HERE, LIDAR, point(1.0, 0.0), ways)
    assert after == pytest.approx(np.array([[2.0, 0.2], [1.0, 0.0]]))
    assert after.dtype == np.float32


def test_of_two_mirrors_the_nearer_one_counts() -> None:
    both = np.concatenate((MIRROR + np.array([1.0, 0.0]), MIRROR))
    points, _ = cut_at(both, HERE, LIDAR, point(4.0, 0.4), NO_WAYS)
    assert points[0, :2] == pytest.approx((2.0, 0.2))


def test_without_mirrors_all_is_as_it_was() -> None:
    given_points = point(4.0, 0.4)
    assert cut_at(np.zeros((0, 2, 2)), HERE, LIDAR, given_points, NO_WAYS)[0] is given_points


@given(
    places, places, st.floats(-math.pi, math.pi), st.lists(st.tuples(places, places), max_size=9)
)
def test_from_wherever_it_is_seen_nothing_is_behind_it(
    x: float, y: float, theta: float, ends: list[tuple[float, float]]
) -> None:
    pose, lidar = np.array([x, y, theta]), np.array([0.1, -0.05])
    points = np.array([(*end, 0.0, 0.0) for end in ends], np.float32).reshape(-1, 4)
    cut, _ = cut_at(MIRROR, pose, lidar, points, NO_WAYS)
    assert len(cut) <= len(points)
    start = on_map(pose, lidar[None])[0]
    for end in on_map(pose, np.asarray(cut[:, :2], np.float64)):
        share = (2.0 - start[0]) / (end[0] - start[0]) if end[0] != start[0] else math.inf
        place = start[1] + share * (end[1] - start[1])
        assert not (0.0 < share < 0.999 and abs(place) < 0.499)


def on_map(pose: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points of the robot's frame on the map, [n, 2]."""
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    turned: NDArray[np.float64] = points @ np.array([[cosine, sine], [-sine, cosine]]) + pose[:2]
    return turned
