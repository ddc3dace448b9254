"""Reads and writes a map's rooms: names and outlines in YAML, as a home's layer file has them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import shapely
from pydantic import Field

from roomba.errors import RoomsError
from roomba.grid import FREE, OccupancyMap
from roomba.perception.rooms.rooms import Rooms
from roomba.storage.map_bound import (
    Entry,
    MapBound,
    Number,
    Tell,
    load_map_bound,
    map_digest,
    save_map_bound,
)

Ring = Annotated[
    list[Annotated[list[Number], Field(min_length=2, max_length=2)]], Field(min_length=4)
]


class _RoomEntry(Entry):
    name: Annotated[str, Field(min_length=1)]
    outline: Ring
    holes: list[Ring] = Field(default_factory=list)


class _RoomsFile(MapBound):
    rooms: list[_RoomEntry]


def save_rooms(rooms: Rooms, occupancy: OccupancyMap, path: Path) -> None:
    """Write the rooms of a map, atomically.

    Raises OSError when the disk refuses.
    """
    entries = [_entry(rooms, label) for label in range(1, len(rooms.names) + 1)]
    save_map_bound(
        path, map_digest(occupancy), "rooms", entries, "Rooms of a map; lengths in m, map frame."
    )


def load_rooms(path: Path, occupancy: OccupancyMap, tell: Tell | None = None) -> Rooms | None:
    """Return the rooms that were saved for a map; None if there is no such file.

    With ``tell`` a damaged file is set aside, the one before it is used, and ``tell`` is told so.
    Raises RoomsError, which names the file and the reason, for a file that cannot be read or is of
    another map.
    """
    file = load_map_bound(path, map_digest(occupancy), _RoomsFile, "rooms", RoomsError, tell)
    if file is None:
        return None
    outlines = [(room.name, _polygon(path, room)) for room in file.rooms]
    try:
        return Rooms.from_outlines(occupancy.frame, occupancy.values == FREE, outlines)
    except RoomsError as error:
        raise RoomsError(f"{path}: {error}") from error


def _polygon(path: Path, room: _RoomEntry) -> shapely.Polygon:
    polygon = shapely.Polygon(room.outline, room.holes)
    if not polygon.is_valid:
        reason = shapely.is_valid_reason(polygon)
        raise RoomsError(f"{path}: room {room.name!r}: expected a simple outline, got {reason}")
    return polygon


def _entry(rooms: Rooms, label: int) -> dict[str, object]:
    outline = rooms.outline(label)
    if not isinstance(outline, shapely.Polygon):
        raise RoomsError(f"expected room {rooms.names[label - 1]!r} in one piece, got several")
    entry: dict[str, object] = {
        "name": rooms.names[label - 1],
        "outline": _corners(outline.exterior),
    }
    if outline.interiors:
        entry["holes"] = [_corners(hole) for hole in outline.interiors]
    return entry


def _corners(ring: shapely.LinearRing) -> list[list[float]]:
    return [[round(float(x), 6), round(float(y), 6)] for x, y in list(ring.coords)[:-1]]
