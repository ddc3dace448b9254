"""The zones of a run: those of the home's folder, and those of the command line."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from roomba.commands.trials.trial import RANDOM, Trial
from roomba.files.home_layer import MAP_NAME, files_of_home
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import HOMES
from roomba.geometry import Pose
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.storage.map_bound import map_digest
from roomba.storage.zones import load_zones

ZONES_NAME: Final = "zones.yaml"
"""The name of the file with a home's zones, in the home's folder."""


def zones_of(trial: Trial) -> Zones:
    """Return the zones of a trial in its home; raises HomeError and ZonesError."""
    of_home = Zones() if trial.home == RANDOM else zones_of_home(trial.home)
    asked = (
        Zone(
            f"no-go {number + 1} of --no-go",
            ZoneKind.NO_GO,
            ((left, bottom), (right, bottom), (right, top), (left, top)),
        )
        for number, (left, bottom, right, top) in enumerate(trial.no_go)
    )
    return Zones((*(_turned(zone, trial.turned) for zone in of_home.all), *asked))


def _turned(zone: Zone, degrees: float) -> Zone:
    """Return a zone, moved to where it lies in the turned home."""
    if not degrees:
        return zone
    points = Pose(0.0, 0.0, math.radians(degrees)).transform(np.array(zone.points))
    return replace(zone, points=tuple((x, y) for x, y in points.tolist()))


def zones_of_home(name_or_path: str) -> Zones:
    """Return the zones beside a home's map, none without such a file.

    ``zones.yaml`` belongs to the folder's ``map.yaml``; a map of another name has no zones. Raises
    HomeError and ZonesError.
    """
    map_path, _ = files_of_home(name_or_path, HOMES)
    file = map_path.with_name(ZONES_NAME)
    if map_path.name != MAP_NAME or not file.is_file():
        return Zones()
    return load_zones(file, map_digest(load_map(map_path)))
