"""Converts the zones of Valetudo's map into zones of a home."""

from __future__ import annotations

from typing import Final, NamedTuple

import shapely

from roomba.files.valetudo.home import ValetudoHome
from roomba.geometry import Point
from roomba.perception.rooms.zones import LEAST_AREA, Zone, ZoneKind, Zones, ZonesError
from roomba.vocabulary import MOST_ZONES, listed

_CROSSABLE: Final = 4
"""The number of an area's corners in Valetudo."""


class TakenZones(NamedTuple):
    """The zones that a home gets, and the names of those that were ``left_out``: of no size."""

    zones: Zones
    left_out: tuple[str, ...]

    @property
    def words(self) -> str:
        """A text with the number of zones, and with those that were left out."""
        count = f"{len(self.zones.all)} zones"
        if not self.left_out:
            return count
        return f"{count} ({len(self.left_out)} of no size left out: {listed(self.left_out)})"


def taken_zones(found: ValetudoHome) -> TakenZones:
    """Return the zones of a map, named by their order in it; raises ZonesError."""
    count = len(found.no_go) + len(found.walls)
    if count > MOST_ZONES:
        raise ZonesError(
            f"expected at most {MOST_ZONES} zones, got {count}; delete some in Valetudo"
        )
    zones = {
        f"{word} {number}": _zone_of(f"{word} {number}", kind, points)
        for word, kind, shapes in (
            ("no-go", ZoneKind.NO_GO, found.no_go),
            ("wall", ZoneKind.WALL, found.walls),
        )
        for number, points in enumerate(shapes, start=1)
    }
    left_out = tuple(name for name, zone in zones.items() if zone is None)
    return TakenZones(Zones(tuple(zone for zone in zones.values() if zone)), left_out)


def _zone_of(name: str, kind: ZoneKind, points: tuple[Point, ...]) -> Zone | None:
    """Return a zone, None for one of no size; raises ZonesError."""
    hull = shapely.MultiPoint(points).convex_hull
    if hull.area < LEAST_AREA if kind.is_area else hull.length == 0.0:
        return None
    if kind.is_area and len(points) == _CROSSABLE and not shapely.Polygon(points).is_valid:
        # Told crosswise: around the hull these corners are in order.
        points = tuple((x, y) for x, y in shapely.get_coordinates(hull.exterior)[:-1].tolist())
    try:
        return Zone(name, kind, points)
    except ZonesError as error:
        raise ZonesError(f"{error}; delete it in Valetudo") from error
