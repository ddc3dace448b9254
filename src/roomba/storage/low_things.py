"""Reads and writes what was felt often and never seen, in YAML beside the map's zones."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field

from roomba.errors import RoombaError
from roomba.grid import OccupancyMap
from roomba.perception.rooms.low_things import MOST_LOW_THINGS, LowThing, LowThings
from roomba.storage.map_bound import (
    Entry,
    MapBound,
    Number,
    Tell,
    load_map_bound,
    map_digest,
    save_map_bound,
)

_COMMENT = "What was felt and never seen: lowest x, y, highest x, y in m, map frame; how often."


class LowThingsError(RoombaError):
    """A file of low things that cannot be read."""


class _LowEntry(Entry):
    area: tuple[Number, Number, Number, Number]
    times: Annotated[int, Field(ge=1, le=10**9)]
    ignored: bool = False


class _LowFile(MapBound):
    low_things: Annotated[list[_LowEntry], Field(max_length=MOST_LOW_THINGS)]


def save_low_things(things: LowThings, occupancy: OccupancyMap, path: Path) -> None:
    """Write the low things of a map, atomically; raises OSError when the disk refuses."""
    entries: list[dict[str, object]] = [
        {
            "area": [float(each) for each in (thing.x0, thing.y0, thing.x1, thing.y1)],
            "times": thing.times,
            "ignored": thing.is_ignored,
        }
        for thing in things.all
    ]
    save_map_bound(path, map_digest(occupancy), "low_things", entries, _COMMENT)


def load_low_things(path: Path, occupancy: OccupancyMap, tell: Tell | None = None) -> LowThings:
    """Return the low things that were saved for a map; none if there is no such file.

    With ``tell`` a damaged file is set aside, the one before it is used, and ``tell`` is told so.
    Raises LowThingsError, which names the file and the reason, for a file that cannot be read or is
    of another map.
    """
    file = load_map_bound(path, map_digest(occupancy), _LowFile, "low things", LowThingsError, tell)
    if file is None:
        return LowThings()
    return LowThings(
        tuple(LowThing(*each.area, each.times, each.ignored) for each in file.low_things)
    )
