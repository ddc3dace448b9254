"""Converts a map of Valetudo into a home's folder, and a home into such a map."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any, Final

import numpy as np
import shapely
import yaml

from roomba.arrays import Mask
from roomba.commands.trials.homes import rooms_of
from roomba.commands.trials.zones import ZONES_NAME, zones_of_home
from roomba.configuration.body import BodyConfig
from roomba.errors import HomeError
from roomba.files.atomic import write_whole
from roomba.files.home_layer import LAYER_NAME, MAP_NAME
from roomba.files.occupancy_map import save_map
from roomba.files.shipped import HOMES
from roomba.files.valetudo.home import ValetudoHome
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.rooms.outlines import outline_of
from roomba.perception.rooms.zones import ZoneKind, Zones
from roomba.storage.map_bound import map_digest
from roomba.storage.zones import save_zones
from roomba.world.home.home import Home
from roomba.world.home.raster import largest_component, where_body_fits
from roomba.world.layers.automatic_station import automatic_station
from roomba.world.layers.definite_map import definite_map
from roomba.world.layers.layer import load_home

_LEAST_PART: Final = 0.5
"""m²; a smaller connected floor is a pocket between furniture, where no robot lives."""
_BY_CHARGER: Final = 0.5
"""m; if all floor is farther from the charger, the floor at the charger is not on the map."""
_COMMENT = "# Imported from a map of Valetudo. Lengths in m, map frame, directions in rad.\n"


def write_home(found: ValetudoHome, zones: Zones, folder: Path) -> Home:
    """Write a home's folder, and return the home; an invalid home leaves no files.

    Raises OSError when the disk refuses, and HomeError where no robot can stand on the station.
    """
    # On the same disk, so that files can be moved. Only the folder itself may be writable.
    beside = next(each for each in (folder, *folder.parents) if each.is_dir())
    with tempfile.TemporaryDirectory(prefix=".import_", dir=beside) as temporary:
        made = Path(temporary) / folder.resolve().name
        _write_files(found, zones, made)
        home = _loaded(made)
        folder.mkdir(parents=True, exist_ok=True)
        # The map comes last: with it the folder becomes a home.
        for file in sorted(made.iterdir(), key=lambda each: each.name == MAP_NAME):
            os.replace(file, folder / file.name)
    return home


def read_home(name: str) -> ValetudoHome:
    """Return a home of files, by name or path; raises HomeError and ZonesError."""
    home = load_home(name, HOMES, BodyConfig())
    rooms = rooms_of(home)
    zones = zones_of_home(name).all
    return ValetudoHome(
        home.map,
        tuple((name, rooms.labels == rooms.label_of(name)) for name in rooms.names),
        home.station,
        tuple(zone.points for zone in zones if zone.kind is ZoneKind.NO_GO),
        tuple(zone.points for zone in zones if zone.kind is ZoneKind.WALL),
    )


def _write_files(found: ValetudoHome, zones: Zones, folder: Path) -> None:
    folder.mkdir(exist_ok=True)
    save_map(found.occupancy, folder / MAP_NAME)
    layer = yaml.safe_dump(
        _layer_of(found, zones, BodyConfig()),
        sort_keys=False,
        allow_unicode=True,
        default_flow_style=None,
        width=110,
    )
    write_whole(folder / LAYER_NAME, f"{_COMMENT}{layer}".encode())
    save_zones(zones, map_digest(found.occupancy), folder / ZONES_NAME)


def _loaded(folder: Path) -> Home:
    """Return a home that was written; raises HomeError without naming its file, a temporary one."""
    try:
        return load_home(str(folder), HOMES, BodyConfig())
    except HomeError as error:
        reason = str(error).removeprefix(str(folder)).partition(": ")[2]
        raise HomeError(reason) from error


def _layer_of(found: ValetudoHome, zones: Zones, body: BodyConfig) -> dict[str, Any]:
    layer: dict[str, Any] = {}
    at = found.station
    if at is not None and not found.has_own_frame:
        at = _station_by_charger(found.occupancy, zones, body.radius)
    elif at is None and zones.barred:
        floor = definite_map(found.occupancy)
        at = automatic_station(floor, _solid(floor, zones), body.radius)
    if at is not None:
        layer["station"] = {"x": round(at.x, 4), "y": round(at.y, 4), "facing": round(at.theta, 6)}
    rooms = []
    for name, mask in found.rooms:
        outline = outline_of(mask, found.occupancy.frame)
        if outline.is_empty:
            continue
        largest = max(shapely.get_parts(outline), key=shapely.area)
        corners = np.round(shapely.get_coordinates(largest.exterior)[:-1], 4)
        rooms.append({"name": name, "outline": corners.tolist()})
    if rooms:
        layer["rooms"] = rooms
    return layer


def _station_by_charger(occupancy: OccupancyMap, zones: Zones, radius: float) -> Pose | None:
    """Return where to dock in the part of the floor by the charger, which is at (0, 0).

    Zones divide the floor as walls do. If no floor is near the charger, the largest part counts.
    None if the largest part counts and there are no zones, as each body then finds a place of its
    own; also None if all parts are too small.
    """
    floor = definite_map(occupancy)
    solid = _solid(floor, zones)
    fits = where_body_fits(floor.frame, solid, radius)
    least = _LEAST_PART / floor.frame.resolution**2
    parts: list[Mask] = []
    left = fits
    while np.count_nonzero(part := largest_component(left)) >= least:
        parts.append(part)
        left = left & ~part
    if not parts:
        return None
    away = [np.hypot(*floor.frame.centres(*np.nonzero(part))).min() for part in parts]
    nearest = int(np.argmin(away)) if min(away) <= _BY_CHARGER else 0
    if nearest == 0 and not zones.barred:
        return None
    return automatic_station(floor, solid | (fits & ~parts[nearest]), radius)


def _solid(floor: OccupancyMap, zones: Zones) -> Mask:
    """Return where no body may be, zones included, bool [rows, columns]."""
    barred = [zone.cells(floor.frame) for zone in zones.barred]
    return np.asarray(np.logical_or.reduce([floor.solid, *barred]))
