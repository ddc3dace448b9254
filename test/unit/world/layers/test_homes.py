"""Every shipped home: it loads, its station fits, all rooms can be reached, map and layer agree."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from roomba.commands.draw_homes import drawn_map
from roomba.configuration.body import BodyConfig
from roomba.files.home_layer import list_homes
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import HOMES
from roomba.grid import FREE, OCCUPIED
from roomba.plots.home import draw_floor_plan
from roomba.world.catalogue.things import LOW_KINDS
from roomba.world.home.home import Home, MovingKind
from roomba.world.home.raster import (
    covered_cells,
    distance_to_cells,
    footprint,
    largest_component,
    where_body_fits,
)
from roomba.world.layers.layer import load_home

NAMES = [
    "apartment",
    "bay",
    "cottage",
    "empty",
    "family",
    "flat",
    "hall",
    "loft",
    "lshape",
    "studio",
]
RADIUS = BodyConfig().radius
COMFORT = 0.04
"""m; wanted between body and walls on the way into every room."""


@pytest.fixture(scope="module")
def homes() -> dict[str, Home]:
    return {name: load_home(name, HOMES) for name in NAMES}


def test_these_homes_are_shipped() -> None:
    assert list_homes(HOMES) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_docked_body_fits_with_its_nose_to_the_station(homes: dict[str, Home], name: str) -> None:
    home = homes[name]
    x, y = home.station.x, home.station.y
    assert distance_to_cells(home.frame, home.solid, x, y) >= RADIUS
    station = home.furniture[-1]
    assert station.kind == "station"
    assert home.station.bearing_to(station.pose.x, station.pose.y) == pytest.approx(0.0, abs=1e-9)
    row, column = home.frame.cell_of(station.pose.x, station.pose.y)
    assert home.solid[row, column]
    assert home.map.values[row, column] == OCCUPIED


@pytest.mark.parametrize("name", NAMES)
def test_every_room_can_be_reached_from_the_station(homes: dict[str, Home], name: str) -> None:
    home = homes[name]
    floor = largest_component(where_body_fits(home.frame, home.solid | home.drop, RADIUS + COMFORT))
    away = math.ceil((RADIUS + COMFORT) / home.frame.resolution)
    row, column = home.frame.cell_of(home.station.x, home.station.y)
    near = floor[row - away : row + away + 1, column - away : column + away + 1]
    assert near.any(), "the station is not on the main floor"
    rows, columns = np.nonzero(floor)
    x = home.frame.origin_x + (columns + 0.5) * home.frame.resolution
    y = home.frame.origin_y + (rows + 0.5) * home.frame.resolution
    assert home.rooms
    for room in home.rooms:
        polygon = shapely.Polygon(room.outline)
        inside = np.count_nonzero(shapely.contains_xy(polygon, x, y)) * home.frame.resolution**2
        assert inside > 0.3 * polygon.area, room.name


@pytest.mark.parametrize("name", NAMES)
def test_map_and_truth_differ_only_in_what_is_off_the_map(
    homes: dict[str, Home], name: str
) -> None:
    home = homes[name]
    known_free = home.map.values == FREE
    boxes = (box for thing in home.moving for box in thing.first_boxes)
    moving = covered_cells(home.frame, (footprint(box) for box in boxes))
    assert not (~home.solid & ~known_free & ~moving).any()
    surprises = home.solid & known_free
    hidden = [p for p in home.furniture if not p.on_map or p.kind in LOW_KINDS]
    assert surprises.any() == bool(hidden)
    for row, column in np.argwhere(surprises):
        x, y = home.frame.centre_of(row, column)
        assert min(math.hypot(piece.pose.x - x, piece.pose.y - y) for piece in hidden) < 0.45


@pytest.mark.parametrize("name", NAMES)
def test_walls_are_solid_and_shut_the_home_in(homes: dict[str, Home], name: str) -> None:
    home = homes[name]
    assert home.walls.any()
    assert not (home.walls & ~home.solid).any()
    border = np.zeros(home.frame.shape, np.bool_)
    border[[0, -1], :] = border[:, [0, -1]] = True
    assert home.solid[border].all()


def test_flat_has_five_rooms_of_a_flat_and_a_toy_that_is_not_mapped(homes: dict[str, Home]) -> None:
    flat = homes["flat"]
    assert [room.name for room in flat.rooms] == [
        "living room",
        "kitchen",
        "hallway",
        "bedroom",
        "bathroom",
    ]
    floor = np.count_nonzero(~flat.walls & (flat.map.values >= 0)) * flat.frame.resolution**2
    assert 60.0 <= floor <= 90.0
    assert [piece.name for piece in flat.furniture if not piece.on_map] == ["toy lorry"]
    assert (flat.station.x, flat.station.y) == (0.0, 0.0)
    room = flat.room_at(0.0, 0.0)
    assert room is not None
    assert room.name == "living room"
    assert flat.room_at(-3.0, 0.0) is None
    for door in flat.doors:
        opening = door.opening
        width = max(opening.x_max - opening.x_min, opening.y_max - opening.y_min)
        assert 0.8 <= width <= 0.9 + 1e-9
        assert door.is_open


def test_flat_lets_the_body_walk_straight_from_home_to_3_4(homes: dict[str, Home]) -> None:
    """The report's 5.0 m in 10 s: a clear corridor, 12 cm wider than the body on both sides."""
    flat = homes["flat"]
    assert flat.map.values[flat.frame.cell_of(3.0, 4.0)] == FREE
    # What lies behind the start, as the station does, is not in the way.
    corridor = shapely.LineString([(0.12, 0.16), (3.0, 4.0)]).buffer(
        RADIUS + 0.12, cap_style="flat"
    )
    beyond = shapely.Point(3.0, 4.0).buffer(RADIUS + 0.12)
    for row, column in np.argwhere(flat.solid):
        x, y = flat.frame.centre_of(row, column)
        half = flat.frame.resolution / 2.0
        cell = shapely.box(x - half, y - half, x + half, y + half)
        assert cell.intersection(corridor).area < 1e-6, (x, y)
        assert not cell.intersects(beyond), (x, y)


