"""Reads and writes a map's rooms: names and outlines in YAML, as a home's layer file has them."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import Annotated

import shapely
import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from roomba.errors import RoomsError
from roomba.grid import FREE, OccupancyMap
from roomba.perception.rooms import Rooms

Number = Annotated[float, Field(ge=-1e5, le=1e5)]
"""m; farther from the origin no home is."""
Ring = Annotated[
    list[Annotated[list[Number], Field(min_length=2, max_length=2)]], Field(min_length=4)
]


class _RoomEntry(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True)

    name: Annotated[str, Field(min_length=1)]
    outline: Ring
    holes: list[Ring] = []


class _RoomsFile(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True)

    map: str
    rooms: list[_RoomEntry]


def map_digest(occupancy: OccupancyMap) -> str:
    """Return what tells a map from all others: a SHA-256 of its frame and values, hexadecimal."""
    frame = occupancy.frame
    place = f"{frame.resolution:.6f} {frame.origin_x:.6f} {frame.origin_y:.6f} {frame.shape}"
    return hashlib.sha256(place.encode() + occupancy.values.tobytes()).hexdigest()


def save_rooms(rooms: Rooms, occupancy: OccupancyMap, path: Path) -> None:
    """Write the rooms of a map; a file that is there is replaced at once or not at all.

    Raises OSError when the disk refuses.
    """
    entries = [_entry(rooms, label) for label in range(1, len(rooms.names) + 1)]
    text = yaml.safe_dump(
        {"map": map_digest(occupancy), "rooms": entries},
        sort_keys=False,
        allow_unicode=True,
        default_flow_style=None,
        width=100,
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".tmp")
    with unfinished.open("w", encoding="utf-8") as file:
        file.write("# Rooms of a map; lengths in m, map frame.\n" + text)
        file.flush()
        os.fsync(file.fileno())
    unfinished.replace(path)


def load_rooms(path: Path, occupancy: OccupancyMap) -> Rooms:
    """Return the rooms that were saved for a map.

    Raises RoomsError, which names the file and the reason, for a file that cannot be read or is of
    another map.
    """
    try:
        raw = yaml.safe_load(path.read_text(encoding="utf-8"))
        file = _RoomsFile.model_validate(raw)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise RoomsError(f"{path}: expected a file of rooms in YAML: {error}") from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise RoomsError(f"{path}: {where}: {first['msg']}, got {first['input']!r}") from error
    if file.map != map_digest(occupancy):
        raise RoomsError(
            f"{path}: expected the rooms of this map, got those of another; remove the file, or "
            "bring its map back"
        )
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
