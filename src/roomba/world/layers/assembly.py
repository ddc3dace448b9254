"""Puts a map and a layer's parts together: what is solid, what is on the map, what is a wall."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.world.catalogue.furniture import FIXTURES, LOW_KINDS, STATION_GAP, station_at
from roomba.world.home.free_wall import (
    FreeWall,
    FreeWalls,
    counter_clockwise,
    filled_cells,
    touched_cells,
)
from roomba.world.home.home import Box, Door, Furniture, Rectangle, cells_in
from roomba.world.home.raster import (
    cells_within,
    covered_cells,
    distance_to_cells,
    footprint,
    outline,
)
from roomba.world.home.surface import LOW, surface_of
from roomba.world.layers.parts import Parts
from roomba.world.layers.walls import Walls, pane_of

STATION_REACH = 0.22
"""m; a wall nearer than this behind the station's front is what the station leans on."""
FREE_STATION_DEPTH = 0.10
"""m; of a station that stands free."""
DOCKED_CLEARANCE = 0.005
"""m; around the docked disc in which no cell is the station's, so that rounding never traps it."""


@dataclass(frozen=True, slots=True, eq=False)
class FurnishedFloor:
    """The grids of a home: see :class:`roomba.world.home.home.Home`.

    ``moving`` are the cells that moving things cover, at the body's height, before their first
    move. Of the ``free`` walls, cells that lie within one are ``solid``; no other grid has them.
    """

    map: OccupancyMap
    solid: Mask
    walls: Mask
    drop: Mask
    moving: Mask
    free: FreeWalls | None = None
    surfaces: NDArray[np.uint8] | None = None

    @property
    def standing(self) -> Mask:
        """Cells on which anything stands, if only on a part of the cell."""
        return self.solid if self.free is None else self.solid | self.free.touched

    @property
    def bare(self) -> Mask:
        """Floor on which dirt can lie, also under things that move."""
        return ~self.standing & ~self.drop

    @property
    def taken(self) -> Mask:
        """Where no robot can stand at the start."""
        return ~self.bare | self.moving


def furnished_floor(occupancy: OccupancyMap, parts: Parts, body_height: float) -> FurnishedFloor:
    """Return the grids of a home without its station; ``body_height`` in m.

    Doors are open on the map, and what the map does not show is solid in the truth alone. What
    moves may be on the map where it stands at first, but is not solid. Stairs are floor on the map.
    """
    frame = occupancy.frame
    clear = {piece.name for piece in parts.furniture if _is_clear(parts, piece)}
    opaque = [piece for piece in parts.furniture if piece.name not in clear]
    free = [
        *(parts.walls.free if parts.walls is not None else ()),
        *_panes((p for p in parts.furniture if p.name in clear), parts, body_height),
    ]
    mapped = standing_cells(frame, (p for p in opaque if p.on_map), body_height)
    moved = standing_cells(frame, (p for p in parts.moved if p.on_map), body_height)
    hidden = standing_cells(frame, (p for p in opaque if not p.on_map), body_height)
    shut = _areas(frame, [door.opening for door in parts.doors if not door.is_open])
    open_map = OccupancyMap(frame, _with_doors_open(occupancy, parts.doors))
    if free:
        open_map = _without(open_map, free, parts)
    walls = _walls(open_map, parts)
    # The map's picture may show a piece that moves; where nothing else stands, floor is below it.
    uncovered = moved & ~walls & (open_map.values == OCCUPIED)
    values = open_map.values.copy()
    values[mapped | moved] = OCCUPIED
    return FurnishedFloor(
        OccupancyMap(frame, values),
        solid=(open_map.solid & ~uncovered) | mapped | hidden | shut | filled_cells(frame, free),
        walls=walls,
        drop=cells_in(frame, parts.stairs),
        moving=_covered_below(
            frame, (box for thing in parts.moving for box in thing.first_boxes), body_height
        ),
        free=FreeWalls.on(frame, free) if free else None,
        surfaces=_surfaces(frame, opaque, parts, body_height),
    )


def _is_clear(parts: Parts, piece: Furniture) -> bool:
    if piece.kind in LOW_KINDS:
        return True
    surface = surface_of(parts.materials.get(piece.name))
    return surface is not None and surface.is_clear and piece.kind not in FIXTURES


def _panes(pieces: Iterable[Furniture], parts: Parts, height: float) -> list[FreeWall]:
    return [
        _pane(piece, box, parts) for piece in pieces for box in piece.boxes if box.bottom < height
    ]


def _pane(piece: Furniture, box: Box, parts: Parts) -> FreeWall:
    if piece.kind in LOW_KINDS:
        # No robot has a low thing on its map: no lidar ever saw it.
        return FreeWall(counter_clockwise(footprint(box)), surface=LOW, on_map=False)
    return pane_of(footprint(box), parts.materials[piece.name], piece.on_map)


