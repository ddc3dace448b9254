"""Turns a layer file's entries into the parts of a home, and refuses what cannot be."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import shapely
from shapely.validation import explain_validity

from roomba.files.home_layer import FurnitureEntry, Layer
from roomba.files.strict_yaml import Location, YamlFile, suggestion
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.world.catalogue.furniture import KINDS, Size, furniture_at
from roomba.world.home.home import (
    Carpet,
    DirtSource,
    Door,
    Furniture,
    MovingKind,
    MovingThing,
    Rectangle,
    Room,
)
from roomba.world.home.materials import CARPETS, FLOORS
from roomba.world.layers.check import Checker
from roomba.world.layers.moving import moving_things
from roomba.world.layers.walls import Walls, walls_of


@dataclass(frozen=True, slots=True)
class Parts:
    """What a layer file adds to a map; None where it says nothing and a default is needed.

    ``furniture`` is what stays; ``moved`` are the pieces that are among the ``moving`` things, as
    they stand at first. ``materials`` are those that the layer gives pieces, by their names.
    """

    wall_height: float
    station: Pose | None
    walls: Walls | None
    rooms: tuple[Room, ...]
    furniture: tuple[Furniture, ...]
    doors: tuple[Door, ...]
    carpets: tuple[Carpet, ...]
    stairs: tuple[Rectangle, ...]
    dirt_sources: tuple[DirtSource, ...] | None
    moved: tuple[Furniture, ...] = ()
    moving: tuple[MovingThing, ...] = ()
    materials: Mapping[str, str] = field(default_factory=dict)


def parts_of(layer: Layer, file: YamlFile, frame: GridFrame) -> Parts:
    """Return the parts that a layer describes; raises HomeError with the line of what is wrong."""
    check = Checker(file, frame)
    pieces = tuple(
        _piece(("furniture", index), entry, check) for index, entry in enumerate(layer.furniture)
    )
    doors = tuple(
        Door(door.name, check.rectangle(("doors", index, "opening"), door.opening), door.open)
        for index, door in enumerate(layer.doors)
    )
    moving = moving_things(layer, doors, pieces, check)
    moved = {thing.name for thing in moving if thing.kind is MovingKind.FURNITURE}
    swinging = {thing.name for thing in moving if thing.kind is MovingKind.DOOR}
    return Parts(
        layer.wall_height,
        _station(layer, check),
        walls_of(layer, check),
        _rooms(layer, check),
        tuple(piece for piece in pieces if piece.name not in moved),
        tuple(replace(d, is_open=True) if d.name in swinging else d for d in doors),
        tuple(
            Carpet(
                carpet.name,
                check.rectangle(("carpets", index, "area"), carpet.area),
                check.material(("carpets", index, "material"), carpet.material, CARPETS),
            )
            for index, carpet in enumerate(layer.carpets)
        ),
        _rectangles("stairs", layer.stairs, check),
        _dirt_sources(layer, check),
        tuple(piece for piece in pieces if piece.name in moved),
        moving,
        {piece.name: piece.material for piece in layer.furniture if piece.material is not None},
    )


def _station(layer: Layer, check: Checker) -> Pose | None:
    if layer.station is None:
        return None
    check.point(("station",), layer.station.x, layer.station.y)
    return Pose(layer.station.x, layer.station.y, layer.station.facing)


def _rectangles(key: str, areas: list[list[float]], check: Checker) -> tuple[Rectangle, ...]:
    return tuple(check.rectangle((key, index), corners) for index, corners in enumerate(areas))


def _rooms(layer: Layer, check: Checker) -> tuple[Room, ...]:
    rooms = []
    for index, entry in enumerate(layer.rooms):
        location: Location = ("rooms", index)
        check.material((*location, "floor"), entry.floor, {**FLOORS, **CARPETS})
        for number, (x, y) in enumerate(entry.outline):
            check.point((*location, "outline", number), x, y)
        polygon = shapely.Polygon(entry.outline)
        if not polygon.is_valid or polygon.area <= 0.0:
            raise check.file.error(
                (*location, "outline"),
                f"room {entry.name!r}: expected corners in order around the room, got an outline "
                f"that crosses itself ({explain_validity(polygon)}); sort the corners",
            )
        rooms.append(Room(entry.name, tuple((x, y) for x, y in entry.outline), entry.floor))
    return tuple(rooms)


def _piece(location: Location, entry: FurnitureEntry, check: Checker) -> Furniture:
    if entry.kind not in KINDS:
        raise check.file.error(
            (*location, "kind"),
            f"furniture {entry.name!r}: expected a kind of the catalogue, got {entry.kind!r}; "
            f"{suggestion(entry.kind, KINDS)}",
        )
    check.point(location, entry.x, entry.y)
    if entry.material is not None:
        check.material((*location, "material"), entry.material)
    usual = KINDS[entry.kind].size
    size = Size(
        entry.size.width or usual.width,
        entry.size.depth or usual.depth,
        entry.size.height or usual.height,
    )
    piece = furniture_at(
        entry.name,
        entry.kind,
        Pose(entry.x, entry.y, entry.facing),
        size=size,
        material=entry.material,
        on_map=entry.on_map,
    )
    if not all(_is_box(box.length, box.width, box.top - box.bottom) for box in piece.boxes):
        raise check.file.error(
            (*location, "size"),
            f"furniture {entry.name!r}: expected a size that a {entry.kind} can have (usual: "
            f"{usual.width:g} x {usual.depth:g} x {usual.height:g}), got {size.width:g} x "
            f"{size.depth:g} x {size.height:g}; make it larger",
        )
    return piece


def _is_box(*sides: float) -> bool:
    return all(math.isfinite(side) and side > 0.0 for side in sides)


def _dirt_sources(layer: Layer, check: Checker) -> tuple[DirtSource, ...] | None:
    if layer.dirt_sources is None:
        return None
    for index, entry in enumerate(layer.dirt_sources):
        check.point(("dirt_sources", index), entry.x, entry.y)
    return tuple(
        DirtSource(entry.name, entry.x, entry.y, entry.radius, entry.amount, entry.rate)
        for entry in layer.dirt_sources
    )