def test_in_the_family_flat_something_of_each_kind_moves(homes: dict[str, Home]) -> None:
    family = homes["family"]
    assert [(thing.kind, thing.name) for thing in family.moving] == [
        (MovingKind.DOOR, "bedroom door"),
        (MovingKind.FURNITURE, "chair 2"),
        (MovingKind.PERSON, "Ann"),
        (MovingKind.PERSON, "Ben"),
    ]
    assert [len(homes[name].moving) for name in NAMES if name != "family"] == [0] * (len(NAMES) - 1)
    assert "chair 2" not in [piece.name for piece in family.furniture]


def test_what_moves_in_the_family_flat_runs_into_nothing(homes: dict[str, Home]) -> None:
    family = homes["family"]
    blocked = family.solid | family.drop
    for thing in family.moving:
        places = [thing.pose, *(move.pose for move in thing.script.moves)]
        if thing.kind is MovingKind.DOOR:
            continue
        for start, end in itertools.pairwise(places):
            ends = [
                footprint(box.placed_at(pose))
                for pose in (start, end)
                for box in thing.boxes
                if box.bottom < BodyConfig().height
            ]
            way = covered_cells(family.frame, [shapely.union_all(ends).convex_hull])
            assert not (way & blocked).any(), (thing.name, start, end)


def test_the_plan_shows_what_moves_where_it_stands_at_first(homes: dict[str, Home]) -> None:
    door, chair, *_ = homes["family"].moving
    shut = replace(homes["family"], moving=(replace(door, is_present=True), chair))
    still = replace(homes["family"], moving=())
    for thing, home in ((chair, homes["family"]), (door, shut)):
        drawn = draw_floor_plan(home, pixels_per_metre=20.0, labels=False)
        bare = draw_floor_plan(still, pixels_per_metre=20.0, labels=False)
        rows, columns = np.nonzero((drawn != bare).any(axis=2))
        margin = 0.03 * 8.4
        x, y = columns / 20.0 - 0.5 - margin, 6.0 + margin - rows / 20.0
        away = np.hypot(x - thing.pose.x, y - thing.pose.y)
        assert away.min() < 0.3, thing.name


def test_the_robot_can_drive_up_to_the_stairs_of_the_family_flat(homes: dict[str, Home]) -> None:
    family = homes["family"]
    (stairs,) = family.stairs
    assert stairs.x_max - stairs.x_min >= 1.0
    assert stairs.y_max - stairs.y_min >= 0.9
    floor = largest_component(where_body_fits(family.frame, family.solid, RADIUS + COMFORT))
    assert (floor & family.drop).any(), "nothing but the drop keeps it from the stairs"
    before = family.frame.cell_of(stairs.x_min - 0.3, (stairs.y_min + stairs.y_max) / 2.0)
    assert floor[before]
    assert not family.drop[before]
    assert family.map.values[family.drop].max() == FREE


def test_hall_lets_the_body_stand_at_the_limits(homes: dict[str, Home]) -> None:
    hall = homes["hall"]
    for x in (-100.0, 100.0):
        for y in (-100.0, 100.0):
            assert distance_to_cells(hall.frame, hall.solid, x, y) >= RADIUS + COMFORT
    assert np.count_nonzero(hall.solid & ~hall.walls) <= 4, "nothing but walls and the station"


@pytest.mark.parametrize("name", ["flat", "studio", "family", "bay", "loft", "cottage", "hall"])
def test_map_is_what_the_layer_draws(name: str) -> None:
    drawn = drawn_map(name, HOMES)
    filed = load_map(HOMES / name / "map.yaml")
    assert filed.frame == drawn.frame
    assert np.array_equal(filed.values, drawn.values), "run python -m roomba.commands.draw_homes"


@pytest.mark.parametrize("name", ["apartment", "empty", "lshape"])
def test_reference_maps_keep_their_frame(homes: dict[str, Home], name: str) -> None:
    filed = load_map(HOMES / name / "map.yaml")
    changed = np.argwhere(filed.values != homes[name].map.values)
    station = homes[name].furniture[-1].pose
    for row, column in changed:
        x, y = filed.frame.centre_of(row, column)
        assert math.hypot(x - station.x, y - station.y) < 0.2, "only the station is added"
    frame = homes[name].frame
    assert (frame.origin_x, frame.origin_y, frame.resolution) == (-0.1, -0.1, 0.05)
    assert frame.shape == (204, 204)
