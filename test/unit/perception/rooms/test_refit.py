"""Rooms stay as people made them when furniture comes and goes."""

import numpy as np

from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.rooms.refit import refitted
from roomba.perception.rooms.rooms import Rooms

FRAME = GridFrame(0.05, 0.0, 0.0, 20, 60)
NAMES = ("kitchen", "hall", "study")


def home() -> OccupancyMap:
    """Three rooms of 1 m beside each other, the wall between the first two with a doorway."""
    values = np.full(FRAME.shape, OCCUPIED, np.int8)
    values[1:-1, 1:-1] = FREE
    values[1:-1, [20, 40]] = OCCUPIED
    values[8:12, [20, 40]] = FREE
    return OccupancyMap(FRAME, values)


def rooms_of(occupancy: OccupancyMap) -> Rooms:
    labels = np.where(occupancy.values == FREE, np.arange(60)[None, :] // 20 + 1, 0)
    return Rooms(FRAME, labels.astype(np.int16), NAMES)


def with_thing(
    occupancy: OccupancyMap, rows: slice, columns: slice, value: int = OCCUPIED
) -> OccupancyMap:
    values = occupancy.values.copy()
    values[rows, columns] = value
    return OccupancyMap(FRAME, values)


def test_what_stands_in_a_room_is_no_more_of_it() -> None:
    before = home()
    after = with_thing(before, slice(1, 5), slice(2, 8))
    fitted = refitted(rooms_of(before), before, after)
    assert fitted.names == NAMES
    assert np.array_equal(fitted.labels > 0, after.values == FREE)
    assert np.array_equal(fitted.labels, np.where(after.values == FREE, rooms_of(before).labels, 0))


def test_floor_that_became_free_goes_to_its_room() -> None:
    after = home()
    before = with_thing(after, slice(1, 10), slice(21, 30))
    fitted = refitted(rooms_of(before), before, after)
    assert np.array_equal(fitted.labels, rooms_of(after).labels)


def test_floor_that_belonged_to_no_room_still_does_not() -> None:
    before = home()
    old = rooms_of(before)
    two = Rooms(FRAME, np.where(old.labels == 3, 0, old.labels).astype(np.int16), NAMES[:2])
    fitted = refitted(two, before, with_thing(before, slice(1, 3), slice(2, 4)))
    assert fitted.names == NAMES[:2]
    assert not fitted.labels[:, 41:].any()


def test_of_a_parted_room_the_larger_part_is_left() -> None:
    before = home()
    after = with_thing(before, slice(1, 19), slice(5, 7))
    fitted = refitted(rooms_of(before), before, after)
    assert fitted.names == NAMES
    assert not fitted.labels[:, :5].any()
    assert (fitted.labels[1:-1, 7:20] == 1).all()


def test_a_room_that_is_filled_is_no_more() -> None:
    before = home()
    after = with_thing(before, slice(1, 19), slice(21, 40))
    after = with_thing(after, slice(1, 19), slice(20, 21))
    fitted = refitted(rooms_of(before), before, with_thing(after, slice(1, 19), slice(40, 41)))
    assert fitted.names == ("kitchen", "study")
    assert fitted.labels[10, 50] == 2
