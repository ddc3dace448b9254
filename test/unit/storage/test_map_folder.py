"""A stored map on disk: it comes back to the last bit, and other programs read it, too."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.errors import HomeError
from roomba.files.kept import unsealed
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import HOMES
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import LowThing, LowThings
from roomba.perception.rooms.rooms import Rooms, segment
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.raster.regions import numbered_regions
from roomba.storage.map_folder import MapStoreError, StoredMap, read_map, write_map
from roomba.vocabulary import fault_of_name
from roomba.world.layers.layer import load_home

NAMES = st.text(min_size=1, max_size=12).filter(lambda name: not fault_of_name(name))
PLACES = st.floats(-30.0, 30.0)


@st.composite
def occupancies(draw: st.DrawFn) -> OccupancyMap:
    """Any small map: of three values as map_server's, or of all; at any place."""
    rows, columns = draw(st.integers(1, 12)), draw(st.integers(1, 12))
    frame = GridFrame(draw(st.floats(0.01, 0.2)), draw(PLACES), draw(PLACES), rows, columns)
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    values = random.choice([FREE, FREE, OCCUPIED, UNKNOWN], frame.shape).astype(np.int8)
    if draw(st.booleans()):
        values = random.integers(-1, 101, frame.shape).astype(np.int8)
    return OccupancyMap(frame, values)


CARPETS = st.builds(
    lambda x, y, side: ((x, y), (x + side, y), (x + side, y + side), (x, y + side)),
    PLACES,
    PLACES,
    st.floats(0.3, 3.0),
)
LOW_THINGS = st.builds(LowThing, PLACES, PLACES, PLACES, PLACES, st.integers(1, 99), st.booleans())


@st.composite
def stored_maps(draw: st.DrawFn) -> StoredMap:
    occupancy = draw(occupancies())
    labels = numbered_regions(occupancy.values == FREE)
    count = int(labels.max(initial=0))
    names = draw(st.lists(NAMES, min_size=count, max_size=count, unique=True))
    rooms = Rooms(occupancy.frame, labels.astype(np.int16), tuple(names))
    walls = st.lists(st.tuples(PLACES, PLACES), min_size=2, max_size=5, unique=True)
    zones = tuple(
        Zone(name, ZoneKind.WALL, tuple(draw(walls)))
        for name in draw(st.lists(NAMES, max_size=3, unique=True))
    )
    station = Pose(draw(PLACES), draw(PLACES), draw(st.floats(-math.pi, math.pi)))
    low = LowThings(tuple(draw(st.lists(LOW_THINGS, max_size=3))))
    carpets = FeltCarpets(tuple(draw(st.lists(CARPETS, max_size=3))))
    some = draw(st.sampled_from([rooms, None]))
    return StoredMap(occupancy, station, some, Zones(zones), low, carpets)


@given(stored_maps())
@settings(max_examples=examples(80))
def test_all_comes_back_to_the_last_bit(stored: StoredMap) -> None:
    with tempfile.TemporaryDirectory() as folder:
        write_map(stored, Path(folder))
        read = read_map(Path(folder))
    assert read.occupancy.frame == stored.occupancy.frame
    np.testing.assert_array_equal(read.occupancy.values, stored.occupancy.values)
    assert (read.station, read.zones) == (stored.station, stored.zones)
    assert (read.low_things, read.carpets) == (stored.low_things, stored.carpets)
    assert (read.rooms is None) == (stored.rooms is None)
    if read.rooms is not None and stored.rooms is not None:
        assert read.rooms.names == stored.rooms.names
        np.testing.assert_array_equal(read.rooms.labels, stored.rooms.labels)
    assert read.is_same(stored)


def flat() -> StoredMap:
    """The flat as the robot would know it, on cells at odd places."""
    home = load_home("flat", HOMES)
    frame = home.map.frame
    odd = GridFrame(
        frame.resolution, frame.origin_x + 1e-7 / 3.0, frame.origin_y - 0.01234567891, *frame.shape
    )
    occupancy = OccupancyMap(odd, home.map.values)
    napf = Zone("Napf", ZoneKind.NO_GO, ((0.1, 5.0), (0.6, 5.0), (0.6, 5.5)))
    rooms = segment(occupancy).renamed("Room 1", "Stube: #1")
    return StoredMap(occupancy, home.station, rooms, Zones((napf,)))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_map(flat(), tmp_path)
    return tmp_path


def test_a_stored_map_is_a_home(folder: Path) -> None:
    stored = flat()
    assert stored.rooms is not None
    home = load_home(str(folder), folder)
    assert home.station == stored.station
    assert home.frame == stored.occupancy.frame
    # The layer's station is put on the map: some cells before the docked robot.
    changed = home.map.values != stored.occupancy.values
    rows, columns = np.nonzero(changed)
    assert len(rows) < 40
    for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
        assert stored.station.distance_to(*home.frame.centre_of(row, column)) < 0.5
    assert [room.name for room in home.rooms] == list(stored.rooms.names)
    for label, room in enumerate(home.rooms, 1):
        outline = shapely.Polygon(room.outline)
        assert outline.equals_exact(
            shapely.Polygon(stored.rooms.outline(label).exterior), 1e-9
        ) or outline.equals(shapely.Polygon(stored.rooms.outline(label).exterior))


def test_a_stored_map_is_one_of_map_servers(folder: Path) -> None:
    read = load_map(folder / "map.yaml")
    assert read.frame == flat().occupancy.frame
    assert np.array_equal(read.values, flat().occupancy.values)
    assert (folder / "map.pgm").read_bytes().startswith(b"P5\n")
    assert "mode: trinary" in (folder / "map.yaml").read_text()


