"""Names of rooms when a floor is mapped again."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.mapping import FloorsConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose
from roomba.grid import OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.floors.carry_over import carry_over, divided_as
from roomba.perception.rooms.rooms import Rooms, segment
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.world.layers.layer import load_home

FRAME = GridFrame(0.05, -1.0, 2.0, 40, 80)
SHARE = FloorsConfig().same_room
ZONES = Zones((Zone("bowl", ZoneKind.WALL, ((0.0, 2.5), (1.0, 2.5))),))


def rooms_of(*columns: tuple[int, int, str], frame: GridFrame = FRAME) -> Rooms:
    """Rooms that are columns of the grid, from one to another."""
    labels = np.zeros(frame.shape, np.int16)
    for label, (first, last, _) in enumerate(columns, 1):
        labels[:, first:last] = label
    return Rooms(frame, labels, tuple(name for *_, name in columns))


def test_the_same_rooms_keep_their_names_and_zones_stay() -> None:
    old = rooms_of((0, 30, "kitchen"), (30, 60, "hall"), (60, 80, "bath"))
    new = rooms_of((0, 30, "Room 2"), (60, 80, "Room 3"), (30, 60, "Room 1"))
    carried = carry_over(new, old, ZONES, SHARE)
    assert carried.rooms.names == ("kitchen", "bath", "hall")
    assert np.array_equal(carried.rooms.labels, new.labels)
    assert carried.zones == ZONES
    assert carried.lost == ()


def test_without_rooms_before_all_is_new() -> None:
    new = rooms_of((0, 30, "Room 1"))
    carried = carry_over(new, None, ZONES, SHARE)
    assert carried.rooms is new
    assert carried.zones == ZONES


def test_a_room_that_is_new_gets_a_number_that_is_free() -> None:
    old = rooms_of((0, 30, "Room 2"), (30, 60, "Room 1"))
    new = rooms_of((0, 30, "Room 1"), (30, 60, "Room 2"), (60, 70, "Room 3"), (70, 80, "Room 4"))
    assert carry_over(new, old, ZONES, SHARE).rooms.names == (
        "Room 2",
        "Room 1",
        "Room 3",
        "Room 4",
    )
    new = rooms_of((60, 70, "Room 1"), (30, 60, "Room 2"), (70, 80, "Room 3"), (0, 30, "Room 4"))
    assert carry_over(new, old, ZONES, SHARE).rooms.names == (
        "Room 4",
        "Room 1",
        "Room 3",
        "Room 2",
    )


def test_a_room_that_is_gone_is_told() -> None:
    old = rooms_of((0, 30, "kitchen"), (30, 60, "hall"))
    carried = carry_over(rooms_of((0, 30, "Room 1")), old, ZONES, SHARE)
    assert carried.rooms.names == ("kitchen",)
    assert carried.lost == ("hall",)


def test_of_two_parts_the_larger_keeps_the_name() -> None:
    old = rooms_of((0, 60, "living room"))
    new = rooms_of((0, 20, "Room 1"), (20, 60, "Room 2"))
    assert carry_over(new, old, ZONES, SHARE).rooms.names == ("Room 1", "living room")


def test_two_that_became_one_have_the_name_of_the_larger() -> None:
    old = rooms_of((0, 20, "kitchen"), (20, 60, "hall"))
    carried = carry_over(rooms_of((0, 60, "Room 1")), old, ZONES, SHARE)
    assert carried.rooms.names == ("hall",)
    assert carried.lost == ("kitchen",)


def test_who_overlaps_most_may_have_to_take_another_so_that_both_keep_a_name() -> None:
    """The first overlaps "a" by 22 columns and "b" by 20; the second overlaps "a" alone, by 18."""
    old = rooms_of((0, 40, "a"), (40, 60, "b"))
    new = rooms_of((18, 60, "Room 1"), (0, 18, "Room 2"))
    carried = carry_over(new, old, ZONES, SHARE)
    assert carried.rooms.names == ("b", "a")
    assert carried.lost == ()


def test_a_corner_in_common_makes_no_namesake() -> None:
    old = rooms_of((0, 40, "kitchen"))
    carried = carry_over(rooms_of((25, 60, "Room 1")), old, ZONES, SHARE)
    assert carried.rooms.names == ("Room 1",)
    assert carried.lost == ("kitchen",)


@pytest.mark.parametrize("name", ["flat", "family", "apartment"])
def test_a_home_on_another_grid_a_little_off_keeps_all_names(name: str) -> None:
    """A grid a few cm off, and wider, over the same walls."""
    home = load_home(name, HOMES)
    old = segment(home.map)
    named = Rooms(old.frame, old.labels, tuple(f"the {index}" for index in range(len(old.names))))
    frame = home.map.frame
    wider = GridFrame(
        frame.resolution,
        frame.origin_x - 2.37,
        frame.origin_y - 2.02,
        frame.rows + 80,
        frame.columns + 88,
    )
    values = np.full(wider.shape, OCCUPIED, np.int8)
    values[40:-40, 48:-40] = home.map.values
    new = segment(OccupancyMap(wider, values))
    carried = carry_over(new, named, Zones(), SHARE)
    assert carried.lost == ()
    assert set(carried.rooms.names) == set(named.names)
    for label, room in enumerate(carried.rooms.names, 1):
        x, y = carried.rooms.anchor(label)
        assert named.names[named.at(x, y) - 1] == room


def test_rooms_and_zones_of_another_frame_are_where_they_were() -> None:
    """The old map is turned by a quarter: what was along x is along y."""
    old_in_new = Pose(5.0, -2.0, 0.5 * math.pi)
    old = rooms_of((0, 30, "kitchen"), (30, 60, "hall"), (60, 80, "bath"))
    corner = old_in_new.compose(Pose(FRAME.origin_x, FRAME.extent[3]))
    # The new grid lies a third of a cell off.
    frame = GridFrame(0.05, corner.x - 0.017, corner.y + 0.017, FRAME.columns, FRAME.rows)
    labels = np.zeros(frame.shape, np.int16)
    labels[:30], labels[30:60], labels[60:] = 3, 1, 2
    carried = carry_over(Rooms(frame, labels, ("a", "b", "c")), old, ZONES, SHARE, old_in_new)
    assert carried.rooms.names == ("hall", "bath", "kitchen")
    assert carried.lost == ()
    (zone,) = carried.zones.all
    assert (zone.name, zone.kind) == ("bowl", ZoneKind.WALL)
    assert np.array(zone.points) == pytest.approx(np.array([[2.5, -2.0], [2.5, -1.0]]))
    # As if it were the same frame they would lie elsewhere.
    assert carry_over(Rooms(frame, labels, ("a", "b", "c")), old, ZONES, SHARE).zones == ZONES
    assert carry_over(
        Rooms(frame, labels, ("a", "b", "c")), None, ZONES, SHARE, old_in_new
    ).zones.all == (zone,)


@st.composite
def divisions(draw: st.DrawFn) -> Rooms:
    """Some columns divided among rooms with any names, some of them with numbers."""
    borders = sorted(draw(st.sets(st.integers(0, FRAME.columns), min_size=2, max_size=8)))
    names = draw(
        st.lists(
            st.sampled_from([*(f"Room {number}" for number in range(1, 9)), *"abcdefgh"]),
            min_size=len(borders) - 1,
            max_size=len(borders) - 1,
            unique=True,
        )
    )
    parts = [
        (first, last, name) for first, last, name in zip(borders, borders[1:], names, strict=False)
    ]
    return rooms_of(*draw(st.permutations(parts)))


@given(divisions(), divisions())
@settings(max_examples=examples(150))
def test_no_name_is_there_twice_and_none_is_lost_whose_room_is_there(
    old: Rooms, new: Rooms
) -> None:
    carried = carry_over(new, old, ZONES, SHARE).rooms
    assert len(set(carried.names)) == len(new.names)
    for index, name in enumerate(old.names):
        mine = old.labels == index + 1
        for label in range(1, len(new.names) + 1):
            its = new.labels == label
            shared = np.count_nonzero(mine & its)
            # More than half of either: no other one can be as much the same room.
            if 2 * shared > max(np.count_nonzero(mine), np.count_nonzero(its)):
                assert name in carried.names


@given(divisions(), divisions())
@settings(max_examples=examples(100))
def test_names_share_as_much_floor_as_can_be(old: Rooms, new: Rooms) -> None:
    """Compared with all ways to pair them, tried one after the other."""
    carried = carry_over(new, old, ZONES, SHARE)
    shares = np.zeros((len(new.names), len(old.names)))
    for row, column in np.ndindex(shares.shape):
        mine, its = new.labels == row + 1, old.labels == column + 1
        shared = np.count_nonzero(mine & its)
        if 2 * shared >= min(np.count_nonzero(mine), np.count_nonzero(its)):
            shares[row, column] = shared
    kept = set(old.names) - set(carried.lost)
    found = sum(
        shares[row, old.names.index(name)]
        for row, name in enumerate(carried.rooms.names)
        if name in kept and shares[row, old.names.index(name)] > 0.0
    )
    assert found == most(shares, 0, frozenset())


def most(shares: NDArray[np.float64], row: int, taken: frozenset[int]) -> float:
    if row == len(shares):
        return 0.0
    without = most(shares, row + 1, taken)
    free = [column for column in np.flatnonzero(shares[row]).tolist() if column not in taken]
    ways = [float(shares[row, c]) + most(shares, row + 1, taken | {c}) for c in free]
    return max([without, *ways])


def test_a_floor_of_which_little_changed_is_divided_as_before() -> None:
    old = rooms_of((0, 30, "kitchen"), (30, 60, "hall"), (60, 80, "bath"))
    new = rooms_of((0, 80, "Room 1"))
    new.labels[10:12, 40:44] = 0
    divided = divided_as(old, new)
    assert divided is not None
    assert divided.names == old.names
    assert np.array_equal(divided.labels, np.where(new.labels > 0, old.labels, 0))


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ((slice(None), slice(60, 80)), "a room is gone"),
        ((slice(None), slice(44, 46)), "a room is in pieces"),
    ],
)
def test_a_division_that_fits_no_more_is_none(changed: tuple[slice, slice], why: str) -> None:
    old = rooms_of((0, 30, "kitchen"), (30, 60, "hall"), (60, 80, "bath"))
    new = rooms_of((0, 80, "Room 1"))
    new.labels[changed] = 0
    assert divided_as(old, new) is None, why


def test_a_division_that_leaves_floor_out_or_is_of_another_grid_is_none() -> None:
    new = rooms_of((0, 80, "Room 1"))
    assert divided_as(rooms_of((0, 74, "kitchen")), new) is None  # of 6 columns, 0.6 m2
    assert divided_as(rooms_of((0, 76, "kitchen")), new) is not None
    elsewhere = rooms_of((0, 80, "Room 1"), frame=GridFrame(0.05, -1.05, 2.0, 40, 80))
    assert divided_as(elsewhere, new) is None
