"""Straight walls aslant on a grid, against the shapes that the cells' shares were taken of."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.planning.path.straight_walls import has_shares, solid_parts

PARTS = 5
CELLS = 40
CLEAR = 0.1
"""cells; 5 mm: no floor is nearer to what is solid."""
SEEN = 0.65
"""cells; what is as far before a straight wall is floor, of parts that are 0.2 wide."""
ENDS = 5.0
"""cells; as near to its ends a wall is not known to be straight."""


def map_of(shape: shapely.Geometry) -> OccupancyMap:
    """The map of solid things: each cell with its share, rounded up as a turned home's is."""
    shapely.prepare(shape)
    columns, rows = np.meshgrid(np.arange(CELLS), np.arange(CELLS))
    cells = shapely.box(columns, rows, columns + 1, rows + 1)
    shares = shapely.area(shapely.intersection(cells, shape))
    values = np.ceil(OCCUPIED * shares - 1e-6).astype(np.int8)
    return OccupancyMap(GridFrame(0.05, -3.0, 2.0, CELLS, CELLS), values)


def parts_of(mask: NDArray[np.bool_]) -> NDArray[np.object_]:
    rows, columns = np.nonzero(mask)
    low, left = rows / PARTS, columns / PARTS
    squares: NDArray[np.object_] = shapely.box(left, low, left + 1 / PARTS, low + 1 / PARTS)
    return squares


def floor_found(made: OccupancyMap) -> NDArray[np.bool_]:
    coarse = np.repeat(np.repeat(made.solid, PARTS, axis=0), PARTS, axis=1)
    return coarse & ~solid_parts(made, PARTS)


def turned_box(width: float, depth: float, degrees: float) -> shapely.Geometry:
    middle = 0.5 * CELLS + 0.21
    box = shapely.box(-0.5 * width, -0.5 * depth, 0.5 * width, 0.5 * depth)
    turned = shapely.affinity.rotate(box, degrees, origin=(0.0, 0.0))
    moved: shapely.Geometry = shapely.affinity.translate(turned, middle, middle)
    return moved


@pytest.mark.parametrize("degrees", [3.0, 8.0, 17.0, 30.0, 45.0, 60.0, 88.0, 135.0, 200.0])
def test_before_a_straight_wall_cells_are_floor_and_no_floor_is_near_it(degrees: float) -> None:
    box = turned_box(20.0, 14.0, degrees)
    made = map_of(box)
    assert shapely.distance(parts_of(floor_found(made)), box).min() >= CLEAR
    left = parts_of(solid_parts(made, PARTS))
    corners = shapely.MultiPoint(box.exterior.coords)
    left = left[shapely.distance(left, corners) > ENDS]
    assert max(shapely.distance(shapely.centroid(left), box)) < SEEN


@pytest.mark.parametrize("degrees", [8.0, 17.0, 30.0, 45.0, 110.0])
@pytest.mark.parametrize("width", [0.5, 1.0, 1.3, 2.0, 3.0, 5.0])
def test_no_thing_is_made_smaller(width: float, degrees: float) -> None:
    """Legs, panels, boxes, and things with corners between their sides."""
    for depth in (width, 20.0):
        box = turned_box(width, depth, degrees)
        floor = parts_of(floor_found(map_of(box)))
        assert len(floor) == 0 or shapely.distance(floor, box).min() >= CLEAR


@pytest.mark.parametrize("degrees", [8.0, 17.0, 30.0, 45.0, 58.0])
def test_where_walls_meet_no_floor_is_in_the_other_one(degrees: float) -> None:
    """At all places of the corner within a cell."""
    for shift in np.linspace(0.0, 0.9, 7):
        walls = shapely.union(shapely.box(-15, -3, 15, 0), shapely.box(-3, -3, 0, 12))
        turned = shapely.affinity.rotate(walls, degrees, origin=(0.0, 0.0))
        both = shapely.affinity.translate(turned, 20.0 + shift, 18.0 + 0.4 * shift)
        floor = parts_of(floor_found(map_of(both)))
        assert shapely.distance(floor, both).min() >= CLEAR


def test_round_things_keep_their_distance() -> None:
    for radius in (1.0, 4.0, 8.0, 15.0):
        disc = shapely.Point(20.3, 19.8).buffer(radius, quad_segs=64)
        floor = parts_of(floor_found(map_of(disc)))
        assert len(floor) == 0 or shapely.distance(floor, disc).min() >= CLEAR


def test_what_is_not_known_is_no_floor() -> None:
    box = turned_box(20.0, 14.0, 17.0)
    made = map_of(box)
    values = made.values.copy()
    beside = np.zeros_like(made.solid)
    beside[1:] |= made.solid[:-1]
    values[beside & (values == FREE)] = UNKNOWN
    found = floor_found(OccupancyMap(made.frame, values))
    whole = np.repeat(np.repeat(values == UNKNOWN, PARTS, axis=0), PARTS, axis=1)
    assert not (found & whole).any()


def test_a_map_without_shares_is_what_it_is() -> None:
    made = map_of(shapely.box(5.0, 5.0, 30.0, 12.0))
    assert not has_shares(made)
    assert not floor_found(made).any()
    assert has_shares(map_of(shapely.box(5.0, 5.0, 30.0, 12.5)))


def test_a_wall_along_the_axes_stays_as_it_is() -> None:
    """It has no steps, and glass or a mirror that stands so is kept away from as before."""
    assert not floor_found(map_of(shapely.box(5.0, 5.0, 30.0, 12.5))).any()