def test_without_rooms_and_zones_it_has_none(folder: Path) -> None:
    (folder / "rooms.yaml").unlink()
    (folder / "zones.yaml").unlink()
    read = read_map(folder)
    assert read.rooms is None
    assert read.zones == Zones()


def test_of_a_map_that_was_there_before_nothing_is_left(folder: Path) -> None:
    bare = StoredMap(flat().occupancy, Pose(1.0, 2.0, 0.5))
    write_map(bare, folder)
    assert read_map(folder).is_same(bare)
    assert not list(folder.glob("rooms.yaml*"))


@pytest.mark.parametrize(
    ("file", "old", "new", "reason"),
    [
        ("map.yaml", "image:", "imago:", r"map\.yaml:\d+: expected 'image' here"),
        ("map.yaml", "resolution: 0.05", "resolution: 0", "resolution"),
        ("map.pgm", "P5\n", "P7\n", r"map\.pgm"),
        ("map.pgm", "P5\n2", "P5\n92", "got one that is cut short"),
        ("home.yaml", "station:", "# station:", r"home\.yaml"),
        ("home.yaml", "facing: ", "facing: .nan, z: ", "station.facing|known key"),
        ("home.yaml", "station: {", "statoin: {", "did you mean 'station'"),
        ("rooms.yaml", "rooms:", "raeume:", r"rooms\.yaml: rooms"),
        ("rooms.yaml", "map: ", "map: 0", "expected the rooms of this map"),
        ("zones.yaml", "map: ", "map: 0", "expected the zones of this map"),
        ("zones.yaml", "no-go", "go", r"zones\.0\.kind"),
    ],
)
def test_a_broken_file_is_named_with_the_reason(
    folder: Path, file: str, old: str, new: str, reason: str
) -> None:
    path = folder / file
    content = unsealed(path.read_bytes())
    assert old.encode() in content
    path.write_bytes(content.replace(old.encode(), new.encode(), 1))
    with pytest.raises(MapStoreError, match=reason) as error:
        read_map(folder)
    assert str(path) in str(error.value)
    assert "map this floor again" in str(error.value)


@pytest.mark.parametrize("file", ["map.yaml", "map.pgm", "home.yaml"])
def test_a_missing_file_is_named(folder: Path, file: str) -> None:
    (folder / file).unlink()
    with pytest.raises(MapStoreError, match=rf"{folder / file}"):
        read_map(folder)


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(MapStoreError, match="expected the folder of a map, got none"):
        read_map(tmp_path / "nowhere")


def test_a_picture_of_another_size_is_noticed(folder: Path) -> None:
    path = folder / "map.pgm"
    header, rest = unsealed(path.read_bytes()).split(b"\n255\n", 1)
    columns, rows = (int(number) for number in header.split()[1:])
    path.write_bytes(f"P5\n{columns} {rows - 1}\n255\n".encode() + rest[: columns * (rows - 1)])
    with pytest.raises(MapStoreError, match="of another"):
        read_map(folder)


def test_a_layer_without_station_is_refused(folder: Path) -> None:
    (folder / "home.yaml").write_text("wall_height: 2.4\n")
    with pytest.raises(MapStoreError, match="station: expected where the docked robot stands"):
        read_map(folder)


def test_parts_of_different_maps_are_refused() -> None:
    stored = flat()
    other = GridFrame(0.05, 0.0, 0.0, *stored.occupancy.frame.shape)
    with pytest.raises(MapStoreError, match="divide this map into rooms anew"):
        StoredMap(OccupancyMap(other, stored.occupancy.values), stored.station, stored.rooms)
    with pytest.raises(MapStoreError, match="finite"):
        StoredMap(stored.occupancy, Pose(math.nan, 0.0, 0.0))


def three_cells(*labels: int, value: int = FREE) -> StoredMap:
    frame = GridFrame(0.05, 0.0, 0.0, 1, 3)
    values = np.full(frame.shape, value, np.int8)
    rooms = Rooms(frame, np.array([labels], np.int16), ("a",))
    return StoredMap(OccupancyMap(frame, values), Pose(), rooms)


@pytest.mark.parametrize(
    ("stored", "reason"),
    [
        (three_cells(1, 0, 1), "in one piece"),
        (three_cells(1, 1, 0, value=OCCUPIED), "free floor in room 'a'"),
        (three_cells(1, 1, 0, value=101), "values from -1 to 100"),
    ],
)
def test_what_files_cannot_hold_is_refused_and_not_lost_in_silence(
    stored: StoredMap, reason: str, tmp_path: Path
) -> None:
    with pytest.raises(MapStoreError, match=reason):
        write_map(stored, tmp_path)


def test_rooms_that_files_would_change_are_refused(tmp_path: Path) -> None:
    frame = GridFrame(0.05, 0.0, 0.0, 1, 3)
    values = np.array([[FREE, FREE, OCCUPIED]], np.int8)
    rooms = Rooms(frame, np.array([[1, 1, 1]], np.int16), ("a",))
    with pytest.raises(MapStoreError, match="its rooms are to be free cells of it"):
        write_map(StoredMap(OccupancyMap(frame, values), Pose(), rooms), tmp_path)


def test_a_home_without_a_layer_is_still_a_home_but_no_stored_map(folder: Path) -> None:
    (folder / "home.yaml").unlink()
    try:
        load_home(str(folder), folder)
    except HomeError as error:
        raise AssertionError("the map alone is a home") from error
    with pytest.raises(MapStoreError):
        read_map(folder)
