"""The files of a map that was made: those of a stored map, rooms included."""

from __future__ import annotations

from pathlib import Path

from roomba.errors import RoomsError
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.rooms.rooms import segment
from roomba.storage.map_folder import MapStoreError, StoredMap, write_map


def write_files(folder: Path, occupancy: OccupancyMap, station: Pose) -> None:
    """Write a map into a folder, which is made if it is not there.

    Raises MapStoreError for a map that files cannot hold, and OSError.
    """
    folder = folder.expanduser()
    folder.mkdir(exist_ok=True)
    try:
        write_map(StoredMap(occupancy, station, segment(occupancy)), folder)
    except (RoomsError, MapStoreError):
        # A map that cannot be cut into rooms is still a map.
        write_map(StoredMap(occupancy, station), folder)
