"""A furnished home that a seed makes: the same for the same seed, another one for each other."""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.configuration.body import BodyConfig
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.world.home.home import (
    Carpet,
    DirtSource,
    Door,
    Furniture,
    Home,
    Rectangle,
    Room,
    cells_in,
)
from roomba.world.home.materials import CARPETS, FLOORS
from roomba.world.layers.assembly import furnished_floor, station_on, with_station
from roomba.world.layers.automatic_station import automatic_station
from roomba.world.layers.parts import Parts
from roomba.world.random.furniture import random_furniture
from roomba.world.random.walls import GRID, WALL, random_openings, random_rooms

_STREAM: Final = 20_011
"""Makes the random numbers of homes differ from those of noise with the same seed."""
_OUTER: Final = 0.20
"""m; thickness of the walls around it."""
_AROUND: Final = 0.30
"""m; of unknown floor around the home."""
_HEIGHT: Final = 2.4


def random_home(seed: int, body: BodyConfig) -> Home:
    """Return a home of 1 to about 12 rooms, furniture, carpets and dirt, with its station."""
    random = np.random.default_rng([_STREAM, seed])
    rooms = random_rooms(random)
    openings = random_openings(rooms, random)
    # Its zero lies anywhere in it: the station is found near that.
    zero_x, zero_y = _point_in(rooms[int(random.integers(len(rooms)))], random)
    occupancy = _walls_of(rooms, [opening.area for opening in openings], zero_x, zero_y)
    moved = [_moved(room, -zero_x, -zero_y) for room in rooms]
    areas = [_moved(opening.area, -zero_x, -zero_y) for opening in openings]
    furniture: list[Furniture] = []
    for number, room in enumerate(moved):
        doors = [
            area
            for opening, area in zip(openings, areas, strict=True)
            if number in (opening.first, opening.second)
        ]
        furniture += random_furniture(_inside(room), doors, random, f"room {number + 1}")
    parts = Parts(
        _HEIGHT,
        None,
        None,
        tuple(
            Room(f"room {number + 1}", _corners(room), str(random.choice(sorted(FLOORS))))
            for number, room in enumerate(moved)
        ),
        tuple(furniture),
        tuple(Door(f"door {number + 1}", area, True) for number, area in enumerate(areas)),
        tuple(_carpets(moved, random)),
        (),
        tuple(_dirt(moved, random)),
    )
    floor = furnished_floor(occupancy, parts, body.height)
    docked = automatic_station(floor.map, floor.taken, body.radius)
    station = station_on(floor, docked, body.radius)
    floor = with_station(floor, station, docked, body.radius)
    return Home(
        f"random {seed}",
        floor.map,
        floor.solid,
        floor.walls,
        docked,
        rooms=parts.rooms,
        furniture=(*parts.furniture, station),
        doors=parts.doors,
        carpets=parts.carpets,
        dirt_sources=parts.dirt_sources or (),
    )


def _walls_of(
    rooms: list[Rectangle], openings: list[Rectangle], zero_x: float, zero_y: float
) -> OccupancyMap:
    """Return the map of bare rooms, in a frame whose zero is at a point of the home."""
    width = max(room.x_max for room in rooms)
    height = max(room.y_max for room in rooms)
    margin = _OUTER + _AROUND
    rows = round((height + 2.0 * margin) / GRID)
    columns = round((width + 2.0 * margin) / GRID)
    frame = GridFrame(GRID, -margin, -margin, rows, columns)
    values = np.full(frame.shape, UNKNOWN, np.int8)
    values[cells_in(frame, [Rectangle(-_OUTER, -_OUTER, width + _OUTER, height + _OUTER)])] = (
        OCCUPIED
    )
    values[cells_in(frame, [_inside(room) for room in rooms])] = FREE
    values[cells_in(frame, openings)] = FREE
    placed = GridFrame(GRID, -margin - zero_x, -margin - zero_y, rows, columns)
    return OccupancyMap(placed, values)


def _point_in(room: Rectangle, random: np.random.Generator) -> tuple[float, float]:
    """Return a corner of a cell inside of a room."""
    x, y = random.uniform(room.x_min, room.x_max), random.uniform(room.y_min, room.y_max)
    return round(x / GRID) * GRID, round(y / GRID) * GRID


def _moved(area: Rectangle, x: float, y: float) -> Rectangle:
    return Rectangle(area.x_min + x, area.y_min + y, area.x_max + x, area.y_max + y)


def _inside(room: Rectangle) -> Rectangle:
    """Return a room's floor between its walls."""
    half = 0.5 * WALL
    return Rectangle(room.x_min + half, room.y_min + half, room.x_max - half, room.y_max - half)


def _corners(room: Rectangle) -> tuple[tuple[float, float], ...]:
    return (
        (room.x_min, room.y_min),
        (room.x_max, room.y_min),
        (room.x_max, room.y_max),
        (room.x_min, room.y_max),
    )


def _carpets(rooms: list[Rectangle], random: np.random.Generator) -> list[Carpet]:
    """Return a carpet in the middle of some rooms."""
    carpets = []
    for number, room in enumerate(rooms):
        if random.random() < 0.6:
            continue
        width, height = room.x_max - room.x_min, room.y_max - room.y_min
        share = random.uniform(0.15, 0.3)
        area = Rectangle(
            room.x_min + share * width,
            room.y_min + share * height,
            room.x_max - share * width,
            room.y_max - share * height,
        )
        carpets.append(Carpet(f"carpet {number + 1}", area, str(random.choice(sorted(CARPETS)))))
    return carpets


def _dirt(rooms: list[Rectangle], random: np.random.Generator) -> list[DirtSource]:
    """Return a place in each room that is dirtier, and dust all over."""
    sources = []
    for number, room in enumerate(rooms):
        x, y = _point_in(_inside(room), random)
        radius, amount = random.uniform(0.3, 0.9), random.uniform(0.5, 6.0)
        sources.append(DirtSource(f"dirt {number + 1}", x, y, radius, amount, 0.05 * amount))
    space = sum((room.x_max - room.x_min) * (room.y_max - room.y_min) for room in rooms)
    return [*sources, DirtSource("dust", 0.0, 0.0, 100.0, 0.3 * space, 0.004 * space)]
