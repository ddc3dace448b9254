"""Rooms answer questions, come back from their outlines exactly, and survive all edits."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from roomba.errors import RoomsError
from roomba.grid import GridFrame
from roomba.perception.rooms.rooms import SMALLEST_PIECE, Rooms
from roomba.raster.regions import numbered_regions
from roomba.vocabulary import LONGEST_NAME

SIZE = 0.1
FRAME = GridFrame(SIZE, -1.0, 0.5, 30, 60)
KITCHEN, HALL, BATH = 1, 2, 3


def home() -> Rooms:
    """A kitchen of 2 x 3 m, a hall of 2 x 3 m, a wall, and a bath behind it."""
    labels = np.zeros(FRAME.shape, np.int16)
    labels[:, :20] = KITCHEN
    labels[:, 20:40] = HALL
    labels[:, 41:] = BATH
    labels[10, 5] = 0  # a leg of a table
    return Rooms(FRAME, labels, ("Kitchen", "Hall", "Bath"))


def same(first: Rooms, second: Rooms) -> bool:
    return first.names == second.names and np.array_equal(first.labels, second.labels)


@st.composite
def any_rooms(draw: st.DrawFn) -> Rooms:
    """Rooms of any shape: in several parts, with holes, touching at corners."""
    shape = draw(st.tuples(st.integers(1, 12), st.integers(1, 12)))
    labels = draw(hnp.arrays(np.int16, shape, elements=st.integers(0, 3)))
    _, labels = np.unique(np.append(0, labels), return_inverse=True)
    labels = labels[1:].reshape(shape).astype(np.int16)
    frame = GridFrame(draw(st.sampled_from([0.05, 0.1, 0.3])), draw(st.floats(-9, 9)), 0.7, *shape)
    return Rooms(frame, labels, tuple(f"Room {number + 1}" for number in range(labels.max())))


def test_rooms_tell_where_and_how_large_they_are() -> None:
    rooms = home()
    assert rooms.label_of("Hall") == HALL
    assert rooms.at(-0.5, 1.0) == KITCHEN
    assert rooms.at(3.05, 1.0) == 0
    assert rooms.at(99.0, 1.0) == 0
    assert rooms.area(KITCHEN) == pytest.approx(6.0 - 0.01)
    assert rooms.area(BATH) == pytest.approx(1.9 * 3.0)


def test_a_name_tag_is_well_inside() -> None:
    rooms = home()
    x, y = rooms.anchor(HALL)
    assert x == pytest.approx(2.0, abs=0.06)
    assert 1.4 < y < 2.6
    square = np.zeros(FRAME.shape, np.int16)
    square[4:9, 20:25] = 1
    assert Rooms(FRAME, square, ("Square",)).anchor(1) == pytest.approx(FRAME.centre_of(6, 22))
    for label in (KITCHEN, HALL, BATH):
        assert rooms.at(*rooms.anchor(label)) == label


def test_doorways_are_where_rooms_touch() -> None:
    [door] = home().doorways()
    assert (door.first, door.second) == (KITCHEN, HALL)
    assert door.x == pytest.approx(1.0, abs=SIZE)
    assert door.y == pytest.approx(2.0, abs=SIZE)
    assert door.width == pytest.approx(3.0, abs=SIZE)


def test_an_outline_runs_along_the_sides_of_cells_around_holes() -> None:
    outline = home().outline(KITCHEN)
    assert outline.geom_type == "Polygon"
    assert outline.bounds == pytest.approx((-1.0, 0.5, 1.0, 3.5))
    [hole] = outline.interiors
    assert shapely.Polygon(hole).bounds == pytest.approx((-0.5, 1.5, -0.4, 1.6))
    assert len(outline.exterior.coords) <= 6


@given(any_rooms())
@settings(max_examples=examples(150))
def test_rooms_come_back_from_their_outlines_exactly(rooms: Rooms) -> None:
    outlines = [(name, rooms.outline(rooms.label_of(name))) for name in rooms.names]
    for label, (_, outline) in enumerate(outlines, 1):
        assert outline.is_valid
        assert outline.area == pytest.approx(rooms.area(label))
    free = np.ones(rooms.frame.shape, np.bool_)
    assert same(Rooms.from_outlines(rooms.frame, free, outlines), rooms)
    closed = rooms.labels != 0
    assert same(Rooms.from_outlines(rooms.frame, closed, outlines), rooms)


@pytest.mark.parametrize(
    ("outlines", "message"),
    [
        ([("A", (0, 1, 1, 2)), ("B", (0.5, 1, 1.5, 2))], "'A' and 'B' that overlap by 50 cells"),
        ([("A", (70, 70, 71, 71))], "free floor in room 'A', got none"),
        ([("A", (-0.9, 0.6, -0.5, 1.0))], "free floor in room 'A', got none"),
        ([("A", (0, 1, 1, 2)), ("A", (1, 1, 2, 2))], "different names, got 'A' twice"),
        ([(" ", (0, 1, 1, 2))], "name every room"),
    ],
)
def test_outlines_that_cannot_be_rooms_are_refused(
    outlines: list[tuple[str, tuple[float, float, float, float]]], message: str
) -> None:
    free = np.ones(FRAME.shape, np.bool_)
    free[:8, :8] = False
    boxes = [(name, shapely.box(*box)) for name, box in outlines]
    with pytest.raises(RoomsError, match=message):
        Rooms.from_outlines(FRAME, free, boxes)


def test_labels_and_names_must_fit() -> None:
    labels = home().labels
    with pytest.raises(RoomsError, match="label from 1 to 2"):
        Rooms(FRAME, labels, ("Kitchen", "Hall"))
    with pytest.raises(RoomsError, match="label from 1 to 4"):
        Rooms(FRAME, labels, ("Kitchen", "Hall", "Bath", "Attic"))
    with pytest.raises(RoomsError, match="shape"):
        Rooms(GridFrame(0.1, 0.0, 0.0, 3, 3), labels, ("Kitchen", "Hall", "Bath"))
    with pytest.raises(RoomsError, match="shape"):
        Rooms.from_outlines(FRAME, np.ones((3, 3), np.bool_), [])
    with pytest.raises(RoomsError, match="label from 1 to 3, got 0"):
        home().area(0)


def test_a_room_gets_another_name() -> None:
    rooms = home().renamed("Hall", "Corridor ")
    assert rooms.names == ("Kitchen", "Corridor", "Bath")
    assert same(rooms.renamed("Corridor", "Hall"), home())
    with pytest.raises(RoomsError, match="there is a room 'Bath' already"):
        home().renamed("Hall", "Bath")
    with pytest.raises(RoomsError, match="did you mean 'Kitchen'"):
        home().renamed("Kichen", "Cuisine")


def test_rooms_that_touch_are_joined_by_the_first_name() -> None:
    rooms = home().joined("Hall", "Kitchen")
    assert rooms.names == ("Hall", "Bath")
    assert rooms.area(1) == pytest.approx(12.0 - 0.01)
    assert rooms.at(-0.5, 1.0) == rooms.at(1.5, 1.0) == 1
    assert rooms.at(4.0, 1.0) == 2


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (("Hall", "Bath"), "expected rooms that touch, got 'Hall', 'Bath'"),
        (("Kitchen", "Hall", "Bath"), "expected rooms that touch"),
        (("Hall",), "two or more rooms to join, got 1"),
        (("Hall", "Hall"), "two or more rooms to join, got 1"),
        (("Hall", "Attic"), "got 'Attic'"),
    ],
)
def test_rooms_that_cannot_be_joined_are_refused(names: tuple[str, ...], message: str) -> None:
    with pytest.raises(RoomsError, match=message):
        home().joined(*names)


def test_a_line_from_wall_to_wall_cuts_a_room() -> None:
    rooms = home().renamed("Bath", "Hall 2").split("Hall", (0.9, 1.55), (3.2, 1.55))
    assert rooms.names == ("Kitchen", "Hall", "Hall 2", "Hall 3")
    assert rooms.at(2.0, 3.0) == HALL
    assert rooms.at(2.0, 0.7) == 4
    assert rooms.area(HALL) + rooms.area(4) == pytest.approx(6.0)
    assert rooms.area(4) == pytest.approx(2.0, abs=0.3)


def test_a_piece_of_a_room_with_the_longest_name_has_a_name_that_is_not_longer() -> None:
    longest = "H" * LONGEST_NAME
    rooms = home().renamed("Hall", longest).split(longest, (0.9, 1.55), (3.2, 1.55))
    assert rooms.names[1] == longest
    assert rooms.names[3] == longest[:-2] + " 2"


def test_what_a_cut_leaves_over_goes_to_the_piece_beside_it() -> None:
    labels = np.zeros(FRAME.shape, np.int16)
    labels[0:4, 0:20] = 1  # a base, between a long arm and a short one
    labels[4:29, 0:5] = 1
    labels[4:8, 16:20] = 1
    rooms = Rooms(FRAME, labels, ("Room",)).split("Room", (-1.5, 0.95), (1.5, 0.95))
    assert rooms.names == ("Room", "Room 2")
    assert rooms.at(-0.8, 3.0) == 1
    assert rooms.at(0.0, 0.6) == rooms.at(0.8, 1.2) == 2


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("start", "end"),
    [
        ((1.2, 2.0), (2.8, 2.0)),  # not up to the walls
        ((0.9, 0.6), (3.2, 0.6)),  # next to nothing on one side
        ((-0.9, 2.0), (0.8, 2.0)),  # in another room
        ((50.0, 50.0), (60.0, 50.0)),
        ((float("nan"), 0.0), (1.0, 2.0)),
    ],
)
def test_a_line_that_cuts_nothing_is_refused(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    with pytest.raises(RoomsError, match="from wall to wall"):
        home().split("Hall", start, end)


ENDS = st.tuples(st.floats(-3.0, 7.0), st.floats(-1.0, 5.0))


@given(st.sampled_from(["Kitchen", "Hall", "Bath"]), ENDS, ENDS)
@settings(max_examples=examples(200))
def test_what_was_split_is_whole_and_joined_again_it_is_as_before(
    name: str, start: tuple[float, float], end: tuple[float, float]
) -> None:
    before = home()
    try:
        after = before.split(name, start, end)
    except RoomsError:
        return  # a line that does not cut the room has a test of its own
    assert np.array_equal(after.labels != 0, before.labels != 0)
    label = before.label_of(name)
    pieces = [label, *range(4, len(after.names) + 1)]
    assert np.array_equal(np.isin(after.labels, pieces), before.labels == label)
    for piece in pieces:
        assert numbered_regions(after.labels == piece).max() == 1
        assert after.area(piece) >= SMALLEST_PIECE - 1e-9
    assert same(after.joined(*(after.names[piece - 1] for piece in pieces)), before)


@given(any_rooms(), st.data())
@settings(max_examples=examples(60))
def test_joining_loses_no_cell(rooms: Rooms, data: st.DataObject) -> None:
    assume(len(rooms.names) > 1)
    names = data.draw(st.permutations(rooms.names).map(lambda names: names[:2]))
    try:
        after = rooms.joined(*names)
    except RoomsError:
        return
    kept: NDArray[np.bool_] = np.isin(rooms.labels, [rooms.label_of(name) for name in names])
    assert np.array_equal(after.labels == after.label_of(names[0]), kept)
    for name in set(rooms.names) - set(names):
        cells = rooms.labels == rooms.label_of(name)
        assert np.array_equal(after.labels == after.label_of(name), cells)
