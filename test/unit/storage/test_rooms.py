"""Rooms on disk: the same after reading as before writing, and never half a file."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from roomba.errors import RoomsError
from roomba.files.kept import unsealed
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.rooms.rooms import Rooms
from roomba.storage.map_bound import map_digest
from roomba.storage.rooms import load_rooms, save_rooms
from roomba.vocabulary import LONGEST_NAME


def two_rooms(column: int = 30) -> tuple[OccupancyMap, Rooms]:
    """Two rooms beside each other, the left one around a table."""
    frame = GridFrame(0.05, -1.0, 2.0, 40, 60)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    values[10:16, 8:14] = OCCUPIED
    labels = np.where(np.arange(60) < column, 1, 2) * (values == FREE)
    return OccupancyMap(frame, values), Rooms(
        frame, labels.astype(np.int16), ("Küche", "Room: 2 #x")
    )


def test_rooms_are_read_as_they_were_written(tmp_path: Path) -> None:
    occupancy, rooms = two_rooms()
    path = tmp_path / "deep" / "rooms.yaml"
    save_rooms(rooms, occupancy, path)
    read = load_rooms(path, occupancy)
    assert read is not None
    assert read.names == rooms.names
    assert np.array_equal(read.labels, rooms.labels)
    assert [entry.name for entry in path.parent.iterdir()] == ["rooms.yaml"]


@given(st.text(min_size=1, max_size=LONGEST_NAME))
@example("a: {b}, [c] # d")
@example("\"'\\ \N{DOG FACE}")
def test_every_name_that_is_taken_comes_back(name: str) -> None:
    occupancy, rooms = two_rooms()
    try:
        named = rooms.renamed("Küche", name)
    except RoomsError:
        assert not name.isprintable() or not name.strip() or name.strip() == rooms.names[1]
        return
    with TemporaryDirectory() as folder:
        path = Path(folder) / "rooms.yaml"
        save_rooms(named, occupancy, path)
        read = load_rooms(path, occupancy)
        assert read is not None
        assert name.strip() in read.names


@pytest.mark.parametrize("name", ["a\x85den", "a\u2028den", "a\nden", "a\0", 1_000_000 * "a"])
def test_a_name_that_cannot_be_told_is_refused_in_few_words(name: str) -> None:
    _, rooms = two_rooms()
    with pytest.raises(RoomsError, match="1 to 80 printable characters") as refusal:
        rooms.renamed("Küche", name)
    assert len(str(refusal.value)) < 200
    with pytest.raises(RoomsError, match="expected a room out of") as refusal:
        rooms.label_of(name)
    assert len(str(refusal.value)) < 600


def test_a_file_of_another_map_is_refused(tmp_path: Path) -> None:
    occupancy, rooms = two_rooms()
    path = tmp_path / "rooms.yaml"
    save_rooms(rooms, occupancy, path)
    values = occupancy.values.copy()
    values[20, 20] = OCCUPIED
    other = OccupancyMap(occupancy.frame, values)
    assert map_digest(other) != map_digest(occupancy)
    with pytest.raises(RoomsError, match=r"rooms\.yaml: expected the rooms of this map"):
        load_rooms(path, other)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("rooms: [", "in YAML"),
        ("[]", "got"),
        ("{map: x}", "rooms"),
        ("{map: x, rooms: [{name: a, outline: [[0, 0]]}]}", r"rooms\.0\.outline"),
        ("{map: x, rooms: [{name: '', outline: []}]}", r"rooms\.0\.name"),
        ("{map: x, rooms: [{name: a, outline: [[0,0],[1e308,0],[1,1],[0,1]]}]}", "1e"),
    ],
)
def test_a_broken_file_is_named_with_the_reason(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "rooms.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RoomsError, match=rf"rooms\.yaml: .*{reason}"):
        load_rooms(path, two_rooms()[0])


def test_without_a_file_there_are_none(tmp_path: Path) -> None:
    assert load_rooms(tmp_path / "nowhere.yaml", two_rooms()[0]) is None


def test_a_damaged_file_is_set_aside_and_the_one_before_is_used(tmp_path: Path) -> None:
    occupancy, rooms = two_rooms()
    path, told = tmp_path / "rooms.yaml", list[str]()
    save_rooms(rooms, occupancy, path)
    save_rooms(rooms.renamed("Küche", "Bad"), occupancy, path)
    path.write_bytes(path.read_bytes().replace(b"Bad", b"Rad"))
    with pytest.raises(RoomsError, match="checksum"):
        load_rooms(path, occupancy)
    found = load_rooms(path, occupancy, told.append)
    assert found is not None
    assert found.names == rooms.names
    assert len(told) == 1
    assert "set aside as rooms.yaml.damaged" in told[0]
    assert load_rooms(path, occupancy, pytest.fail) is not None


def test_rooms_that_overlap_in_the_file_are_refused(tmp_path: Path) -> None:
    occupancy, rooms = two_rooms()
    path = tmp_path / "rooms.yaml"
    save_rooms(rooms, occupancy, path)
    text = unsealed(path.read_bytes()).decode("utf-8")
    half = text[text.index('- {"name"') :]
    path.write_text(text + half.replace("Küche", "third").replace("Room: 2 #x", "fourth"))
    with pytest.raises(RoomsError, match=r"rooms\.yaml: .*overlap"):
        load_rooms(path, occupancy)


def test_an_outline_that_crosses_itself_is_refused(tmp_path: Path) -> None:
    occupancy, _ = two_rooms()
    path = tmp_path / "rooms.yaml"
    crossed = "[[-0.8, 2.2], [0.5, 3.5], [-0.8, 3.5], [0.5, 2.2]]"
    path.write_text(
        f"{{map: {map_digest(occupancy)}, rooms: [{{name: hall, outline: {crossed}}}]}}"
    )
    with pytest.raises(RoomsError, match=r"'hall'.*simple outline"):
        load_rooms(path, occupancy)
