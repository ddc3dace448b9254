"""Looks into a surface field, and how far rays go in it, against geometry that shares no code."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.references.slow_lidar import ranges_to_cells
from fixtures.references.sphere_traced import expected_range
from fixtures.robots.located import FURNISHED, free_poses
from hypothesis import given
from hypothesis import strategies as st

from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.matching.field_kernels import OFF_MAP, look
from roomba.perception.matching.surface_field import SurfaceField

STEP = 1e-4
"""m; of finite differences."""
FIELD = SurfaceField.of(FURNISHED.map)
X_MIN, X_MAX, Y_MIN, Y_MAX = FURNISHED.frame.extent
HALF = 0.5 * FURNISHED.frame.resolution


def look_at(field: SurfaceField, x: float, y: float) -> tuple[float, float, float]:
    distance, slope_x, slope_y = look(field.values, field.place, x, y)
    return distance, slope_x, slope_y


def range_from(field: SurfaceField, x: float, y: float, angle: float, most: float) -> float:
    return expected_range(field, x, y, math.cos(angle), math.sin(angle), most)


def walled(thickness: int) -> SurfaceField:
    """A wall from x = 1 m on, so many cells of 5 cm thick."""
    values = np.full((40, 60), FREE, np.int8)
    values[:, 20 : 20 + thickness] = OCCUPIED
    return SurfaceField.of(OccupancyMap(GridFrame(0.05, 0.0, 0.0, 40, 60), values))


@given(st.floats(0.03, 1.97), st.integers(1, 8), st.floats(0.1, 1.9))
def test_on_both_sides_of_a_wall_it_is_the_exact_distance(
    x: float, thickness: int, y: float
) -> None:
    behind = 1.0 + 0.05 * thickness
    distance, slope_x, slope_y = look_at(walled(thickness), x, y)
    if x < 1.0 + 0.024 or x > behind - 0.024:
        assert distance == pytest.approx(max(1.0 - x, x - behind), abs=1e-6)
        assert slope_y == pytest.approx(0.0, abs=1e-5)
    if x < 0.97 or x > behind + 0.03:
        assert slope_x == pytest.approx(-1.0 if x < 1.0 else 1.0, abs=1e-4)


@given(
    st.floats(X_MIN + HALF + STEP, X_MAX - HALF - 2.0 * STEP),
    st.floats(Y_MIN + HALF + STEP, Y_MAX - HALF - 2.0 * STEP),
)
def test_slopes_are_those_of_the_distances(x: float, y: float) -> None:
    distance, slope_x, slope_y = look_at(FIELD, x, y)
    # One-sided, away from the nearest line between cells, where slopes change.
    u, v = (x - FIELD.place[0]) / FIELD.place[2], (y - FIELD.place[1]) / FIELD.place[2]
    step_x = STEP if u % 1.0 < 0.5 else -STEP
    step_y = STEP if v % 1.0 < 0.5 else -STEP
    # Steps of float32 values: 1e-7 m of distance over 1e-4 m.
    assert slope_x == pytest.approx(
        (look_at(FIELD, x + step_x, y)[0] - distance) / step_x, abs=0.01
    )
    assert slope_y == pytest.approx(
        (look_at(FIELD, x, y + step_y)[0] - distance) / step_y, abs=0.01
    )


def test_at_the_middles_of_cells_it_is_their_value() -> None:
    rows, columns = FIELD.values.shape
    for row in range(0, rows - 1, 7):
        for column in range(0, columns - 1, 5):
            x, y = FIELD.frame.centre_of(row, column)
            found = look_at(FIELD, x + 1e-9, y + 1e-9)[0]
            assert found == pytest.approx(float(FIELD.values[row, column]), abs=1e-6)


@pytest.mark.parametrize(
    ("x", "y"),
    [
        (X_MIN - 0.01, 1.0),
        (X_MAX + 0.01, 1.0),
        (1.0, Y_MIN - 0.01),
        (1.0, Y_MAX + 0.01),
        (1e300, -1e300),
        (-math.inf, 1.0),
        (math.nan, 1.0),
        (1.0, math.nan),
    ],
)
def test_off_the_map_nothing_fits_and_nothing_pulls(x: float, y: float) -> None:
    assert look_at(FIELD, x, y) == (OFF_MAP, 0.0, 0.0)


def test_rays_end_where_plain_geometry_says() -> None:
    """Within 2 cm of what is seen there, or from 2 cm beside: corners are a little round."""
    solid, frame = FURNISHED.map.solid, FURNISHED.frame
    beams, off, astray, total = 120, 0, 0, 0
    shifts = (-0.02, 0.0, 0.02)
    for pose in free_poses(FURNISHED, 25, np.random.default_rng(2)):
        exact = ranges_to_cells(solid, frame, pose.x, pose.y, pose.theta, beams)
        beside = [
            ranges_to_cells(solid, frame, pose.x + dx, pose.y + dy, pose.theta, beams)
            for dx in shifts
            for dy in shifts
        ]
        least, most = np.min(beside, axis=0) - 0.02, np.max(beside, axis=0) + 0.02
        for beam in range(beams):
            angle = pose.theta + beam * 2.0 * math.pi / beams
            way = range_from(FIELD, pose.x, pose.y, angle, 12.0)
            astray += not least[beam] <= way <= most[beam]
            off += abs(way - exact[beam]) > 0.01
            total += 1
    # A beam that just misses one corner may just meet the next.
    assert astray <= 0.001 * total
    assert off < 0.05 * total


@given(st.floats(0.1, 0.9), st.floats(0.3, 1.7), st.floats(-0.7, 0.7), st.integers(1, 3))
def test_no_ray_goes_through_a_thin_wall(x: float, y: float, angle: float, thick: int) -> None:
    exact = (1.0 - x) / math.cos(angle)
    if 0.1 < y + exact * math.sin(angle) < 1.9:
        assert range_from(walled(thick), x, y, angle, 5.0) == pytest.approx(exact, abs=0.01)


def test_a_ray_goes_no_farther_than_it_is_asked_for_and_off_the_map_is_nothing() -> None:
    field = walled(2)
    assert range_from(field, 0.2, 1.0, 0.0, 0.5) == 0.5
    assert range_from(field, 0.2, 1.0, math.pi, 7.0) == 7.0
    assert range_from(field, -3.0, 1.0, 0.0, 9.0) == 9.0
    assert range_from(field, 0.2, 1.0, 0.0, 0.0) == 0.0


def test_a_ray_that_starts_inside_a_wall_has_met_it() -> None:
    assert range_from(walled(6), 1.15, 1.0, 0.0, 5.0) <= 0.0


def test_a_ray_along_a_wall_comes_to_its_end() -> None:
    assert range_from(walled(2), 0.9, 0.1, 0.5 * math.pi, 1.5) == 1.5
