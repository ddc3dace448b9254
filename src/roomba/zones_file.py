"""Reads and writes a map's no-go zones and virtual walls, in YAML beside the map's rooms."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from roomba.grid import OccupancyMap
from roomba.perception.zones import Zone, ZoneKind, Zones, ZonesError
from roomba.rooms_file import map_digest

Number = Annotated[float, Field(ge=-1e5, le=1e5)]
"""m; farther from the origin no home is."""


class _ZoneEntry(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True)

    name: str
    kind: ZoneKind
    points: list[tuple[Number, Number]]


class _ZonesFile(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True)

    map: str
    zones: list[_ZoneEntry]


def save_zones(zones: Zones, occupancy: OccupancyMap, path: Path) -> None:
    """Write the zones of a map; a file that is there is replaced at once or not at all.

    Raises OSError when the disk refuses.
    """
    entries = [
        {
            "name": zone.name,
            "kind": zone.kind.value,
            "points": [[float(x), float(y)] for x, y in zone.points],
        }
        for zone in zones.all
    ]
    text = yaml.safe_dump(
        {"map": map_digest(occupancy), "zones": entries},
        sort_keys=False,
        allow_unicode=True,
        default_flow_style=None,
        width=100,
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".tmp")
    with unfinished.open("w", encoding="utf-8") as file:
        file.write(
            "# Zones of a map where the robot must not go; lengths in m, map frame.\n" + text
        )
        file.flush()
        os.fsync(file.fileno())
    unfinished.replace(path)


def load_zones(path: Path, occupancy: OccupancyMap) -> Zones:
    """Return the zones that were saved for a map; none if there is no such file.

    Raises ZonesError, which names the file and the reason, for a file that cannot be read or is of
    another map: without its zones a robot may go where it must not.
    """
    if not path.exists():
        return Zones()
    try:
        raw = yaml.safe_load(path.read_text(encoding="utf-8"))
        file = _ZonesFile.model_validate(raw)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise ZonesError(f"{path}: expected a file of zones in YAML: {error}") from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise ZonesError(f"{path}: {where}: {first['msg']}, got {first['input']!r}") from error
    if file.map != map_digest(occupancy):
        raise ZonesError(
            f"{path}: expected the zones of this map, got those of another; remove the file, or "
            "bring its map back"
        )
    try:
        return Zones(tuple(Zone(zone.name, zone.kind, tuple(zone.points)) for zone in file.zones))
    except ZonesError as error:
        raise ZonesError(f"{path}: {error}") from error
