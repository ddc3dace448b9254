"""Reads and writes the carpets that were felt, in YAML beside the map's zones."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import shapely
from pydantic import Field, field_validator

from roomba.errors import RoombaError
from roomba.grid import OccupancyMap
from roomba.perception.rooms.felt_carpets import MOST_CARPETS, MOST_CORNERS, FeltCarpets
from roomba.storage.map_bound import (
    Entry,
    MapBound,
    Number,
    Tell,
    load_map_bound,
    map_digest,
    save_map_bound,
)

_COMMENT = "Carpets that the robot's brush felt: their corners, x and y in m, map frame."


class CarpetsError(RoombaError):
    """A file of carpets that cannot be read."""


class _CarpetEntry(Entry):
    corners: Annotated[list[tuple[Number, Number]], Field(min_length=3, max_length=MOST_CORNERS)]

    @field_validator("corners")
    @classmethod
    def _enclose_something(cls, corners: list[tuple[float, float]]) -> list[tuple[float, float]]:
        if not shapely.Polygon(corners).is_valid:
            raise ValueError("expected corners of an outline that does not cross itself")
        return corners


class _CarpetFile(MapBound):
    carpets: Annotated[list[_CarpetEntry], Field(max_length=MOST_CARPETS)]


def save_carpets(carpets: FeltCarpets, occupancy: OccupancyMap, path: Path) -> None:
    """Write the carpets of a map, atomically; raises OSError when the disk refuses."""
    entries: list[dict[str, object]] = [{"corners": corners} for corners in carpets.all]
    save_map_bound(path, map_digest(occupancy), "carpets", entries, _COMMENT)


def load_carpets(path: Path, occupancy: OccupancyMap, tell: Tell | None = None) -> FeltCarpets:
    """Return the carpets that were saved for a map; none if there is no such file.

    With ``tell`` a damaged file is set aside, the one before it is used, and ``tell`` is told so.
    Raises CarpetsError, which names the file and the reason, for a file that cannot be read or is
    of another map.
    """
    file = load_map_bound(path, map_digest(occupancy), _CarpetFile, "carpets", CarpetsError, tell)
    if file is None:
        return FeltCarpets()
    return FeltCarpets(tuple(tuple(entry.corners) for entry in file.carpets))
