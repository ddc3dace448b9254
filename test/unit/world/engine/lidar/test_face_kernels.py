"""Faces of walls that are free of the grid, against plain geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.geometry import Point
from roomba.world.engine.lidar.face_kernels import mirrored, ray_to_faces, way_to_face
from roomba.world.engine.state.arrays import FACE, Row, Rows

place = st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
angles = st.floats(-math.pi, math.pi)


def faces_between(*ends: tuple[Point, Point]) -> Rows:
    faces = np.zeros(len(ends), FACE)
    for face, (right, left) in zip(faces, ends, strict=True):
        face["right_x"], face["right_y"] = right
        face["left_x"], face["left_y"] = left
    return faces.view(np.recarray)


@settings(max_examples=examples(100))
@given(place, place, place)
def test_the_way_to_a_face_is_the_shortest(point: Point, right: Point, left: Point) -> None:
    if math.dist(right, left) < 1e-3:
        return
    (face,) = faces_between((right, left))
    to_x, to_y = way_to_face(face, *point)
    line = shapely.LineString([right, left])
    away = shapely.distance(line, shapely.Point(point))
    assert math.hypot(to_x, to_y) == pytest.approx(away, abs=1e-9)
    end = shapely.Point(point[0] + to_x, point[1] + to_y)
    assert shapely.distance(line, end) == pytest.approx(0.0, abs=1e-9)


@settings(max_examples=examples(200))
@given(place, angles, st.lists(st.tuples(place, place), min_size=1, max_size=4))
def test_a_ray_meets_the_nearest_face_that_looks_at_it(
    start: Point, angle: float, ends: list[tuple[Point, Point]]
) -> None:
    if any(math.dist(right, left) < 0.05 for right, left in ends):
        return
    cosine, sine = math.cos(angle), math.sin(angle)
    ray = shapely.LineString([start, (start[0] + 20.0 * cosine, start[1] + 20.0 * sine)])
    expected, meets, edge = math.inf, -1, math.inf
    for index, (right, left) in enumerate(ends):
        met = shapely.intersection(ray, shapely.LineString([right, left]))
        for end in (right, left):
            edge = min(edge, shapely.distance(ray, shapely.Point(end)))
        # Its right end is to the right: from the start the ends turn counter-clockwise.
        turned = (right[0] - start[0]) * (left[1] - start[1]) - (right[1] - start[1]) * (
            left[0] - start[0]
        )
        if not met.is_empty and turned > 0.0:
            way = shapely.distance(shapely.Point(start), met)
            if way < expected:
                expected, meets = way, index
    if edge < 1e-6:
        return
    faces = faces_between(*ends)
    found, facing, index = ray_to_faces(faces, 0, len(ends), *start, cosine, sine, -1)
    assert found == pytest.approx(expected, abs=1e-6)
    assert index == meets
    if index >= 0:
        (right_x, right_y), (left_x, left_y) = ends[index]
        normal = math.atan2(right_x - left_x, left_y - right_y)
        assert facing == pytest.approx(abs(math.cos(angle - normal)), abs=1e-9)
        again, _, other = ray_to_faces(faces, 0, len(ends), *start, cosine, sine, index)
        assert other != index
        assert again >= found


@settings(max_examples=examples(50))
@given(angles, angles)
def test_a_mirror_sends_a_ray_on_at_the_angle_at_which_it_came(turn: float, angle: float) -> None:
    face: Row = faces_between(((0.0, 0.0), (2.0 * math.cos(turn), 2.0 * math.sin(turn))))[0]
    cosine, sine = mirrored(face, math.cos(angle), math.sin(angle))
    expected = 2.0 * turn - angle
    assert (cosine, sine) == pytest.approx((math.cos(expected), math.sin(expected)), abs=1e-9)
