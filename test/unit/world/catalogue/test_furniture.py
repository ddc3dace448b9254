"""The catalogue: every kind is whole, fits its measures, and is solid where it should be."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.world.catalogue.furniture import KINDS, MATERIALS, Size, furniture_at, station_at
from roomba.world.home.home import Box
from roomba.world.home.materials import TEXTURES
from roomba.world.home.raster import covered_cells, footprint, where_body_fits
from roomba.world.layers.assembly import standing_cells

BODY_HEIGHT = 0.092
PROTRUSION = 0.11
"""m; handles, taps and sills may stand out of a piece's measures by this much."""


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_every_kind_is_made_of_known_materials_within_its_measures(kind: str) -> None:
    size = KINDS[kind].size
    piece = furniture_at("piece", kind, Pose())
    assert piece.boxes
    for box in piece.boxes:
        assert box.material in MATERIALS
        assert box.length > 0.0
        assert box.width > 0.0
        assert 0.0 <= box.bottom < box.top <= 2.4
        assert abs(box.x) + box.length / 2.0 <= size.depth / 2.0 + PROTRUSION
        assert abs(box.y) + box.width / 2.0 <= size.width / 2.0 + PROTRUSION


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_a_piece_follows_its_pose(kind: str) -> None:
    here = furniture_at("piece", kind, Pose())
    there = furniture_at("piece", kind, Pose(3.0, -2.0, math.pi / 2.0))
    for box, moved in zip(here.boxes, there.boxes, strict=True):
        assert (moved.x, moved.y) == pytest.approx((3.0 - box.y, -2.0 + box.x))
        assert moved.theta == pytest.approx(math.pi / 2.0)


def test_size_and_material_can_be_chosen() -> None:
    sofa = furniture_at("s", "sofa", Pose(), size=Size(3.0, 1.0, 0.9), material="fabric_red")
    whole = shapely.union_all([footprint(box) for box in sofa.boxes])
    assert whole.bounds == pytest.approx((-0.5, -1.5, 0.5, 1.5))
    assert "fabric_red" in {box.material for box in sofa.boxes}
    assert "fabric_grey" not in {box.material for box in sofa.boxes}


def test_unknown_kind_is_an_error() -> None:
    with pytest.raises(KeyError):
        furniture_at("piece", "throne", Pose())


def test_materials_are_colours_with_a_known_texture() -> None:
    for material in MATERIALS.values():
        assert all(0 <= channel <= 255 for channel in material.rgb)
        assert material.texture in TEXTURES


def cells_of(kind: str, height: float = BODY_HEIGHT) -> int:
    frame = GridFrame(0.05, -2.0, -2.0, 80, 80)
    mask = standing_cells(frame, [furniture_at("piece", kind, Pose(0.01, 0.02, 0.3))], height)
    return int(np.count_nonzero(mask))


@pytest.mark.parametrize("kind", ["wall_cupboard", "window", "picture", "front_door", "coat_rack"])
def test_what_hangs_or_is_wall_is_not_in_the_way(kind: str) -> None:
    assert cells_of(kind) == 0


@pytest.mark.parametrize("kind", ["sofa", "wardrobe", "fridge", "bathtub", "stove", "toy", "bag"])
def test_what_stands_is_in_the_way(kind: str) -> None:
    size = KINDS[kind].size
    # A chance of half a cell of plinth or rounding on all sides.
    assert cells_of(kind) * 0.05**2 > 0.8 * (size.width - 0.1) * (size.depth - 0.1)


def test_bed_and_table_stand_on_four_legs_that_a_body_passes_between() -> None:
    frame = GridFrame(0.05, -1.5, -1.5, 60, 60)
    for kind in ("bed", "dining_table"):
        solid = standing_cells(frame, [furniture_at("piece", kind, Pose())], BODY_HEIGHT)
        assert where_body_fits(frame, solid, 0.175)[30, 30]


@pytest.mark.parametrize("theta", [0.0, 0.3, 0.785, 1.2, 2.9])
def test_cells_of_real_overlap_are_covered_and_no_others(theta: float) -> None:
    frame = GridFrame(0.05, -1.0, -1.0, 40, 40)
    box = Box(0.013, -0.027, theta, 0.61, 0.23, 0.0, 0.3, "wood")
    mask = covered_cells(frame, [footprint(box)])
    for row in range(frame.rows):
        for column in range(frame.columns):
            x, y = frame.centre_of(row, column)
            cell = shapely.box(x - 0.025, y - 0.025, x + 0.025, y + 0.025)
            share = cell.intersection(footprint(box)).area / cell.area
            if abs(share - 0.10) > 1e-6:
                assert mask[row, column] == (share > 0.10)


def test_a_thin_leg_is_not_lost_in_a_coarse_grid() -> None:
    frame = GridFrame(0.2, 0.0, 0.0, 5, 5)
    leg = Box(0.5, 0.5, 0.0, 0.03, 0.03, 0.0, 0.4, "wood")
    assert np.argwhere(covered_cells(frame, [footprint(leg)])).tolist() == [[2, 2]]


def test_where_a_body_fits_is_exact_at_cell_centres() -> None:
    frame = GridFrame(0.1, 0.0, 0.0, 17, 17)
    solid = np.zeros(frame.shape, np.bool_)
    solid[8, 8] = True
    fits = where_body_fits(frame, solid, 0.25)
    for row in range(17):
        for column in range(17):
            gap = math.hypot(max(abs(row - 8) - 0.5, 0.0), max(abs(column - 8) - 0.5, 0.0)) * 0.1
            border = (min(row, column, 16 - row, 16 - column) + 0.5) * 0.1
            if abs(gap - 0.25) > 1e-6 and abs(border - 0.25) > 1e-6:
                assert fits[row, column] == (gap >= 0.25 and border >= 0.25)


def test_station_stands_before_the_nose_and_looks_back() -> None:
    docked = Pose(1.0, 2.0, math.pi / 2.0)
    station = station_at(docked, 0.174, 0.1)
    plate = footprint(station.boxes[0])
    assert plate.bounds == pytest.approx((0.87, 2.204, 1.13, 2.304))
    assert station.pose.theta == pytest.approx(-math.pi / 2.0)
    assert station.on_map
