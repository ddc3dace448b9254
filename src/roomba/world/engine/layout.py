"""Makes the flat arrays of homes that the compiled step reads."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.raster.distance import distance_to_nearest
from roomba.world.engine.lidar.edges import LidarEdges, lidar_edges
from roomba.world.engine.lidar.free_squares import QUADRANTS, free_squares
from roomba.world.engine.state.arrays import (
    BOX,
    CARPET,
    CELL,
    DROP,
    FACE,
    FLOOR,
    HOME,
    SOURCE,
    Edges,
    Rows,
)
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM, DirtField
from roomba.world.home.home import Home, MovingThing, cells_in
from roomba.world.home.surface import Finish

_SECONDS_PER_HOUR = 3600.0


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """The arrays of some homes that never change; see :mod:`.state.arrays`."""

    homes: Rows
    cells: Rows
    squares: NDArray[np.uint8]
    faces: Rows
    floors: NDArray[np.bool_]
    sources: Rows
    boxes: Rows
    edges: Edges
    sources_at: list[int]
    """[homes + 1]: the first source of each home."""
    boxes_at: list[list[int]]
    """[homes][things + 1]: the first box of each moving thing."""


def layout_of(homes: Sequence[Home], config: SimulatedRobotConfig) -> Layout:
    """Return the arrays of homes, each once."""
    fields = [DirtField.of(home) for home in homes]
    edges = [lidar_edges(seen_by_lidar(home), home.frame.resolution) for home in homes]
    rows = np.zeros(len(homes), HOME)
    cells_at = _starts([home.solid.size for home in homes])
    squares = [free_squares(home.solid).reshape(QUADRANTS, -1) for home in homes]
    squares_at = _starts([part.shape[1] for part in squares])
    floors_at = _starts([field.micrograms.size for field in fields])
    tiles_at = _starts([len(part.starts) for part in edges])
    faces = [faces_of(home) for home in homes]
    faces_at = _starts([len(part) for part in faces])
    for number, (row, home, field, part) in enumerate(zip(rows, homes, fields, edges, strict=True)):
        frame, station = home.frame, home.station
        row["resolution"], row["left"], row["bottom"] = (
            frame.resolution,
            frame.origin_x,
            frame.origin_y,
        )
        row["cells_at"], row["rows"], row["columns"] = cells_at[number], *frame.shape
        row["squares_at"] = squares_at[number]
        row["station_x"], row["station_y"], row["station_theta"] = (
            station.x,
            station.y,
            station.theta,
        )
        row["dirt_resolution"], row["floors_at"] = field.frame.resolution, floors_at[number]
        row["dirt_rows"], row["dirt_columns"] = field.frame.shape
        row["tiles_at"], row["tile_columns"] = tiles_at[number], part.tile_columns
        row["tile_size"] = part.tile_cells * frame.resolution
        row["has_drops"] = bool(home.drop.any())
        clear = np.count_nonzero(faces[number]["finish"] >= Finish.GLASS)
        row["faces_at"], row["faces_end"] = faces_at[number], faces_at[number + 1]
        row["clear_at"] = faces_at[number + 1] - clear
    crumb = config.simulation.surroundings.crumb / MICROGRAMS_PER_GRAM
    boxes = [[_boxes(thing, config) for thing in home.moving] for home in homes]
    return Layout(
        homes=rows,
        cells=np.concatenate([_cells(home) for home in homes]),
        squares=np.concatenate(squares, axis=1),
        faces=np.concatenate(faces),
        floors=np.concatenate([field.floor.ravel() for field in fields]),
        sources=_rows(SOURCE, [row for home in homes for row in _sources(home, crumb)]),
        boxes=_rows(BOX, [row for of_home in boxes for of_thing in of_home for row in of_thing]),
        edges=joined_edges(edges),
        sources_at=_starts([len(home.dirt_sources) for home in homes]),
        boxes_at=_boxes_at(boxes),
    )


def seen_by_lidar(home: Home) -> NDArray[np.bool_]:
    """Return the cells that stop a beam of the lidar, bool [rows, columns]: all that is solid."""
    return home.solid


def faces_of(home: Home) -> Rows:
    """Return the faces of a home's walls that are free of its grid, FACE, the clear ones last."""
    rows = [
        (
            *left_to_right[1],
            *left_to_right[0],
            float(Finish.MATT if wall.surface is None else wall.surface.finish),
            -1.0 if wall.surface is None else wall.surface.reflectivity,
        )
        for wall in (home.free_walls.walls if home.free_walls is not None else ())
        for left_to_right in itertools.pairwise((*wall.outline, wall.outline[0]))
    ]
    faces = _rows(FACE, rows)
    order = np.argsort(faces["finish"] >= Finish.GLASS, kind="stable")
    return np.asarray(faces[order])


