"""The files of one stored map: a folder that any map_server reads, and that is a home as well.

``map.yaml`` and ``map.pgm`` are the map, ``home.yaml`` is a home's layer with the station and the
rooms for people to read, ``rooms.yaml`` and ``zones.yaml`` are the rooms and zones to the cell,
``low_things.yaml`` what the bumper felt and the lidar never saw, ``carpets.yaml`` the carpets that
the brush felt.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
import shapely

from roomba.errors import HomeError, RoombaError, RoomsError
from roomba.files.home_layer import LAYER_NAME, MAP_NAME, read_layer
from roomba.files.kept import remove_kept, write_kept
from roomba.files.occupancy_map import load_map, save_map
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import LowThings
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones, ZonesError
from roomba.storage.carpets import CarpetsError, load_carpets, save_carpets
from roomba.storage.low_things import LowThingsError, load_low_things, save_low_things
from roomba.storage.map_bound import map_digest, yaml_text
from roomba.storage.rooms import load_rooms, save_rooms
from roomba.storage.zones import load_zones, save_zones

ROOMS_NAME: Final = "rooms.yaml"
ZONES_NAME: Final = "zones.yaml"
LOW_THINGS_NAME: Final = "low_things.yaml"
CARPETS_NAME: Final = "carpets.yaml"

_LAYER_COMMENT: Final = "# Station and rooms of a map that the robot made; m and rad.\n"


class MapStoreError(RoombaError):
    """A stored map, or its name, that cannot be used; says what was expected and what to do."""


@dataclass(frozen=True, slots=True, eq=False)
class StoredMap:
    """A floor as the robot knows it, all in the map's frame.

    ``station`` is where the docked robot stands; ``rooms`` is None while the floor is not divided.
    """

    occupancy: OccupancyMap
    station: Pose
    rooms: Rooms | None = None
    zones: Zones = field(default_factory=Zones)
    low_things: LowThings = field(default_factory=LowThings)
    carpets: FeltCarpets = field(default_factory=FeltCarpets)

    def __post_init__(self) -> None:
        """Check that the parts fit together. Raises MapStoreError."""
        if not self.station.is_finite:
            raise MapStoreError(
                f"expected a station at finite numbers, got {self.station}; dock the robot first"
            )
        if self.rooms is not None and self.rooms.frame != self.occupancy.frame:
            raise MapStoreError(
                f"expected rooms over the map's own {self.occupancy.frame}, got them over "
                f"{self.rooms.frame}; divide this map into rooms anew"
            )

    def is_same(self, other: StoredMap) -> bool:
        """Whether another one has the same map, and all that goes with it, to the last bit."""
        return (
            self.occupancy.frame == other.occupancy.frame
            and np.array_equal(self.occupancy.values, other.occupancy.values)
            and self.station == other.station
            and self.zones == other.zones
            and self.low_things == other.low_things
            and self.carpets == other.carpets
            and _are_same_rooms(self.rooms, other.rooms)
        )


def write_map(stored: StoredMap, folder: Path) -> None:
    """Write a map's files into an existing folder, read them back, and compare.

    Files of an earlier map there, of kinds that this map lacks, are removed. Raises MapStoreError
    for a map that files cannot hold, and OSError when the disk refuses.
    """
    try:
        write_floor(stored, folder)
        save_zones(stored.zones, map_digest(stored.occupancy), folder / ZONES_NAME)
        if stored.low_things.all:
            save_low_things(stored.low_things, stored.occupancy, folder / LOW_THINGS_NAME)
        if stored.carpets.all:
            save_carpets(stored.carpets, stored.occupancy, folder / CARPETS_NAME)
        if stored.rooms is not None:
            save_rooms(stored.rooms, stored.occupancy, folder / ROOMS_NAME)
        _remove_others(stored, folder)
    except (ValueError, RoomsError) as error:
        raise MapStoreError(f"expected a map that files can hold: {error}") from error
    if not read_map(folder).is_same(stored):
        raise MapStoreError(
            "expected a map that comes back from its files as it was, got another; its rooms are "
            "to be free cells of it, its zones nearer to it than 100 km"
        )


def _remove_others(stored: StoredMap, folder: Path) -> None:
    """Remove files of an earlier map, of kinds that a map does not have."""
    has = {
        LOW_THINGS_NAME: bool(stored.low_things.all),
        CARPETS_NAME: bool(stored.carpets.all),
        ROOMS_NAME: stored.rooms is not None,
    }
    for name, is_there in has.items():
        if not is_there:
            remove_kept(folder / name)


def read_map(folder: Path) -> StoredMap:
    """Return the map of a folder.

    Without ``rooms.yaml`` it has no rooms, without ``zones.yaml`` no zones. Raises MapStoreError,
    which names the file and the reason, for files that are missing, broken, or not of one map.
    """
    if not folder.is_dir():
        raise MapStoreError(f"{folder}: expected the folder of a map, got none; save the map anew")
    try:
        occupancy, station = read_floor(folder)
        rooms = load_rooms(folder / ROOMS_NAME, occupancy)
        zones = load_zones(folder / ZONES_NAME, map_digest(occupancy))
        low_things = load_low_things(folder / LOW_THINGS_NAME, occupancy)
        carpets = load_carpets(folder / CARPETS_NAME, occupancy)
    except (HomeError, RoomsError, ZonesError, LowThingsError, CarpetsError, OSError) as error:
        raise MapStoreError(
            f"{error}; mend the file, or remove the map and let the robot map this floor again"
        ) from error
    return StoredMap(occupancy, station, rooms, zones, low_things, carpets)


def write_floor(stored: StoredMap, folder: Path) -> None:
    """Write what any map_server and any home reads: the map, station and rooms.

    Raises ValueError and RoomsError for what files cannot hold, OSError when the disk refuses.
    """
    save_map(stored.occupancy, folder / MAP_NAME)
    write_kept(folder / LAYER_NAME, _layer_text(stored).encode())


def read_floor(folder: Path) -> tuple[OccupancyMap, Pose]:
    """Return the map and the station alone; raises HomeError, which names the file, and OSError."""
    return load_map(folder / MAP_NAME), _station_of(folder / LAYER_NAME)


def _station_of(path: Path) -> Pose:
    layer, file = read_layer(path)
    if layer.station is None:
        raise file.error(("station",), "station: expected where the docked robot stands, got none")
    return Pose(layer.station.x, layer.station.y, layer.station.facing)


def _layer_text(stored: StoredMap) -> str:
    station = stored.station
    layer: dict[str, object] = {
        "station": {
            "x": float(station.x),
            "y": float(station.y),
            "facing": float(station.theta),
        }
    }
    if stored.rooms is not None:
        rooms = stored.rooms
        layer["rooms"] = [
            {"name": name, "outline": _corners(rooms.outline(label))}
            for label, name in enumerate(rooms.names, 1)
        ]
    return _LAYER_COMMENT + yaml_text(layer)


def _corners(outline: shapely.Geometry) -> list[list[float]]:
    """Return the corners around a room, m; a home's layer has no holes."""
    if not isinstance(outline, shapely.Polygon):
        raise RoomsError("expected rooms in one piece each, got one in several; split it")
    # Not rounded: a corner on the map's border must not come to lie outside of it.
    return [[float(x), float(y)] for x, y in list(outline.exterior.coords)[:-1]]


def _are_same_rooms(one: Rooms | None, other: Rooms | None) -> bool:
    if one is None or other is None:
        return one is other
    return one.names == other.names and np.array_equal(one.labels, other.labels)
