"""Reads and writes a map's no-go zones and virtual walls, in YAML beside the map's rooms."""

from __future__ import annotations

from pathlib import Path

from roomba.files.damaged import aside_of
from roomba.files.kept import before_of
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones, ZonesError
from roomba.storage.map_bound import Entry, MapBound, Number, Tell, load_map_bound, save_map_bound

_COMMENT = "Zones of a map where the robot must not go; lengths in m, map frame."


class _ZoneEntry(Entry):
    name: str
    kind: ZoneKind
    points: list[tuple[Number, Number]]


class _ZonesFile(MapBound):
    zones: list[_ZoneEntry]


def save_zones(zones: Zones, digest: str, path: Path) -> None:
    """Write the zones of the map of a ``digest``, atomically.

    Raises OSError when the disk refuses.
    """
    entries: list[dict[str, object]] = [
        {
            "name": zone.name,
            "kind": zone.kind.value,
            "points": [[float(x), float(y)] for x, y in zone.points],
        }
        for zone in zones.all
    ]
    save_map_bound(path, digest, "zones", entries, _COMMENT)


def load_zones(path: Path, digest: str, tell: Tell | None = None) -> Zones:
    """Return the zones that were saved for the map of a ``digest``; none if there is no such file.

    With ``tell`` a damaged file is set aside, the one before it is used, and ``tell`` is told so.
    Raises ZonesError, which names the file and the reason, for a file that cannot be read, now or
    before, or is of another map: without its zones a robot may go where it must not.
    """
    aside = aside_of(path)
    try:
        file = load_map_bound(path, digest, _ZonesFile, "zones", ZonesError, tell)
    except ZonesError as error:
        was_set_aside = aside.exists() and not path.exists()
        raise ZonesError(f"{error}{_to_do(path)}" if was_set_aside else str(error)) from error
    if file is None and tell and aside.exists() and not before_of(path).exists():
        raise ZonesError(f"{path}: its zones could not be read{_to_do(path)}")
    if file is None:
        return Zones()
    try:
        return Zones(tuple(Zone(zone.name, zone.kind, tuple(zone.points)) for zone in file.zones))
    except ZonesError as error:
        raise ZonesError(f"{path}: {error}") from error


def _to_do(path: Path) -> str:
    """Return what a person can do about zones that are set aside."""
    return (
        f"; without them the robot may go where it must not: mend {aside_of(path)} and name it "
        f"{path.name} again, or remove it to go on without these zones"
    )
