"""Turns the ``walls`` of a layer file into rectangles on the grid and walls that are free of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import shapely
from shapely.validation import explain_validity

from roomba.files.home_layer import Layer, WallEntry
from roomba.files.strict_yaml import Location
from roomba.geometry import Point
from roomba.world.home.free_wall import (
    FreeWall,
    arc_outline,
    arc_points,
    counter_clockwise,
    line_outline,
)
from roomba.world.home.home import Rectangle
from roomba.world.home.raster import outline
from roomba.world.home.surface import surface_of
from roomba.world.layers.check import Checker

WALL_LOOK = "wall"


@dataclass(frozen=True, slots=True)
class Walls:
    """Rectangles that the map's cells show, with the materials that they name, and all others."""

    areas: tuple[Rectangle, ...] = ()
    materials: tuple[str | None, ...] = ()
    free: tuple[FreeWall, ...] = ()


def walls_of(layer: Layer, check: Checker) -> Walls | None:
    """Return the walls, None if the layer names none; raises HomeError with a wall's line."""
    if layer.walls is None:
        return None
    areas: list[Rectangle] = []
    materials: list[str | None] = []
    free: list[FreeWall] = []
    for index, entry in enumerate(layer.walls):
        location: Location = ("walls", index)
        if entry.material is not None:
            check.material((*location, "material"), entry.material)
        surface = surface_of(entry.material)
        if entry.area is not None and (surface is None or not surface.is_clear):
            areas.append(check.rectangle(location, entry.area))
            materials.append(entry.material)
        else:
            free.append(_free_wall(location, entry, check))
    return Walls(tuple(areas), tuple(materials), tuple(free))


def _free_wall(location: Location, entry: WallEntry, check: Checker) -> FreeWall:
    thickness = entry.thickness or 0.0
    if entry.area is not None:
        area = check.rectangle(location, entry.area)
        whole, line = outline(area), _middle(area)
        thickness = min(area.x_max - area.x_min, area.y_max - area.y_min)
    elif entry.line is not None:
        line = tuple((x, y) for x, y in entry.line)
        whole = line_outline(line, thickness)
    else:
        assert entry.arc is not None, "an entry has one of its three forms"
        arc = entry.arc
        centre = arc.centre[0], arc.centre[1]
        # An arc that leaves the map may have more pieces than there is memory for.
        for angle in (arc.first, 0.5 * (arc.first + arc.last), arc.last):
            check.point(
                location,
                centre[0] + arc.radius * math.cos(angle),
                centre[1] + arc.radius * math.sin(angle),
            )
        line = tuple(arc_points(centre, arc.radius, arc.first, arc.last))
        whole = arc_outline(centre, arc.radius, arc.first, arc.last, thickness)
    if not whole.is_valid or len(whole.interiors) or whole.area <= 0.0:
        raise check.file.error(
            location,
            "walls: expected a wall that does not meet itself, got one that does "
            f"({explain_validity(whole)}); make it of two",
        )
    for x, y in whole.exterior.coords:
        check.point(location, x, y)
    return FreeWall(
        counter_clockwise(whole),
        line,
        thickness,
        entry.material or WALL_LOOK,
        surface_of(entry.material),
        entry.on_map,
    )


def _middle(area: Rectangle) -> tuple[Point, ...]:
    x, y = 0.5 * (area.x_min + area.x_max), 0.5 * (area.y_min + area.y_max)
    if area.x_max - area.x_min >= area.y_max - area.y_min:
        return (area.x_min, y), (area.x_max, y)
    return (x, area.y_min), (x, area.y_max)


def pane_of(polygon: shapely.Polygon, material: str | None, on_map: bool) -> FreeWall:
    """Return what stands in the way of a piece of furniture of glass, or of a mirror."""
    return FreeWall(
        counter_clockwise(polygon), surface=surface_of(material), on_map=on_map, material="glass"
    )
