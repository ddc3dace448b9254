"""Reads homes from files: a map_server map, and the layer file beside it.

A home is a folder (``map.yaml`` with its picture, and ``home.yaml``) or any map_server YAML file,
whose layer is then called ``<stem>.home.yaml``. The layer may be missing: then the home has no
rooms and no furniture, its station stands where :mod:`roomba.world.layers.automatic_station` finds
a wall, and :data:`EVEN_DIRT` lies evenly on its floor.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from roomba.arrays import Mask
from roomba.configuration.body import BodyConfig
from roomba.errors import HomeError
from roomba.files.home_layer import MAP_NAME, Layer, files_of_home, read_layer
from roomba.files.occupancy_map import load_map
from roomba.files.strict_yaml import YamlFile
from roomba.geometry import Pose
from roomba.grid import UNKNOWN, OccupancyMap
from roomba.world.home.dirt import DirtField
from roomba.world.home.home import DirtSource, Home, StationPlace
from roomba.world.home.turned import with_steps
from roomba.world.layers.assembly import (
    FurnishedFloor,
    furnished_floor,
    room_for_body,
    station_on,
    with_station,
)
from roomba.world.layers.automatic_station import automatic_station
from roomba.world.layers.definite_map import definite_map, with_small_cells
from roomba.world.layers.paper import is_on_paper, paper_around, paper_end
from roomba.world.layers.parts import Parts, parts_of

EVEN_DIRT = 0.5
"""g/m²; on the floor of a home whose layer names no sources: some days of dust."""
EVEN_DIRT_RATE = 0.005
"""g/(m² h); what falls on it later: about 0.1 g/m² a day."""


def load_home(
    name_or_path: str,
    homes_directory: Path,
    body: BodyConfig | None = None,
    station: Pose | None = None,
) -> Home:
    """Return a home by name (a folder of ``homes_directory``), or by the path of a folder or map.

    ``body`` (default: the shipped robot) decides what is solid at its height and whether it fits
    its station; ``station`` is the docked robot's pose in place of the layer's. Raises
    :class:`HomeError`: ``file:line: reason``.
    """
    map_path, layer_path = files_of_home(name_or_path, homes_directory)
    drawn = with_small_cells(load_map(map_path))
    occupancy = definite_map(drawn)
    if layer_path is None:
        layer, file = Layer(), YamlFile(map_path, {}, None)
    else:
        layer, file = read_layer(layer_path)
    parts = parts_of(layer, file, occupancy.frame)
    if station is not None:
        parts = replace(parts, station=station)
    end = paper_end(drawn, occupancy.frame)
    return _assembled(_name_of(map_path), occupancy, end, parts, file, body or BodyConfig())


def _assembled(
    name: str,
    occupancy: OccupancyMap,
    paper: Mask,
    parts: Parts,
    file: YamlFile,
    body: BodyConfig,
) -> Home:
    floor = furnished_floor(occupancy, parts, body.height)
    docked, place = parts.station, StationPlace.TOLD
    if docked is None:
        docked, place = _found_station(floor, paper, file, body)
    _check_body_fits(floor, docked, file, body)
    floor = _without_paper(floor, paper, docked, parts, body)
    station = station_on(floor, docked, body.radius)
    floor = with_station(floor, station, docked, body.radius)
    _check_dirt_on_floor(floor, parts, file)
    home = Home(
        name,
        floor.map,
        floor.solid,
        floor.walls,
        docked,
        rooms=parts.rooms,
        furniture=(*parts.furniture, station),
        doors=parts.doors,
        carpets=parts.carpets,
        stairs=parts.stairs,
        dirt_sources=((_even_dirt(floor),) if parts.dirt_sources is None else parts.dirt_sources),
        moving=parts.moving,
        wall_height=parts.wall_height,
        free_walls=floor.free,
        surfaces=floor.surfaces,
        station_place=place,
    )
    _check_dirt_fits(home, file)
    return home if floor.free is None else with_steps(home)


def _found_station(
    floor: FurnishedFloor, paper: Mask, file: YamlFile, body: BodyConfig
) -> tuple[Pose, StationPlace]:
    try:
        docked = automatic_station(floor.map, floor.taken, body.radius, paper)
    except HomeError as error:
        raise file.error((), str(error)) from error
    if is_on_paper(floor.map.frame, floor.taken, body.radius, docked, paper):
        return docked, StationPlace.ON_PAPER
    return docked, StationPlace.FOUND


def _without_paper(
    floor: FurnishedFloor, end: Mask, docked: Pose, parts: Parts, body: BodyConfig
) -> FurnishedFloor:
    """Return the grids of a home without the paper around it, which is as unknown as all beyond.

    Where the layer has dirt there it is no paper but floor, as of a terrace.
    """
    around = paper_around(floor.map, floor.taken, body.radius, docked, end)
    frame = floor.map.frame
    dirty = ((source.x, source.y) for source in parts.dirt_sources or ())
    if any(around[frame.cell_of(*place)] for place in dirty if frame.contains(*place)):
        return floor
    values = np.where(around, np.int8(UNKNOWN), floor.map.values)
    occupancy = OccupancyMap(floor.map.frame, values)
    return replace(floor, map=occupancy, solid=floor.solid | around)


def _check_body_fits(floor: FurnishedFloor, docked: Pose, file: YamlFile, body: BodyConfig) -> None:
    if not floor.map.frame.contains(docked.x, docked.y):
        x_min, x_max, y_min, y_max = floor.map.frame.extent
        raise file.error(
            ("station",),
            f"station: expected a place on the map, x {x_min:g} to {x_max:g}, y {y_min:g} to "
            f"{y_max:g}, got ({docked.x:g}, {docked.y:g}); move it",
        )
    room = room_for_body(floor, docked)
    if room < body.radius - 1e-9:
        raise file.error(
            ("station",),
            f"station: expected {body.radius:.3f} m of free floor around ({docked.x:g}, "
            f"{docked.y:g}), where the docked body stands, got {room:.3f} m; move it",
        )


def _check_dirt_on_floor(floor: FurnishedFloor, parts: Parts, file: YamlFile) -> None:
    for index, source in enumerate(parts.dirt_sources or ()):
        row, column = floor.map.frame.cell_of(source.x, source.y)
        inside = floor.map.frame.contains(source.x, source.y)
        if not inside or not floor.bare[row, column]:
            raise file.error(
                ("dirt_sources", index),
                f"dirt source {source.name!r}: expected a place on free floor, got "
                f"({source.x:g}, {source.y:g}), which is none; move it",
            )


def _check_dirt_fits(home: Home, file: YamlFile) -> None:
    field = DirtField.of(home)
    for index, source in enumerate(home.dirt_sources):
        if source.amount <= 0.0:
            continue
        try:
            field.spread(source.x, source.y, source.radius, source.amount)
        except ValueError as error:
            raise file.error(
                ("dirt_sources", index),
                f"dirt source {source.name!r}: expected an amount that the floor can hold, got "
                f"{source.amount:g} g ({error}); let less fall, or spread it wider",
            ) from error


def _even_dirt(floor: FurnishedFloor) -> DirtSource:
    """Return one source so wide that what it spreads is even: within 1 % over the whole map."""
    frame = floor.map.frame
    x_min, x_max, y_min, y_max = frame.extent
    area = float(np.count_nonzero(floor.bare)) * frame.resolution**2
    return DirtSource(
        "dust",
        (x_min + x_max) / 2.0,
        (y_min + y_max) / 2.0,
        10.0 * max(x_max - x_min, y_max - y_min),
        EVEN_DIRT * area,
        EVEN_DIRT_RATE * area,
    )


def _name_of(map_path: Path) -> str:
    return map_path.resolve().parent.name if map_path.name == MAP_NAME else map_path.stem
