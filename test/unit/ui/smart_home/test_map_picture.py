"""The map as a picture, and Valetudo's map in it, read back by our reader of such files."""

from __future__ import annotations

import io
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.households.written_robot import HOME
from PIL import Image

from roomba.client.floor_map import FloorMap, valetudo_of
from roomba.client.view import GridLayer, RoomView, ZoneView
from roomba.files.valetudo.reading import parse
from roomba.ui.smart_home.map_picture import picture_of

CELLS = np.zeros((40, 60), np.uint8)
CELLS[5:35, 5:55] = 1
CELLS[5, 5:55] = CELLS[34, 5:55] = 2
CELLS[5:35, 5] = CELLS[5:35, 54] = 2
HALL = ((-0.7, -0.7), (0.5, -0.7), (0.5, 0.7), (-0.7, 0.7))
KITCHEN = ((0.5, -0.7), (1.65, -0.7), (1.65, 0.7), (0.5, 0.7))
PILLAR = ((0.9, -0.1), (1.1, -0.1), (1.1, 0.1), (0.9, 0.1))
LIVED = replace(
    HOME,
    rooms=(
        RoomView("hall", 1.7, (-0.1, 0.0), (HALL,)),
        RoomView("kitchen", 1.6, (1.2, 0.4), (KITCHEN, PILLAR)),
    ),
    zones=(
        ZoneView("cables", "no-go", ((0.2, 0.2), (0.4, 0.2), (0.4, 0.4), (0.2, 0.4))),
        ZoneView("door", "wall", ((0.5, -0.6), (0.5, 0.6))),
    ),
)
FLOOR = FloorMap(
    GridLayer(1, 0.05, -1.0, -1.0, CELLS), None, LIVED, (0.25, 0.0, math.pi / 2), ((0.0, 0.0),) * 3
)


def test_valetudos_map_has_rooms_zones_robot_and_way() -> None:
    values = valetudo_of(FLOOR)
    home = parse(json.dumps(values))
    assert [name for name, _ in home.rooms] == ["hall", "kitchen"]
    hall, kitchen = (mask for _, mask in home.rooms)
    assert not (hall & kitchen).any()
    assert abs(hall.sum() * 0.0025 - 1.2 * 1.4) < 0.15
    assert abs(kitchen.sum() * 0.0025 - (1.15 * 1.4 - 0.04)) < 0.15
    assert home.station is not None
    assert (len(home.no_go), len(home.walls)) == (1, 1)
    placed = {entity["type"]: entity for entity in values["entities"]}
    top = 100 * (-1.0 + 40 * 0.05)
    assert placed["robot_position"]["points"] == [125, round(top)]
    assert placed["robot_position"]["metaData"]["angle"] == 0
    assert placed["charger_location"]["points"] == [100, round(top)]
    assert len(placed["path"]["points"]) == 6


def test_of_rooms_that_reach_beyond_the_map_what_lies_on_it_is_told() -> None:
    def room(left: float, bottom: float, right: float, top: float) -> RoomView:
        ring = ((left, bottom), (right, bottom), (right, top), (left, top))
        return RoomView(f"from {left:g}", 1.0, (left, bottom), (ring,))

    rooms = (room(-9.0, -9.0, 0.5, 9.0), room(0.5, 0.0, 9.0, 0.5), room(5.0, 5.0, 6.0, 6.0))
    values = valetudo_of(replace(FLOOR, home=replace(LIVED, rooms=rooms)))
    (left, first), (right, second) = parse(json.dumps(values)).rooms
    assert (left, right) == ("from -9", "from 0.5")
    assert first.sum() == pytest.approx(28 * 24, abs=40)
    assert second.sum() == pytest.approx(10 * 24, abs=40)


def test_the_picture_shows_the_floor_with_the_highest_y_on_top() -> None:
    coverage = GridLayer(1, 0.05, -1.0, -1.0, np.zeros_like(CELLS))
    coverage.cells[28:32, 10:14] = 1
    cards_word = json.dumps(valetudo_of(FLOOR))
    content = picture_of(replace(FLOOR, coverage=coverage), cards_word)
    image = Image.open(io.BytesIO(content))
    image.load()
    assert image.info["ValetudoMap"] == cards_word
    assert b"zTXt" in content
    pixels = np.asarray(image.convert("RGB")).astype(int)
    # Cells 1 to 59 and 1 to 39 are shown, each of five pixels.
    assert pixels.shape == (38 * 5, 58 * 5, 3)

    def pixel(row: int, column: int) -> list[int]:
        found: list[int] = pixels[(38 - row) * 5 + 2, (column - 1) * 5 + 2].tolist()
        return found

    swept, floor, wall, unknown = pixel(30, 12), pixel(15, 45), pixel(34, 30), pixel(37, 30)
    assert swept[1] - swept[0] > 15
    assert min(floor) > 240
    assert max(wall) < 140
    assert 200 < unknown[0] < 240


def test_carpets_that_were_felt_are_drawn_as_those_that_a_person_drew() -> None:
    corners = ((-0.5, -0.5), (0.2, -0.5), (0.2, 0.2), (-0.5, 0.2))
    bare = replace(FLOOR, home=replace(LIVED, zones=()))
    felt = replace(FLOOR, home=replace(LIVED, zones=(), felt_carpets=(corners,)))
    drawn = replace(FLOOR, home=replace(LIVED, zones=(ZoneView("rug", "carpet", corners),)))
    assert picture_of(felt) == picture_of(drawn) != picture_of(bare)


def test_a_map_with_nothing_known_is_a_picture_too() -> None:
    empty = replace(FLOOR, cells=replace(FLOOR.cells, cells=np.zeros((3, 4), np.uint8)))
    assert Image.open(io.BytesIO(picture_of(empty))).size == (20, 15)


def test_a_large_map_is_a_picture_of_bounded_size() -> None:
    large = np.ones((3000, 900), np.uint8)
    picture = picture_of(replace(FLOOR, cells=replace(FLOOR.cells, cells=large)))
    assert max(Image.open(io.BytesIO(picture)).size) <= 3000
