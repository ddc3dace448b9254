"""Homes from files: how they are found, what a layer means, and how a broken one is refused."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from roomba.configuration.body import BodyConfig
from roomba.errors import HomeError
from roomba.files.occupancy_map import save_map
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.world.catalogue.furniture import MATERIALS, furniture_at
from roomba.world.home.home import Box, Home, MovingKind
from roomba.world.home.raster import distance_to_cells
from roomba.world.layers.layer import EVEN_DIRT, list_homes, load_home

STATION = "station: {x: 2.0, y: 0.4, facing: south}\n"


def room_map() -> OccupancyMap:
    """Return a room of 4 x 3 m with its corner at (0, 0) and walls of 10 cm."""
    values = np.full((64, 84), OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    return OccupancyMap(GridFrame(0.05, -0.1, -0.1, 64, 84), values)


def loaded(folder: Path, layer: str | None, occupancy: OccupancyMap | None = None) -> Home:
    """Load a home ``den`` with the given layer."""
    den = folder / "den"
    den.mkdir(exist_ok=True)
    save_map(occupancy or room_map(), den / "map.yaml")
    if layer is not None:
        (den / "home.yaml").write_text(layer, encoding="utf-8")
    return load_home("den", folder)


def value_at(home: Home, x: float, y: float) -> tuple[int, bool, bool]:
    cell = home.frame.cell_of(x, y)
    return int(home.map.values[cell]), bool(home.solid[cell]), bool(home.walls[cell])


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


MOVING_DOOR = (
    "doors: [{name: d, opening: [2.5, 1.0, 2.6, 1.9], open: %s}]\n"
    "moving: [{door: d, close: [[600.0, 900.0], [1000, 1100]], every: 3600.0, jitter: 60.0}]\n"
)


@pytest.mark.parametrize("is_open", [True, False])
def test_a_door_that_moves_has_its_leaf_among_the_moving(tmp_path: Path, is_open: bool) -> None:
    home = loaded(tmp_path, STATION + MOVING_DOOR % str(is_open).lower())
    assert value_at(home, 2.55, 1.5) == (FREE, False, False)
    assert home.doors[0].is_open
    (leaf,) = home.moving
    assert (leaf.name, leaf.kind, leaf.is_present) == ("d", MovingKind.DOOR, not is_open)
    (box,) = leaf.boxes
    assert (box.length, box.width) == pytest.approx((0.1, 0.9))
    assert (box.bottom, box.top, box.material) == (0.0, 2.03, "door")
    assert (leaf.pose.x, leaf.pose.y, leaf.pose.theta) == pytest.approx((2.55, 1.45, 0.0))
    assert len(leaf.first_boxes) == (0 if is_open else 1)
    assert [(move.begins, move.is_present) for move in leaf.script.moves] == [
        (600.0, True),
        (900.0, False),
        (1000.0, True),
        (1100.0, False),
    ]
    assert (leaf.script.period, leaf.script.jitter) == (3600.0, 60.0)


def test_a_leaf_is_not_higher_than_its_home(tmp_path: Path) -> None:
    home = loaded(tmp_path, STATION + "wall_height: 1.9\n" + MOVING_DOOR % "true")
    assert home.moving[0].boxes[0].top == 1.9


MOVED_BOX = (
    "furniture:\n"
    "  - {name: a, kind: box, x: 3.0, y: 2.0, facing: north, on_map: %s}\n"
    "  - {name: b, kind: box, x: 1.0, y: 2.0}\n"
    "moving:\n"
    "  - furniture: a\n"
    "    to:\n"
    "      - {at: 600, x: 2.0, y: 2.0, takes: 3}\n"
    "      - {at: 700, x: 2.0, y: 2.5, facing: west, takes: 2.0}\n"
)


@pytest.mark.parametrize("on_map", [True, False])
def test_a_piece_that_moves_is_not_solid_and_no_furniture(tmp_path: Path, on_map: bool) -> None:
    home = loaded(tmp_path, STATION + MOVED_BOX % str(on_map).lower())
    assert value_at(home, 3.0, 2.0) == (OCCUPIED if on_map else FREE, False, False)
    assert value_at(home, 1.0, 2.0) == (OCCUPIED, True, False)
    assert [piece.name for piece in home.furniture] == ["b", "station"]
    (moved,) = home.moving
    assert (moved.kind, moved.is_present) == (MovingKind.FURNITURE, True)
    still = furniture_at("a", "box", Pose())
    assert [rounded(box) for box in moved.boxes] == [rounded(box) for box in still.boxes]
    there = furniture_at("a", "box", Pose(3.0, 2.0, math.pi / 2.0))
    assert [rounded(box) for box in moved.first_boxes] == [rounded(box) for box in there.boxes]
    first, second = moved.script.moves
    assert (first.begins, first.takes, first.pose) == (600.0, 3.0, Pose(2.0, 2.0, math.pi / 2.0))
    assert (second.ends, second.pose) == (702.0, Pose(2.0, 2.5, math.pi))
    assert moved.script.period == 0.0


def rounded(box: Box) -> tuple[float | str, ...]:
    return tuple(
        value if isinstance(value, str) else round(value, 9) + 0.0
        for value in dataclasses.astuple(box)
    )


def test_floor_is_under_a_moving_piece_that_the_picture_shows(tmp_path: Path) -> None:
    occupancy = room_map()
    occupancy.values[40:48, 56:66] = OCCUPIED
    assert value_at(loaded(tmp_path, STATION, occupancy), 3.0, 2.0)[1]
    home = loaded(tmp_path, STATION + MOVED_BOX % "true", occupancy)
    assert value_at(home, 3.0, 2.0) == (OCCUPIED, False, False)
    against_wall = MOVED_BOX.replace("x: 3.0", "x: 3.95") % "true"
    home = loaded(tmp_path, STATION + "walls: [[4.0, -0.1, 4.1, 3.1]]\n" + against_wall)
    assert value_at(home, 4.03, 2.0) == (OCCUPIED, True, True)


def test_a_person_walks_a_path_and_turns_at_its_corners(tmp_path: Path) -> None:
    ann = "{person: Ann, path: [[1, 1], [3, 1], [3, 2]], speed: 0.5, at: 120, every: 1800}"
    home = loaded(tmp_path, STATION + f"moving: [{ann}]\n")
    (person,) = home.moving
    assert (person.name, person.kind, person.is_present) == ("Ann", MovingKind.PERSON, False)
    assert person.pose == Pose(1.0, 1.0, 0.0)
    shoes = [box for box in person.boxes if box.bottom == 0.0]
    assert [(box.length, box.width) for box in shoes] == [pytest.approx((0.26, 0.10))] * 2
    assert abs(shoes[0].y - shoes[1].y) == pytest.approx(0.2)
    assert all(box.material in MATERIALS for box in person.boxes)
    assert max(box.top for box in person.boxes) > 1.5
    appears, along, turns, up, leaves = person.script.moves
    assert (appears.begins, appears.takes, appears.pose) == (120.0, 0.0, person.pose)
    assert (along.ends, along.pose) == (124.0, Pose(3.0, 1.0, 0.0))
    assert turns.pose == Pose(3.0, 1.0, math.pi / 2.0)
    assert 0.0 < turns.takes < 2.0
    assert (up.takes, up.pose) == (2.0, Pose(3.0, 2.0, math.pi / 2.0))
    assert (leaves.begins, leaves.is_present) == (up.ends, False)
    assert all(move.is_present for move in (appears, along, turns, up))


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


def test_home_in_which_the_body_fits_nowhere_is_refused(tmp_path: Path) -> None:
    occupancy = OccupancyMap(GridFrame(0.05, 0.0, 0.0, 6, 6), np.zeros((6, 6), np.int8))
    with pytest.raises(HomeError, match="fits"):
        loaded(tmp_path, None, occupancy)


def test_unknown_floor_is_solid_but_no_wall(tmp_path: Path) -> None:
    occupancy = room_map()
    occupancy.values[30:40, 40:50] = UNKNOWN
    assert value_at(loaded(tmp_path, STATION, occupancy), 2.1, 1.6) == (UNKNOWN, True, False)


ROOM = "rooms:\n  - name: den\n    outline: "
PIECE = "furniture:\n  - name: a\n    kind: sofa\n    x: 1.0\n    y: 2.0\n"
DIRT = "dirt_sources:\n  - {name: d, x: 1, y: 1, radius: 1}\n  - "


THINGS = (
    "doors: [{name: front, opening: [1, 1, 2, 1.1]}]\n"
    "furniture: [{name: stool, kind: stool, x: 1, y: 1}, "
    "{name: w, kind: window, x: 1, y: 1}]\n"
    "moving:\n  - "
)
TO = "to:\n      - {at: 600, x: 2, y: 2, takes: 3}\n      - "
PATH = "path: [[1, 1], [2, 2]]"


@pytest.mark.parametrize(
    ("entry", "line", "words"),
    [
        (
            "{door: fornt, close: [[1, 2]]}",
            5,
            "name of a door of this file, got 'fornt'; did you mean 'front'?",
        ),
        ("{furniture: stol, " + TO[:2] + ": [{at: 1, x: 1, y: 1, takes: 1}]}", 5, "'stool'"),
        ("{furniture: w, to: [{at: 1, x: 1, y: 1, takes: 1}]}", 5, "'w'"),
        ("{close: [[1, 2]]}", 5, "one of the keys door, furniture, person"),
        ("{door: front, person: Ann, close: [[1, 2]]}", 5, "one of the keys"),
        ("{door: front}", 5, "'close'"),
        ("{door: front, close: []}", 5, "'close'"),
        ("{furniture: stool}", 5, "'to'"),
        ("{person: Ann}", 5, "'path'"),
        ("{door: front, close: [[1, 2]], speed: 1}", 5, "no 'speed' beside 'door'"),
        ("{door: front, clos: [[1, 2]]}", 5, "did you mean 'close'"),
        ("door: front\n    close: [[5, 6]]\n    evry: 1", 7, "did you mean 'every'"),
        ("door: front\n    close: [[5, 6], [5.5, 7]]", 6, "in order"),
        ("door: front\n    close: [[6, 5]]", 6, "the first before the second"),
        ("door: front\n    close: [[5, 6, 7]]", 6, "close"),
        ("door: front\n    close: [[-1, 6]]", 6, "-1"),
        ("door: front\n    close: [[5, 6]]\n    every: 1", 7, "10 s or more"),
        ("door: front\n    close: [[5, 6]]\n    jitter: -1", 7, "jitter"),
        ("{door: front, close: [[5, 60]], every: 50}", 5, "within its period of 50 s"),
        ("furniture: stool\n    " + TO + "{at: 602, x: 2, y: 2, takes: 3}", 6, "in order"),
        ("furniture: stool\n    " + TO + "{at: 700, x: 9, y: 2, takes: 3}", 8, "on the map"),
        ("furniture: stool\n    " + TO + "{at: 700, x: 2, y: 2}", 8, "'takes'"),
        ("furniture: stool\n    " + TO + "{at: 700, x: 2, y: 2, takes: 0}", 8, "takes"),
        (
            "furniture: stool\n    " + TO + "{at: 86399, x: 2, y: 2, takes: 2}",
            5,
            "within the day",
        ),
        ("person: Ann\n    path: [[1, 1]]", 6, "2 points or more"),
        ("person: Ann\n    path: [[1, 1], [1, 1]]", 6, "2 points or more"),
        ("person: Ann\n    path:\n      - [1, 1]\n      - [9, 9]", 8, "on the map"),
        ("{person: Ann, " + PATH + ", speed: 0}", 5, "speed"),
        ("{person: Ann, " + PATH + ", at: 59, every: 60}", 5, "within its period"),
        ("{person: Ann, " + PATH + "}\n  - {person: Ann, " + PATH + "}", 6, "again"),
    ],
)
def test_broken_script_is_refused_with_line_and_reason(
    tmp_path: Path, entry: str, line: int, words: str
) -> None:
    with pytest.raises(HomeError) as refusal:
        loaded(tmp_path, STATION + THINGS + entry + "\n")
    message = str(refusal.value)
    assert message.startswith(f"{tmp_path / 'den' / 'home.yaml'}:{line}: "), message
    assert words in message
    assert "\n" not in message


def test_a_door_where_there_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(HomeError, match="there is none; add one"):
        loaded(tmp_path, STATION + "moving: [{door: d, close: [[1, 2]]}]\n")


@pytest.mark.parametrize(
    ("layer", "line", "words"),
    [
        (STATION + "colour: red\n", 2, "'colour'"),
        (STATION + "furnitur: []\n", 2, "did you mean 'furniture'"),
        (STATION + PIECE + "    colr: x\n", 7, "'colr'"),
        (STATION + PIECE + "    materil: wood\n", 7, "did you mean 'material'"),
        (
            STATION + PIECE.replace("1.0", "left"),
            5,
            "furniture.0.x: expected a valid number; got 'left'",
        ),
        (STATION + PIECE.replace("1.0", "'1.0'"), 5, "'1.0'"),
        (STATION + PIECE.replace("1.0", "true"), 5, "True"),
        (STATION + PIECE.replace("1.0", ".nan"), 5, "nan"),
        (STATION + PIECE.replace("1.0", ".inf"), 5, "inf"),
        (STATION + PIECE.replace("1.0", "99.0"), 3, "on the map"),
        (STATION + PIECE.replace("    x: 1.0\n", ""), 3, "'x'"),
        (STATION + PIECE.replace("sofa", "sofaa"), 4, "did you mean 'sofa'"),
        (STATION + PIECE + "    facing: up\n", 7, "east, north, west, south"),
        (STATION + PIECE + "    material: fabric_grean\n", 7, "did you mean 'fabric_green'"),
        (STATION + PIECE + "    size: {width: 0.1}\n", 7, "usual"),
        (STATION + PIECE + "    size: {width: -1}\n", 7, "greater than 0"),
        (STATION + PIECE + PIECE.replace("furniture:\n", ""), 7, "again"),
        (STATION + ROOM + "[[0, 0], [2, 2], [2, 0], [0, 2]]\n", 4, "crosses itself"),
        (STATION + ROOM + "[[0, 0], [2, 2]]\n", 4, "3"),
        (STATION + ROOM + "[[0, 0], [2, 0, 1], [2, 2]]\n", 4, "outline"),
        (STATION + ROOM + "[[0, 0], [20, 0], [2, 2]]\n", 4, "on the map"),
        (STATION + ROOM + "[[0, 0], [2, 0], [2, 2]]\n    floor: oat\n", 5, "did you mean 'oak'"),
        (STATION + DIRT + "{name: e, x: 1, y: 1, radius: 1, amount: -2}\n", 4, "amount"),
        (STATION + DIRT + "{name: e, x: -0.05, y: 1, radius: 1}\n", 4, "free floor"),
        (STATION + DIRT + "{name: d, x: 1, y: 1, radius: 1}\n", 4, "again"),
        (STATION + DIRT + "{name: e, x: 1, y: 1, radius: 0}\n", 4, "radius"),
        (STATION + "carpets: [{name: r, area: [2, 1, 1, 2]}]\n", 2, "x_min"),
        (STATION + "stairs: [[1, 1, 2]]\n", 2, "stairs"),
        (
            STATION + "dirt_sources: [{name: e, x: 3, y: 1, radius: 1}]\n"
            "stairs: [[2.5, 0.5, 4, 2]]\n",
            2,
            "which is none",
        ),
        (STATION + "doors: [{name: d, opening: [1, 1, 2, 2], open: maybe}]\n", 2, "maybe"),
        (STATION + "wall_height: 0\n", 2, "wall_height"),
        ("# near the wall\nstation: {x: 2.0, y: 0.1, facing: south}\n", 2, "docked body"),
        ("station: {x: 9.0, y: 0.4, facing: south}\n", 1, "on the map"),
        ("station: {x: 2.0, y: 0.4}\n", 1, "'facing'"),
        ("station: [2.0, 0.4]\n", 1, "station"),
        (STATION + STATION, 2, "again"),
        (STATION + "rooms: {\n", 3, "YAML"),
        (STATION + "rooms: !!python/name:os.system\n", 2, "YAML"),
        ("just words\n", 1, "keys and values"),
    ],
)
def test_broken_layer_is_refused_with_line_and_reason(
    tmp_path: Path, layer: str, line: int, words: str
) -> None:
    with pytest.raises(HomeError) as refusal:
        loaded(tmp_path, layer)
    message = str(refusal.value)
    assert message.startswith(f"{tmp_path / 'den' / 'home.yaml'}:{line}: "), message
    assert words in message


def test_station_in_furniture_is_refused(tmp_path: Path) -> None:
    with pytest.raises(HomeError, match="docked body"):
        loaded(tmp_path, STATION + PIECE.replace("2.0", "0.4").replace("1.0", "1.9"))