def room_around(solid: NDArray[np.bool_], resolution: float) -> NDArray[np.float32]:
    """Return for the middle of each cell a distance, m, within which nothing is solid.

    Outside is solid; float32 [rows, columns]. With a and b the cells between two squares along
    both axes, the middle of one is sqrt((a + 1/2)^2 + (b + 1/2)^2) from the other or more, which is
    at least sqrt(a^2 + b^2) + 1/2: that is returned, for the nearest.
    """
    # Squares that touch have no cell between them: grow what is solid by one cell all around.
    near = np.pad(solid, 1, constant_values=True)
    near = near[:-2] | near[1:-1] | near[2:]
    near = near[:, :-2] | near[:, 1:-1] | near[:, 2:]
    room = np.where(near, 0.0, (distance_to_nearest(near) + 0.5) * resolution)
    return room.astype(np.float32)


def joined_edges(edges: Sequence[LidarEdges]) -> Edges:
    """Return the edges of several homes, one after the other."""
    firsts = _starts([len(part.items) for part in edges])
    return Edges(
        items=np.concatenate([part.items for part in edges]),
        starts=np.concatenate(
            [part.starts + np.int32(first) for part, first in zip(edges, firsts, strict=False)]
        ),
    )


def _cells(home: Home) -> Rows:
    cells = np.zeros(home.solid.size, CELL)
    cells["solid"] = home.solid.ravel()
    near = home.solid if home.free_walls is None else home.solid | home.free_walls.touched
    cells["room"] = room_around(near, home.frame.resolution).ravel()
    if home.surfaces is not None:
        cells["surface"] = home.surfaces.ravel()
    ground = np.full(home.frame.shape, FLOOR, np.uint8)
    ground[cells_in(home.frame, [carpet.area for carpet in home.carpets])] = CARPET
    ground[home.drop] = DROP
    cells["ground"] = ground.ravel()
    return cells


def _sources(home: Home, crumb: float) -> list[tuple[float, ...]]:
    """Return the sources of dirt, from which crumbs of so many g fall."""
    return [
        (
            source.x,
            source.y,
            source.radius,
            crumb / source.rate * _SECONDS_PER_HOUR if source.rate > 0.0 else math.inf,
        )
        for source in home.dirt_sources
    ]


def _boxes(thing: MovingThing, config: RobotConfig) -> list[tuple[float, ...]]:
    """Return the boxes of a thing that are low enough to stand in the robot's way."""
    return [
        (box.x, box.y, box.theta, 0.5 * box.length, 0.5 * box.width, box.bottom, box.top)
        for box in thing.boxes
        if box.bottom < config.body.height
    ]


def _boxes_at(boxes: list[list[list[tuple[float, ...]]]]) -> list[list[int]]:
    first, found = 0, []
    for of_home in boxes:
        found.append([first + start for start in _starts([len(rows) for rows in of_home])])
        first = found[-1][-1]
    return found


def _starts(counts: Sequence[int]) -> list[int]:
    """Return where each part begins among all of them, and where the last one ends."""
    return [0, *itertools.accumulate(counts)]


def _rows(kind: np.dtype[np.void], rows: Sequence[tuple[float, ...]]) -> Rows:
    return np.array(list(rows), kind)
