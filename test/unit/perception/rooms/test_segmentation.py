"""Floors are cut at doorways, with furniture and without, on turned maps and at any resolution."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.rooms import RoomsConfig
from roomba.errors import RoomsError
from roomba.files.shipped import HOMES
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.rooms.rooms import Rooms, segment
from roomba.raster.regions import numbered_regions
from roomba.world.layers.layer import load_home

Area = tuple[float, float, float, float]
"""Lowest x and y, highest x and y, m."""

SIZE = (8.0, 6.0)
LIVING, HALL = (0.2, 0.2, 4.6, 5.8), (4.7, 0.2, 5.8, 5.8)
BATH, BEDROOM = (5.9, 0.2, 7.8, 2.4), (5.9, 2.5, 7.8, 5.8)
ROOMS = (LIVING, HALL, BEDROOM, BATH)
DOORS = ((4.6, 2.0, 4.7, 3.2), (5.8, 4.0, 5.9, 4.9), (5.8, 0.6, 5.9, 1.4))
"""The first is wider than the hall."""
THINGS = (
    *((x, y, x + 0.1, y + 0.1) for x in (1.0, 2.0) for y in (1.0, 1.8)),  # legs of a table
    (2.4, 1.2, 2.8, 1.7),  # a chair
    (0.2, 3.6, 0.6, 5.8),  # shelves
    (5.9, 5.2, 7.8, 5.8),  # a bed across the room
    (7.2, 2.5, 7.8, 3.7),  # a wardrobe
    (5.4, 2.6, 5.8, 3.6),  # a cabinet that narrows the hall, where the wide door is
)


def drawn(
    free: Sequence[Area],
    things: Sequence[Area] = (),
    size: tuple[float, float] = SIZE,
    resolution: float = 0.05,
    around: int = OCCUPIED,
) -> OccupancyMap:
    """Areas of floor cut out of a block, and things put on it."""
    frame = GridFrame(
        resolution, -1.0, 2.0, round(size[1] / resolution), round(size[0] / resolution)
    )
    values = np.full(frame.shape, around, np.int8)
    for value, areas in ((FREE, free), (OCCUPIED, things)):
        for area in areas:
            left, low, right, high = (round(side / resolution) for side in area)
            values[low:high, left:right] = value
    return OccupancyMap(frame, values)


def label_in(rooms: Rooms, area: Area) -> int:
    """The label that most cells of an area of :func:`drawn` have."""
    size = rooms.frame.resolution
    left, low, right, high = (round(side / size) for side in area)
    return int(np.bincount(rooms.labels[low:high, left:right].ravel()).argmax())


def agreement(first: NDArray[np.int16], second: NDArray[np.int16]) -> float:
    """The share of labelled cells that are in the same room in both; its number may differ."""
    best = sum(np.bincount(second[first == label]).max() for label in range(1, first.max() + 1))
    return float(best) / np.count_nonzero(first)


@pytest.mark.parametrize("things", [(), THINGS], ids=["bare", "furnished"])
def test_a_home_is_cut_at_its_doors(things: Sequence[Area]) -> None:
    map = drawn([*ROOMS, *DOORS], things)
    rooms = segment(map)
    assert not rooms.labels[map.solid].any()
    assert rooms.names == ("Room 1", "Room 2", "Room 3", "Room 4")
    assert sorted(label_in(rooms, area) for area in ROOMS) == [1, 2, 3, 4]
    doors = rooms.doorways()
    assert len(doors) == len(DOORS)
    for left, low, right, high in DOORS:
        [door] = [
            door
            for door in doors
            if np.hypot(door.x + 1 - (left + right) / 2, door.y - 2 - (low + high) / 2) < 0.15
        ]
        assert door.width == pytest.approx(high - low, abs=0.11)


def test_rooms_are_numbered_by_their_area() -> None:
    rooms = segment(drawn([*ROOMS, *DOORS]))
    assert [label_in(rooms, area) for area in ROOMS] == [1, 3, 2, 4] or [
        label_in(rooms, area) for area in ROOMS
    ] == [1, 2, 3, 4]
    areas = [rooms.area(label) for label in range(1, 5)]
    assert areas == sorted(areas, reverse=True)
    assert areas[0] == pytest.approx(4.4 * 5.6, abs=0.2)


def test_a_gap_between_bed_and_wardrobe_is_no_door() -> None:
    bed, wardrobe = (0.2, 1.6, 1.6, 3.6), (2.4, 2.6, 3.0, 4.6)
    rooms = segment(drawn([(0.2, 0.2, 3.0, 5.6)], [bed, wardrobe], (3.2, 5.8)))
    assert rooms.names == ("Room 1",)


@pytest.mark.parametrize(
    ("width", "wall", "count"),
    [
        (0.2, 0.1, 2),  # a crack in a scanned wall
        (0.4, 0.1, 1),  # furniture nearly closes it
        (0.6, 0.1, 2),
        (0.9, 0.5, 2),  # a bearing wall
        (0.9, 0.8, 2),  # a wall with built-in cupboards
        (1.5, 0.8, 1),  # so wide a passage through it is no door
        (0.9, 1.6, 1),  # no wall is as thick
        (1.3, 0.1, 2),
        (2.6, 0.1, 2),  # a wide opening
        (3.2, 0.1, 1),  # a pillar on either side
    ],
)
def test_what_is_a_doorway(width: float, wall: float, count: int) -> None:
    middle = 4.0 + wall / 2.0
    door = (3.9, 2.2 - width / 2.0, 4.1 + wall, 2.2 + width / 2.0)
    floor = [(0.2, 0.2, 4.0, 4.2), (4.0 + wall, 0.2, 2 * middle - 0.2, 4.2), door]
    assert len(segment(drawn(floor, size=(2 * middle, 4.4))).names) == count


def test_a_door_in_the_corner_of_a_room_is_one_and_a_screen_makes_none() -> None:
    beside_wall = (4.0, 0.2, 4.1, 1.1)
    floor = [(0.2, 0.2, 4.0, 4.2), (4.1, 0.2, 7.8, 4.2), beside_wall]
    assert len(segment(drawn(floor)).names) == 2
    cubicle, screen = (0.2, 0.2, 1.2, 4.2), (0.2, 2.2, 0.4, 2.3)
    assert len(segment(drawn([cubicle], [screen])).names) == 1


@pytest.mark.parametrize("door", [0.9, 1.1, 1.2])
def test_a_corridor_may_be_as_narrow_as_the_doors_that_lead_to_it(door: float) -> None:
    corridor = (0.2, 0.2, 7.8, 1.4)
    left, right = (0.2, 1.6, 3.9, 5.0), (4.1, 1.6, 7.8, 5.0)
    doors = [(0.2, 1.4, 0.2 + door, 1.6), (7.8 - door, 1.4, 7.8, 1.6)]  # in their rooms' corners
    found = segment(drawn([corridor, left, right, *doors], size=(8.0, 5.2)))
    assert len(found.names) == 3


def test_a_map_on_which_no_walls_are_drawn_has_rooms() -> None:
    rooms = segment(drawn([*ROOMS, *DOORS], around=UNKNOWN))
    assert sorted(label_in(rooms, area) for area in ROOMS) == [1, 2, 3, 4]


def test_a_closet_belongs_to_the_neighbour_with_the_widest_opening() -> None:
    closet, door, crack = (4.1, 0.2, 5.1, 1.4), (4.0, 0.5, 4.1, 1.1), (5.1, 0.6, 5.2, 0.8)
    floor = [(0.2, 0.2, 4.0, 4.2), closet, (5.2, 0.2, 7.8, 4.2), door, crack]
    rooms = segment(drawn(floor))
    assert len(rooms.names) == 2
    assert label_in(rooms, closet) == label_in(rooms, floor[0])
    own = segment(drawn(floor), RoomsConfig(smallest_room=1.0))
    assert len(own.names) == 3


@pytest.mark.parametrize("resolution", [0.025, 0.05, 0.1])
@pytest.mark.parametrize(("length", "count"), [(0.9, 1), (1.2, 2)])
def test_what_stands_free_is_furniture_if_it_is_small(
    length: float, count: int, resolution: float
) -> None:
    across = (4.0, 1.5 - length / 2.0, 4.2, 1.5 + length / 2.0)
    map = drawn([(0.2, 0.2, 7.8, 2.8)], [across], (8.0, 3.0), resolution)
    assert len(segment(map).names) == count


def test_floor_that_things_enclose_is_in_no_room() -> None:
    ring, hole = (2.0, 2.0, 2.9, 2.9), (2.1, 2.1, 2.8, 2.8)
    map = drawn([(0.2, 0.2, 4.0, 5.8)], [ring])
    map.values[drawn([hole]).values == FREE] = FREE
    rooms = segment(map)
    assert rooms.names == ("Room 1",)
    assert label_in(rooms, hole) == 0


def test_rays_and_specks_are_no_rooms() -> None:
    ray, speck = (4.0, 2.0, 7.0, 2.1), (6.0, 4.0, 6.5, 4.5)
    rooms = segment(drawn([(0.2, 0.2, 4.0, 5.8), ray, speck]))
    assert rooms.names == ("Room 1",)
    assert label_in(rooms, (4.0, 2.0, 4.1, 2.1)) == 1
    assert not rooms.labels[:, round(4.3 / 0.05) :].any()


@pytest.mark.parametrize(("around", "count"), [(OCCUPIED, 2), (UNKNOWN, 1)])
def test_what_ends_at_nothing_is_outdoors(around: int, count: int) -> None:
    walls, inside, window = (0.0, 0.0, 4.0, 4.0), (0.2, 0.2, 3.8, 3.8), (3.8, 1.5, 4.0, 2.3)
    map = drawn([(4.0, 0.5, 6.5, 3.5)], [walls], around=around)
    inner = drawn([inside, window])
    values = np.where(inner.values == FREE, FREE, map.values).astype(np.int8)
    rooms = segment(OccupancyMap(map.frame, values))
    assert len(rooms.names) == count
    assert label_in(rooms, inside) > 0


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_a_turned_map_has_the_same_rooms(turns: int) -> None:
    map = drawn([*ROOMS, *DOORS], THINGS)
    values = np.ascontiguousarray(np.rot90(map.values, turns))
    frame = GridFrame(0.05, 0.0, 0.0, *values.shape)
    turned = np.rot90(segment(OccupancyMap(frame, values)).labels, -turns)
    assert agreement(segment(map).labels, turned) > 0.995


@pytest.mark.parametrize("resolution", [0.025, 0.1])
def test_a_finer_or_coarser_map_has_the_same_rooms(resolution: float) -> None:
    rooms = segment(drawn([*ROOMS, *DOORS], THINGS, resolution=resolution))
    assert len(rooms.names) == 4
    assert sorted(label_in(rooms, area) for area in ROOMS) == [1, 2, 3, 4]


@pytest.mark.parametrize("seed", range(3))
def test_specks_of_noise_change_nothing(seed: int) -> None:
    map = drawn([*ROOMS, *DOORS], THINGS)
    noise = np.random.default_rng(seed).random(map.frame.shape)
    values = np.where(noise < 0.003, OCCUPIED, np.where(noise > 0.997, FREE, map.values))
    noisy = segment(OccupancyMap(map.frame, values.astype(np.int8)))
    clean = segment(map).labels.copy()
    clean[values != FREE] = 0
    assert len(noisy.names) == 4
    assert agreement(clean, noisy.labels) > 0.99


@pytest.mark.parametrize("value", [OCCUPIED, UNKNOWN, FREE])
def test_a_map_without_walls_or_floor_does_no_harm(value: int) -> None:
    for shape, count in (((1, 1), 0), ((4, 400), 0), ((60, 60), 1)):
        frame = GridFrame(0.05, 0.0, 0.0, *shape)
        rooms = segment(OccupancyMap(frame, np.full(shape, value, np.int8)))
        assert rooms.labels.shape == shape
        assert len(rooms.names) == (count if value == FREE else 0)


RECTANGLES = st.lists(
    st.tuples(*[st.floats(0.0, 5.0)] * 2, *[st.floats(0.1, 3.0)] * 2).map(
        lambda box: (box[0], box[1], min(6.0, box[0] + box[2]), min(6.0, box[1] + box[3]))
    ),
    max_size=8,
)


@given(RECTANGLES, RECTANGLES, st.sampled_from([OCCUPIED, UNKNOWN]))
@settings(max_examples=examples(60))
def test_rooms_are_free_connected_and_without_gaps(
    floor: list[Area], things: list[Area], around: int
) -> None:
    map = drawn(floor, things, (6.0, 6.0), 0.1, around)
    rooms = segment(map)
    assert not rooms.labels[map.values != FREE].any()
    assert set(np.unique(rooms.labels)) - {0} == set(range(1, len(rooms.names) + 1))
    areas = []
    for label in range(1, len(rooms.names) + 1):
        assert numbered_regions(rooms.labels == label).max() == 1
        areas.append(rooms.area(label))
    assert all(area >= RoomsConfig().smallest_room - 1e-9 for area in areas)
    assert areas == sorted(areas, reverse=True)


@pytest.mark.parametrize("name", ["apartment", "empty", "family", "flat", "lshape", "studio"])
def test_the_shipped_homes_are_cut_as_their_layers_say(name: str) -> None:
    home = load_home(name, HOMES)
    rooms = segment(home.map)
    assert len(rooms.names) == len(home.rooms)
    x, y = np.meshgrid(
        home.frame.origin_x + (np.arange(home.frame.columns) + 0.5) * home.frame.resolution,
        home.frame.origin_y + (np.arange(home.frame.rows) + 0.5) * home.frame.resolution,
    )
    found = set()
    for room in home.rooms:
        cells = shapely.contains_xy(shapely.Polygon(room.outline), x, y) & ~home.map.solid
        counts = np.bincount(rooms.labels[cells], minlength=2)
        counts[0] = 0
        label = int(counts.argmax())
        found.add(label)
        assert counts[label] > 0.97 * np.count_nonzero(cells)
        assert counts[label] > 0.97 * np.count_nonzero(rooms.labels == label)
    assert len(found) == len(home.rooms)


def test_widths_out_of_order_are_refused() -> None:
    with pytest.raises(ValueError, match="narrowest_door < widest_door"):
        RoomsConfig(narrowest_door=1.4)
    assert issubclass(RoomsError, Exception)
