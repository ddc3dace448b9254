"""Smooth ways along slanted walls, against the exact distance to all cells of the wall."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import core_first
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.arrays import Floats, Polyline
from roomba.planning.coverage.floor.masks import grown, half_widths
from roomba.planning.coverage.passes.contours import outlines
from roomba.planning.coverage.passes.edges import rings, turning_of
from roomba.planning.coverage.passes.solid_cells import SolidCells
from roomba.planning.coverage.passes.stairs import along_stairs, smooth_ways

Mask = NDArray[np.bool_]

PARTS = 5
"""Fine cells to a side of the map's cells, as in a map of 5 cm."""
REACH = 16.5
NOTHING = np.zeros((0, 3))


def slanted(degrees: float, cells: int = 60) -> Mask:
    """Solid cells of a map, below and on a straight wall that leads through its middle."""
    corners = np.arange(cells + 1) - 0.5 * cells
    above = np.cos(math.radians(degrees)) * corners[:, None] - (
        math.sin(math.radians(degrees)) * corners
    )
    # A cell is free when all of its corners are above the wall.
    lowest = np.minimum(
        np.minimum(above[:-1, :-1], above[:-1, 1:]), np.minimum(above[1:, :-1], above[1:, 1:])
    )
    solid = lowest < 0.0
    return np.repeat(np.repeat(solid, PARTS, axis=0), PARTS, axis=1)


def fitting(solid: Mask) -> Mask:
    fenced = np.pad(solid, 1, constant_values=True)
    fits: Mask = ~grown(fenced, half_widths(REACH - 1e-7, to_squares=True))[1:-1, 1:-1]
    return fits


def walls(solid: Mask, things: Floats = NOTHING) -> SolidCells:
    return SolidCells(solid, 0, 0, REACH, things)


def ring_of(fits: Mask) -> Polyline:
    (chain,) = outlines(fits)
    ring: Polyline = np.concatenate((chain, chain[:1])).astype(np.float64)
    return ring


def room(solid: Mask, line: Polyline) -> float:
    """How near a line comes to what is solid, and to the outside, cells."""
    rows, columns = np.nonzero(solid)
    squares = shapely.union_all(shapely.box(columns - 0.5, rows - 0.5, columns + 0.5, rows + 0.5))
    return float(shapely.distance(shapely.LineString(line), squares))


def largest_turn(line: Polyline) -> float:
    ways = np.diff(line, axis=0)
    return float(np.abs(wrap_angles(np.diff(np.arctan2(ways[:, 1], ways[:, 0])))).max())


@pytest.mark.parametrize(
    "degrees", core_first([12.0, 17.0, 30.0, 73.0, 107.0, 163.0, -17.0], {12.0, 107.0})
)
def test_along_a_slanted_wall_the_way_is_smooth_and_keeps_its_distance(degrees: float) -> None:
    solid = slanted(degrees)
    ring = ring_of(fitting(solid))
    ways = smooth_ways(ring, walls(solid))
    assert ways
    plain = rings(fitting(solid))[0]
    assert largest_turn(plain) > 0.9
    for way in ways:
        assert way.first < way.last
        assert room(solid, way.points) >= REACH - 0.1
        # It is driven along without a stop, and stays by the outline.
        assert largest_turn(way.points) < 0.35
        outline = shapely.LineString(ring[way.first : way.last + 1])
        assert shapely.distance(outline, shapely.points(way.points)).max() < 2.0
    longest = max(ways, key=lambda way: way.last - way.first)
    assert longest.last - longest.first > 150


def test_rings_follow_the_smooth_way_and_turn_less() -> None:
    solid = slanted(17.0)
    fits = fitting(solid)
    (plain,), (smooth,) = rings(fits), rings(fits, walls(solid))
    assert np.array_equal(smooth[0], smooth[-1])
    assert room(solid, smooth) >= REACH - 0.1
    assert turning_of(smooth) < 0.9 * turning_of(plain)


@pytest.mark.parametrize("degrees", [0.0, 90.0, 45.0])
def test_walls_along_the_grid_and_its_diagonals_stay_as_they_are(degrees: float) -> None:
    solid = slanted(degrees)
    fits = fitting(solid)
    (plain,), (smooth,) = rings(fits), rings(fits, walls(solid))
    assert np.array_equal(plain, smooth)


def test_a_line_that_is_slanted_and_one_along_the_grid_are_told_apart() -> None:
    ring = ring_of(fitting(slanted(17.0)))
    found = along_stairs(ring)
    heights = ring[:, 1]
    beside = (ring[:, 0] > 100) & (ring[:, 0] < 200)
    assert found[beside & (heights < 200)].all()
    assert not found[heights == heights.max()].any()
    assert not along_stairs(ring[:40]).any()


def test_beside_round_things_the_outline_is_followed() -> None:
    solid = slanted(17.0)
    ring = ring_of(fitting(solid))
    (way, *_) = smooth_ways(ring, walls(solid))
    x, y = way.points[len(way.points) // 2]
    thing = np.array([[x, y + REACH + 1.0, 0.5]])
    beside = smooth_ways(ring, walls(solid, thing))
    assert all(other.first != way.first for other in beside)
