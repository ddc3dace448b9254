"""What moves by a layer: doors, pieces of furniture, persons."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import pytest
from fixtures.homes.home_layers import STATION, loaded, room_map, value_at

from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED
from roomba.world.catalogue.furniture import MATERIALS, furniture_at
from roomba.world.home.home import Box, MovingKind

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