def _without(open_map: OccupancyMap, free: Sequence[FreeWall], parts: Parts) -> OccupancyMap:
    """Return a map without walls that stand free of the grid, but for what else stands there."""
    touched = touched_cells(open_map.frame, [wall for wall in free if wall.on_map])
    areas = parts.walls.areas if parts.walls is not None else ()
    openings = [door.opening for door in parts.doors]
    others = _areas(open_map.frame, areas) & ~_areas(open_map.frame, openings)
    values = open_map.values.copy()
    values[touched & ~others] = FREE
    return OccupancyMap(open_map.frame, values)


def _surfaces(
    frame: GridFrame, pieces: Sequence[Furniture], parts: Parts, height: float
) -> NDArray[np.uint8] | None:
    """Return the codes of what cells' surfaces do to light; None if no material says so."""
    codes = np.zeros(frame.shape, np.uint8)
    walls = parts.walls or Walls()
    for area, material in zip(walls.areas, walls.materials, strict=True):
        surface = surface_of(material)
        if surface is not None:
            codes[_areas(frame, [area])] = surface.code
    for piece in pieces:
        surface = surface_of(parts.materials.get(piece.name))
        if surface is not None:
            codes[standing_cells(frame, [piece], height)] = surface.code
    return codes if codes.any() else None


def standing_cells(frame: GridFrame, pieces: Iterable[Furniture], height: float) -> Mask:
    """Return the cells that furniture covers below ``height`` m: a body so high meets them.

    Fixtures of a wall do not count: they are part of the wall.
    """
    standing = (piece for piece in pieces if piece.kind not in FIXTURES)
    return _covered_below(frame, (box for piece in standing for box in piece.boxes), height)


def station_on(floor: FurnishedFloor, docked: Pose, body_radius: float) -> Furniture:
    """Return the station before the docked robot's nose; it reaches to the wall if one is near."""
    front = body_radius + STATION_GAP
    depth = FREE_STATION_DEPTH
    step = floor.map.frame.resolution / 10.0
    for number in range(math.ceil(STATION_REACH / step) + 1):
        ahead = docked.compose(Pose(front + number * step, 0.0, 0.0))
        row, column = floor.map.frame.cell_of(ahead.x, ahead.y)
        if floor.map.frame.contains(ahead.x, ahead.y) and floor.standing[row, column]:
            depth = max(number * step, 0.02)
            break
    return station_at(docked, body_radius, depth)


def with_station(
    floor: FurnishedFloor, station: Furniture, docked: Pose, body_radius: float
) -> FurnishedFloor:
    """Return the grids with the station in them, known and solid."""
    frame = floor.map.frame
    cells = covered_cells(frame, (footprint(box) for box in station.boxes[:1]))
    cells &= ~cells_within(frame, body_radius + DOCKED_CLEARANCE, docked.x, docked.y)
    values = floor.map.values.copy()
    values[cells] = OCCUPIED
    return replace(floor, map=OccupancyMap(frame, values), solid=floor.solid | cells)


def room_for_body(floor: FurnishedFloor, docked: Pose) -> float:
    """Return how large a disc fits at the docked pose: its radius, m; 0 inside something."""
    return distance_to_cells(floor.map.frame, floor.taken, docked.x, docked.y)


def _with_doors_open(occupancy: OccupancyMap, doors: Iterable[Door]) -> NDArray[np.int8]:
    values = occupancy.values.copy()
    values[_areas(occupancy.frame, [door.opening for door in doors])] = FREE
    return values


def _covered_below(frame: GridFrame, boxes: Iterable[Box], height: float) -> Mask:
    return covered_cells(frame, (footprint(box) for box in boxes if box.bottom < height))


def _areas(frame: GridFrame, areas: Iterable[Rectangle]) -> Mask:
    return covered_cells(frame, (outline(area) for area in areas))


def _walls(open_map: OccupancyMap, parts: Parts) -> Mask:
    """Return the cells of walls: those that the layer names, else all that is no furniture.

    A scanned map shows furniture and walls alike, a little blurred: hence the margin of a cell.
    """
    occupied = open_map.values == OCCUPIED
    if parts.walls is not None:
        return np.asarray(occupied & _areas(open_map.frame, parts.walls.areas))
    margin = open_map.frame.resolution
    covered = covered_cells(
        open_map.frame,
        (
            shapely.buffer(footprint(box), margin, cap_style="square", join_style="mitre")
            for piece in (*parts.furniture, *parts.moved)
            if piece.kind not in FIXTURES and piece.on_map
            for box in piece.boxes
        ),
    )
    return np.asarray(occupied & ~covered)
