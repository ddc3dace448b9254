"""Distances to the surfaces of a map, against plain geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray
from shapely.affinity import rotate

from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.matching.surface_field import SurfaceField

Mask = NDArray[np.bool_]


def field_of(solid: Mask, resolution: float = 0.05) -> SurfaceField:
    frame = GridFrame(resolution, -1.3, 0.7, *solid.shape)
    values = np.where(solid, OCCUPIED, FREE).astype(np.int8)
    return SurfaceField.of(OccupancyMap(frame, values))


@pytest.mark.parametrize("resolution", [0.02, 0.05, 0.1])
@pytest.mark.parametrize("is_along_x", [True, False])
def test_it_is_exact_at_a_flat_wall(resolution: float, is_along_x: bool) -> None:
    solid = np.zeros((30, 40), np.bool_)
    solid[:7] = True
    middles = (np.arange(30) + 0.5 - 7.0) * resolution
    values = field_of(solid if is_along_x else solid.T, resolution).values
    values = values if is_along_x else values.T
    assert values == pytest.approx(np.broadcast_to(middles[:, None], values.shape), abs=1e-6)


def test_a_wall_of_one_cell_has_a_surface_on_each_side() -> None:
    solid = np.zeros((9, 20), np.bool_)
    solid[:, 10] = True
    row = field_of(solid, 0.1).values[4]
    assert row[8:13] == pytest.approx([0.15, 0.05, -0.05, 0.05, 0.15])


SMALL_MAPS = st.tuples(st.integers(2, 12), st.integers(2, 12)).flatmap(
    lambda shape: hnp.arrays(np.bool_, shape, elements=st.integers(0, 3).map(lambda n: n == 0))
)


@given(SMALL_MAPS, st.sampled_from((0.02, 0.05, 0.25)))
@settings(max_examples=examples(60))
def test_no_middle_is_farther_off_than_half_the_diagonal_of_a_cell(
    solid: Mask, resolution: float
) -> None:
    field = field_of(solid, resolution)
    far = max(solid.shape) * resolution
    for own in (True, False):
        kind = solid == own
        squares = shapely.union_all(
            [
                shapely.box(
                    x - 0.5 * resolution,
                    y - 0.5 * resolution,
                    x + 0.5 * resolution,
                    y + 0.5 * resolution,
                )
                for x, y in (field.frame.centre_of(r, c) for r, c in np.argwhere(~kind))
            ]
        )
        for row, column in np.argwhere(kind).tolist():
            value = float(field.values[row, column])
            if squares.is_empty:
                assert value == pytest.approx(-far if own else far)
                continue
            true = squares.distance(shapely.Point(field.frame.centre_of(row, column)))
            assert (value < 0.0) == own
            # Between the middle of a square and its corner: exact on walls, too far off corners.
            assert (
                true - 1e-6 <= abs(value) <= true + 0.5 * (math.sqrt(2.0) - 1.0) * resolution + 1e-6
            )


def test_a_spot_that_is_unknown_is_as_the_known_cell_nearest_to_it() -> None:
    """On the floor it is floor, and in a wall it closes the gap."""
    values = np.full((7, 12), FREE, np.int8)
    values[:, 8], values[:, 9:] = OCCUPIED, UNKNOWN
    values[3, 3] = values[3, 4] = values[2, 8] = UNKNOWN
    field = SurfaceField.of(OccupancyMap(GridFrame(0.1, 0.0, 0.0, 7, 12), values))
    expected = [0.05 * (2 * (8 - column) - 1) for column in range(12)]
    assert field.values == pytest.approx(np.tile(expected, (7, 1)))


def test_a_larger_area_that_is_unknown_is_solid() -> None:
    values = np.full((9, 20), FREE, np.int8)
    values[:, 10:] = UNKNOWN
    field = SurfaceField.of(OccupancyMap(GridFrame(0.1, 0.0, 0.0, 9, 20), values))
    assert field.values[4] == pytest.approx(0.1 * (9.5 - np.arange(20)))


@pytest.mark.parametrize("is_solid", [True, False])
def test_a_map_without_a_surface_is_far_and_finite_everywhere(is_solid: bool) -> None:
    values = field_of(np.full((4, 7), is_solid), 0.1).values
    assert values == pytest.approx(np.full((4, 7), -0.7 if is_solid else 0.7))


@given(SMALL_MAPS, st.sampled_from((0.02, 0.05, 0.25)), st.floats(0.01, 0.4))
def test_near_surfaces_it_is_the_same_and_nowhere_farther(
    solid: Mask, resolution: float, farthest: float
) -> None:
    frame = GridFrame(resolution, -1.3, 0.7, *solid.shape)
    occupancy = OccupancyMap(frame, np.where(solid, OCCUPIED, FREE).astype(np.int8))
    near = SurfaceField.near(occupancy, farthest)
    assert near.frame == frame
    assert near.values.dtype == np.float32
    if solid.any() and not solid.all():
        whole = SurfaceField.of(occupancy).values
        assert np.array_equal(near.values, np.clip(whole, -farthest, farthest, dtype=np.float32))
    else:
        assert np.abs(near.values) == pytest.approx(farthest)
        assert np.array_equal(near.values < 0.0, solid)


def test_kernels_are_told_where_the_first_middle_is() -> None:
    field = field_of(np.zeros((4, 7), np.bool_), 0.1)
    assert field.place == pytest.approx([*field.frame.centre_of(0, 0), 0.1])
    assert field.values.dtype == np.float32
    assert field.values.flags.c_contiguous


@given(st.floats(-math.pi, math.pi), st.floats(-0.3, 0.3))
@settings(max_examples=examples(30), deadline=None)
def test_a_slanted_wall_lies_where_the_shares_of_its_cells_say(angle: float, off: float) -> None:
    frame = GridFrame(0.05, -1.0, -1.0, 40, 40)
    normal = np.array([math.cos(angle), math.sin(angle)])
    wall = rotate(shapely.box(off, -9.0, off + 9.0, 9.0), angle, (0.0, 0.0), use_radians=True)
    x, y = np.meshgrid(*frame.centres())
    cells = shapely.box(x - 0.025, y - 0.025, x + 0.025, y + 0.025)
    share = shapely.area(shapely.intersection(cells, wall)) / frame.resolution**2
    values = np.ceil(OCCUPIED * share - 1e-9).clip(FREE, OCCUPIED).astype(np.int8)
    field = SurfaceField.of(OccupancyMap(frame, values))
    along = np.linspace(-0.6, 0.6, 200)
    points = off * normal + along[:, None] * np.array([-normal[1], normal[0]])
    inside = np.abs(points).max(axis=1) < 0.9
    found = np.array([bilinear(field, *point) for point in points[inside].tolist()])
    assert np.abs(found).max() < 0.012
    assert abs(float(found.mean())) < 0.004


def bilinear(field: SurfaceField, x: float, y: float) -> float:
    """Return the field between its middles, in the plainest way."""
    left, bottom, size = field.place.tolist()
    u, v = (x - left) / size, (y - bottom) / size
    column, row = math.floor(u), math.floor(v)
    u, v = u - column, v - row
    low = (1.0 - u) * field.values[row, column] + u * field.values[row, column + 1]
    high = (1.0 - u) * field.values[row + 1, column] + u * field.values[row + 1, column + 1]
    return float((1.0 - v) * low + v * high)


def test_what_a_map_does_not_know_for_sure_is_no_wall() -> None:
    values = np.zeros((9, 20), np.int8)
    values[:, 0] = OCCUPIED
    sure = SurfaceField.of(OccupancyMap(GridFrame(0.1, 0.0, 0.0, 9, 20), values)).values
    unsure = values.copy()
    unsure[4, 10] = 30
    field = SurfaceField.of(OccupancyMap(GridFrame(0.1, 0.0, 0.0, 9, 20), unsure))
    assert field.values.tolist() == sure.tolist()
