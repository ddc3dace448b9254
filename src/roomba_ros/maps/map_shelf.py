"""The robot's saved maps on ROS: kept by name, with their rooms and zones."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import rospy

from roomba.configuration.mapping import FloorsConfig
from roomba.errors import RoombaError
from roomba.grid import OccupancyMap
from roomba.perception.floors.carry_over import carry_over
from roomba.perception.floors.recognition import FloorRecord
from roomba.perception.floors.same_floor import match_floors
from roomba.storage.map_bound import map_digest, map_file_name
from roomba.storage.map_store import MapStore, MapStoreError, StoredMap
from roomba.storage.rooms import save_rooms
from roomba.storage.zones import save_zones
from roomba_ros.maps.map_wish import FOLDER
from roomba_ros.rooms.topics import RoomTopics
from roomba_ros.runtime.parameters import folder_of

_INSTEAD: Final = "save this one by another name, or remove that one first (map/remove)"


class MapShelf:
    """Saves, loads and removes maps by name; raises MapStoreError and OSError as the store does.

    Parameters: ``~maps_folder`` (default: roomba_robot/maps in the ROS home folder),
    ``~zones_folder`` (as the mission node has it).
    """

    def __init__(self, rooms: RoomTopics, config: FloorsConfig) -> None:
        """Read nothing yet."""
        self._rooms, self._config = rooms, config

    def start(self) -> None:
        """Read the parameters."""
        self._store = MapStore(folder_of("~maps_folder", FOLDER), rospy.logwarn)
        self._zones_folder = folder_of("~zones_folder", "zones")

    @property
    def names(self) -> tuple[str, ...]:
        """Of all saved maps."""
        return self._store.names()

    @property
    def folder(self) -> Path:
        """Where they are."""
        return self._store.folder

    def load(self, name: str) -> StoredMap:
        """Return a saved map."""
        return self._store.load(name)

    def load_all(self) -> dict[str, StoredMap]:
        """Return all saved maps by name, but those that are broken."""
        loaded = {}
        for name in self._store.names():
            try:
                loaded[name] = self._store.load(name)
            except (MapStoreError, OSError) as error:
                rospy.logwarn("map %s is left out: %s", name, error)
        return loaded

    def save(self, name: str, stored: StoredMap) -> None:
        """Save a map by a name; another one by this name is replaced."""
        self._store.save(name, stored)

    def taken_over(self, name: str, stored: StoredMap) -> StoredMap:
        """Return a newly made map with the names and zones of the saved one of this name.

        Raises MapStoreError if the saved map is of another floor or cannot be read: it is not
        replaced then.
        """
        assert stored.rooms is not None
        old = self._old(name)
        match = match_floors(_floor_of(stored), _floor_of(old), self._config)
        if not match.is_same:
            raise MapStoreError(
                f"expected the floor of the map {name!r} that is saved already, got another one "
                f"(of the walls {100 * match.walls:.0f} % agree where at least "
                f"{100 * self._config.least_walls:.0f} % should, of the floor "
                f"{100 * match.floor:.0f} % of {100 * self._config.least_floor:.0f} %); {_INSTEAD}"
            )
        least = self._config.same_room
        carried = carry_over(stored.rooms, old.rooms, old.zones, least, match.old_in_new)
        zones = stored.zones if stored.zones.all else carried.zones
        return StoredMap(stored.occupancy, stored.station, carried.rooms, zones)

    def go_by(self, stored: StoredMap) -> None:
        """Use a stored map's rooms and zones from now on; raises OSError and RoombaError."""
        assert stored.rooms is not None
        self._rooms.use(stored.rooms)
        save_zones(stored.zones, map_digest(stored.occupancy), self._zones_path(stored.occupancy))

    def _old(self, name: str) -> StoredMap:
        try:
            return self._store.load(name)
        except MapStoreError as error:
            raise MapStoreError(
                f"the map {name!r} that is saved already cannot be read, so it may be of another "
                f"floor ({error}); {_INSTEAD}"
            ) from error

    def remove(self, name: str) -> None:
        """Forget a saved map."""
        self._store.remove(name)

    def keep_beside(self, stored: StoredMap) -> None:
        """Save a map's rooms and zones under the map's digest, by which they are looked up."""
        occupancy = stored.occupancy
        rooms_path, zones_path = self._rooms.path_of(occupancy), self._zones_path(occupancy)
        try:
            if stored.rooms is not None and not rooms_path.exists():
                save_rooms(stored.rooms, occupancy, rooms_path)
            if stored.zones.all and not zones_path.exists():
                save_zones(stored.zones, map_digest(occupancy), zones_path)
        except (OSError, RoombaError) as error:
            rospy.logwarn("rooms and zones of the map are not taken over: %s", error)

    def _zones_path(self, occupancy: OccupancyMap) -> Path:
        return self._zones_folder / f"{map_file_name(map_digest(occupancy))}.yaml"


def _floor_of(stored: StoredMap) -> FloorRecord:
    return FloorRecord(stored.occupancy, stored.station)
