"""Rooms on disk: the same after reading as before writing, and never half a file."""

from pathlib import Path

import numpy as np
import pytest

from roomba.errors import RoomsError
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.rooms.rooms import Rooms
from roomba.storage.map_bound import map_digest
from roomba.storage.rooms import load_rooms, save_rooms


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
    assert read.names == rooms.names
    assert np.array_equal(read.labels, rooms.labels)
    assert [entry.name for entry in path.parent.iterdir()] == ["rooms.yaml"]


@pytest.mark.parametrize("name", ["a\x85den", "a\u2028den", "a\u2029den", "a\nden"])
def test_a_name_with_line_breaks_comes_back(tmp_path: Path, name: str) -> None:
    occupancy, rooms = two_rooms()
    save_rooms(rooms.renamed("Küche", name), occupancy, tmp_path / "rooms.yaml")
    assert name in load_rooms(tmp_path / "rooms.yaml", occupancy).names


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


def test_a_file_that_is_not_there_is_an_error_too(tmp_path: Path) -> None:
    with pytest.raises(RoomsError, match="nowhere"):
        load_rooms(tmp_path / "nowhere.yaml", two_rooms()[0])


def test_rooms_that_overlap_in_the_file_are_refused(tmp_path: Path) -> None:
    occupancy, rooms = two_rooms()
    path = tmp_path / "rooms.yaml"
    save_rooms(rooms, occupancy, path)
    text = path.read_text(encoding="utf-8")
    half = text[text.index("- name") :]
    path.write_text(text + half.replace("Küche", "third").replace("Room: 2 #x", "fourth"))
    with pytest.raises(RoomsError, match="overlap"):
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
