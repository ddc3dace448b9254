"""The compiled search for doorways, each step against its docstring."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.perception.rooms.doorway_kernels import (
    NOWHERE,
    flood_basins,
    gaps,
    opening_at,
    wall_thicknesses,
)
from roomba.perception.rooms.floor_kernels import contacts
from roomba.raster.distance import distance_to_nearest

Mask = NDArray[np.bool_]


def wall_with_door(thickness: int = 3, low: int = 12, high: int = 24) -> Mask:
    """Two rooms beside each other, and a door between rows ``low`` and ``high``."""
    solid = np.ones((40, 80), np.bool_)
    solid[2:-2, 2:-2] = False
    solid[:, 40 : 40 + thickness] = True
    solid[low:high, 40 : 40 + thickness] = False
    return solid


def test_basins_meet_at_a_door_and_not_in_a_room() -> None:
    solid = wall_with_door()
    clearance = distance_to_nearest(solid) - np.float32(0.5)
    cells = np.flatnonzero(clearance >= 3.0)
    order = cells[np.argsort(-clearance.ravel()[cells], kind="stable")]
    basins = np.zeros(solid.shape, np.int32)
    peaks = flood_basins(order, clearance, 2.0, basins)
    assert len(peaks) == 3
    assert peaks[1:].min() > 17.0
    assert {basins[20, 20], basins[20, 60]} == {1, 2}
    assert np.array_equal(basins > 0, clearance >= 3.0)
    columns = contacts(basins)[:, 3]
    assert columns.min() >= 38
    assert columns.max() <= 44
    basins[:] = 0
    assert len(flood_basins(order, clearance, 20.0, basins)) == 2


@pytest.mark.parametrize("row", [16, 18, 20])
def test_the_ends_of_an_opening_are_the_walls_beside_it(row: int) -> None:
    solid = wall_with_door()
    ends = opening_at(solid, row, 41, float(min(row - 11, 24 - row)))
    assert sorted([ends[0], ends[2]]) == [11, 24]
    assert ends[1] == ends[3] == 41
    alone = np.zeros((40, 40), np.bool_)
    alone[20, 20] = True
    assert opening_at(alone, 20, 25, 5.0) == (-1, -1, -1, -1)


@pytest.mark.parametrize("thickness", [1, 3, 8])
def test_a_wall_is_as_thick_as_it_is(thickness: int) -> None:
    solid = wall_with_door(thickness)
    for column in (40, 40 + thickness - 1):
        ends = wall_thicknesses(solid, 11, column, 24, column, 10, 4.0)
        assert ends == pytest.approx((thickness + 1, thickness + 1))


def test_a_wall_that_goes_on_does_not_end() -> None:
    solid = wall_with_door(low=2)  # up to the outer wall
    along, end = wall_thicknesses(solid, 1, 41, 24, 41, 10, 4.0)
    assert along >= NOWHERE
    assert end == pytest.approx(4.0)
    assert min(wall_thicknesses(solid, 1, 20, 38, 20, 10, 4.0)) >= NOWHERE
    assert min(wall_thicknesses(solid, 5, 5, 5, 5, 10, 4.0)) >= NOWHERE


def test_gaps_are_doors_between_two_walls() -> None:
    found = gaps(wall_with_door(), 10.0, 26.0, 10, 4.0)
    assert len(found) == 4  # each end has two corners
    assert set(found[:, [0, 2]].ravel().tolist()) == {11, 24}
    assert {math.dist(gap[:2], gap[2:4]) for gap in found.tolist()} >= {13.0}
    assert len(gaps(wall_with_door(), 13.0, 26.0, 10, 4.0)) == 0
    assert len(gaps(wall_with_door(), 5.0, 11.0, 10, 4.0)) == 0
    assert len(gaps(wall_with_door(thickness=12), 10.0, 26.0, 10, 4.0)) == 0
    assert len(gaps(wall_with_door(low=2), 10.0, 26.0, 10, 4.0)) == 0
    one_thick = wall_with_door()
    one_thick[24:, 40:55] = True
    assert len(gaps(one_thick, 10.0, 26.0, 10, 4.0)) == 0
    pillar = wall_with_door()
    pillar[13:15, 40:43] = True
    assert len(gaps(pillar, 10.0, 26.0, 10, 4.0)) == 0
