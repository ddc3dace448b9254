"""Homes from files: how they are found, and what a layer means."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from fixtures.homes.home_layers import STATION, loaded, room_map, value_at

from roomba.configuration.body import BodyConfig
from roomba.errors import HomeError
from roomba.files.home_layer import list_homes
from roomba.files.occupancy_map import save_map
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.world.home.raster import distance_to_cells
from roomba.world.layers.layer import EVEN_DIRT, load_home


def test_home_is_found_by_name_folder_and_map(tmp_path: Path) -> None:
    by_name = loaded(tmp_path, STATION)
    by_folder = load_home(str(tmp_path / "den"), tmp_path / "elsewhere")
    by_map = load_home(str(tmp_path / "den" / "map.yaml"), tmp_path / "elsewhere")
    for home in (by_name, by_folder, by_map):
        assert home.name == "den"
        assert (home.station.x, home.station.y) == (2.0, 0.4)
    assert list_homes(tmp_path) == ["den"]
    assert list_homes(tmp_path / "elsewhere") == []


def test_any_map_may_have_a_layer_beside_it(tmp_path: Path) -> None:
    save_map(room_map(), tmp_path / "scan.yaml")
    assert load_home(str(tmp_path / "scan.yaml"), tmp_path).rooms == ()
    (tmp_path / "scan.home.yaml").write_text(STATION, encoding="utf-8")
    home = load_home(str(tmp_path / "scan.yaml"), tmp_path)
    assert (home.name, home.station.x) == ("scan", 2.0)


@pytest.mark.parametrize("name", ["dan", "", "no/such/home", "../den/.."])
def test_unknown_home_is_refused_with_what_there_is(tmp_path: Path, name: str) -> None:
    loaded(tmp_path, STATION)
    with pytest.raises(HomeError, match="den"):
        load_home(name, tmp_path / "den" / "..")


def test_furniture_is_solid_and_on_the_map_unless_told_otherwise(tmp_path: Path) -> None:
    home = loaded(
        tmp_path,
        STATION
        + "furniture:\n"
        + "  - {name: a, kind: wardrobe, x: 1.0, y: 2.6, facing: south}\n"
        + "  - {name: b, kind: box, x: 3.0, y: 2.0, on_map: false}\n"
        + "  - {name: c, kind: wall_cupboard, x: 3.4, y: 2.8, facing: south}\n",
    )
    assert value_at(home, 1.0, 2.7) == (OCCUPIED, True, False)
    assert value_at(home, 3.0, 2.0) == (FREE, True, False)
    assert value_at(home, 3.4, 2.8) == (FREE, False, False)
    assert value_at(home, -0.05, 1.0) == (OCCUPIED, True, True)


def test_furniture_drawn_in_a_map_is_no_wall(tmp_path: Path) -> None:
    occupancy = room_map()
    occupancy.values[30:40, 2:15] = OCCUPIED
    bare = loaded(tmp_path, STATION, occupancy)
    assert value_at(bare, 0.3, 1.6) == (OCCUPIED, True, True)
    layer = STATION + (
        "furniture:\n"
        "  - {name: a, kind: sideboard, x: 0.325, y: 1.65, size: {width: 0.5, depth: 0.65}}\n"
    )
    home = loaded(tmp_path, layer, occupancy)
    assert value_at(home, 0.3, 1.6) == (OCCUPIED, True, False)
    assert value_at(home, -0.08, 0.5) == (OCCUPIED, True, True)


def test_wall_behind_a_front_door_is_a_wall_still(tmp_path: Path) -> None:
    door = "{name: a, kind: front_door, x: 3.0, y: -0.05, facing: north, size: {depth: 0.1}}"
    home = loaded(tmp_path, STATION + f"furniture:\n  - {door}\n")
    assert value_at(home, 3.0, -0.03) == (OCCUPIED, True, True)
    assert value_at(home, 3.0, 0.03) == (FREE, False, False)


def test_shut_doors_are_solid_and_doors_are_open_on_the_map(tmp_path: Path) -> None:
    occupancy = room_map()
    occupancy.values[:, 52:54] = OCCUPIED
    doors = "doors: [{name: d, opening: [2.5, 1.0, 2.6, 1.9], open: %s}]\n"
    shut = loaded(tmp_path, STATION + doors % "false", occupancy)
    assert value_at(shut, 2.55, 1.5) == (FREE, True, False)
    opened = loaded(tmp_path, STATION + doors % "true", occupancy)
    assert value_at(opened, 2.55, 1.5) == (FREE, False, False)
    assert value_at(opened, 2.55, 0.5) == (OCCUPIED, True, True)


def test_stairs_are_a_drop_and_floor_to_the_map(tmp_path: Path) -> None:
    home = loaded(tmp_path, STATION + "stairs: [[3.2, 2.0, 4.0, 3.0]]\n")
    assert value_at(home, 3.5, 2.5) == (FREE, False, False)
    assert home.drop[home.frame.cell_of(3.5, 2.5)]
    assert np.count_nonzero(home.drop) == 16 * 20
    low, high = home.frame.cell_of(3.21, 2.01), home.frame.cell_of(3.99, 2.99)
    assert home.drop[low[0] : high[0] + 1, low[1] : high[1] + 1].all()
    assert not loaded(tmp_path, STATION).drop.any()


@pytest.mark.parametrize(
    "layer",
    [
        STATION + "stairs: [[1.5, 0.5, 2.5, 1.0]]\n",
        STATION
        + "furniture: [{name: a, kind: box, x: 2.0, y: 0.5}]\n"
        + "moving: [{furniture: a, to: [{at: 60, x: 1.0, y: 1.0, takes: 3}]}]\n",
        STATION
        + "doors: [{name: a, opening: [1.5, 0.45, 2.5, 0.55], open: false}]\n"
        + "moving: [{door: a, close: [[60, 70]]}]\n",
    ],
)
def test_station_on_stairs_or_in_what_moves_later_is_refused(tmp_path: Path, layer: str) -> None:
    with pytest.raises(HomeError, match="docked body"):
        loaded(tmp_path, layer)


def test_without_a_station_stairs_are_no_place_for_one(tmp_path: Path) -> None:
    free = loaded(tmp_path, "wall_height: 2.4\n").station
    home = loaded(tmp_path, "stairs: [[0.0, 0.0, 2.0, 3.0]]\n")
    assert free.x < 2.0
    assert home.station.x > 2.0 + BodyConfig().radius
    (dust,) = home.dirt_sources
    assert dust.amount == pytest.approx(EVEN_DIRT * 6.0, rel=0.01)


def test_station_is_a_block_between_nose_and_wall(tmp_path: Path) -> None:
    home = loaded(tmp_path, STATION)
    assert value_at(home, 2.0, 0.1) == (OCCUPIED, True, False)
    assert value_at(home, 2.3, 0.1) == (FREE, False, False)
    plate = home.furniture[-1].boxes[0]
    assert plate.y + plate.length / 2.0 == pytest.approx(0.4 - BodyConfig().radius - 0.03)
    assert plate.y - plate.length / 2.0 == pytest.approx(0.0, abs=0.011)


def test_everything_of_a_layer_arrives(tmp_path: Path) -> None:
    home = loaded(
        tmp_path,
        STATION
        + "wall_height: 2.6\n"
        + "rooms: [{name: den, floor: tile_white, outline: [[0, 0], [4, 0], [4, 3], [0, 3]]}]\n"
        + "carpets: [{name: rug, area: [1, 1, 2, 2], material: carpet_red}]\n"
        + "dirt_sources: [{name: crumbs, x: 1, y: 1, radius: 0.5, amount: 4, rate: 0.1}]\n",
    )
    assert home.wall_height == 2.6
    assert home.station.theta == pytest.approx(-math.pi / 2.0)
    room = home.room_at(1.0, 1.0)
    assert room is not None
    assert (room.name, room.floor) == ("den", "tile_white")
    assert home.carpets[0].area.contains(1.5, 1.5)
    assert home.dirt_sources[0].amount == 4.0


def test_without_a_layer_dirt_lies_evenly_and_station_is_at_a_wall(tmp_path: Path) -> None:
    home = loaded(tmp_path, None)
    assert home.rooms == ()
    assert [piece.kind for piece in home.furniture] == ["station"]
    (dust,) = home.dirt_sources
    assert dust.amount == pytest.approx(EVEN_DIRT * 12.0, rel=0.01)
    assert math.exp(-0.5 * (5.0 / dust.radius) ** 2) > 0.99
    room = distance_to_cells(home.frame, home.solid, home.station.x, home.station.y)
    assert room >= BodyConfig().radius
    wall = home.station
    ahead = wall.x + 0.35 * math.cos(wall.theta), wall.y + 0.35 * math.sin(wall.theta)
    assert value_at(home, *ahead)[2]
    again = loaded(tmp_path, None)
    assert again.station == home.station


def test_automatic_station_stands_in_the_larger_part(tmp_path: Path) -> None:
    occupancy = room_map()
    occupancy.values[:, 25:27] = OCCUPIED
    assert loaded(tmp_path, None, occupancy).station.x > 1.25


@pytest.mark.parametrize("degrees", [20.0, 33.0, 45.0])
def test_automatic_station_stands_at_a_wall_aslant(tmp_path: Path, degrees: float) -> None:
    """A square room of 4 m, turned: its walls are steps. A metre behind the robot is free."""
    frame, half = GridFrame(0.05, -3.0, -3.0, 120, 120), 2.0
    rows, columns = np.indices(frame.shape)
    x, y = frame.centres(rows, columns)
    angle = math.radians(degrees)
    along, across = (
        math.cos(angle) * x + math.sin(angle) * y,
        math.cos(angle) * y - math.sin(angle) * x,
    )
    away = np.maximum(np.abs(along), np.abs(across))
    values = np.where(away < half, FREE, np.where(away < half + 0.1, OCCUPIED, UNKNOWN))
    home = loaded(tmp_path, None, OccupancyMap(frame, values.astype(np.int8)))
    station = home.station
    staged = station.compose(Pose(-1.0, 0.0, 0.0))
    room = distance_to_cells(home.frame, home.solid, staged.x, staged.y)
    assert room >= BodyConfig().radius
    ahead = station.compose(Pose(0.3, 0.0, 0.0))
    assert (
        max(
            abs(math.cos(angle) * ahead.x + math.sin(angle) * ahead.y),
            abs(math.cos(angle) * ahead.y - math.sin(angle) * ahead.x),
        )
        > half - 0.1
    )


def test_automatic_station_without_walls_has_a_free_way(tmp_path: Path) -> None:
    occupancy = OccupancyMap(GridFrame(0.05, 0.0, 0.0, 60, 60), np.zeros((60, 60), np.int8))
    home = loaded(tmp_path, None, occupancy)
    staged = home.station.compose(Pose(-1.0, 0.0, 0.0))
    assert 0.16 < staged.x < 2.84
    assert 0.16 < staged.y < 2.84


def test_automatic_station_in_a_small_room_has_the_longest_way_that_there_is(
    tmp_path: Path,
) -> None:
    """Nearer to the map's zero it would have a wall right behind it."""
    values = np.full((16, 28), OCCUPIED, np.int8)
    values[2:13, 2:-2] = FREE  # 0.55 m wide and 1.2 m long
    home = loaded(tmp_path, None, OccupancyMap(GridFrame(0.05, -0.6, -0.4, 16, 28), values))
    staged = home.station.compose(Pose(-0.45, 0.0, 0.0))
    room = distance_to_cells(home.frame, home.solid, staged.x, staged.y)
    assert room >= BodyConfig().radius


def test_automatic_station_is_in_a_corridor_that_is_hardly_wider_than_the_body(
    tmp_path: Path,
) -> None:
    values = np.full((12, 80), OCCUPIED, np.int8)
    values[2:9, 2:-2] = FREE  # 0.35 m wide
    home = loaded(tmp_path, None, OccupancyMap(GridFrame(0.05, 0.0, 0.0, 12, 80), values))
    room = distance_to_cells(home.frame, home.solid, home.station.x, home.station.y)
    assert room >= BodyConfig().radius


def test_home_in_which_the_body_fits_nowhere_is_refused(tmp_path: Path) -> None:
    occupancy = OccupancyMap(GridFrame(0.05, 0.0, 0.0, 6, 6), np.zeros((6, 6), np.int8))
    with pytest.raises(HomeError, match="fits"):
        loaded(tmp_path, None, occupancy)


def test_unknown_floor_is_solid_but_no_wall(tmp_path: Path) -> None:
    occupancy = room_map()
    occupancy.values[30:42, 40:52] = UNKNOWN
    assert value_at(loaded(tmp_path, STATION, occupancy), 2.1, 1.6) == (UNKNOWN, True, False)
