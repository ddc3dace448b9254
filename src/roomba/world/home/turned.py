"""A home turned by any angle: slanted walls for the robot, exact ones for the world.

The world goes on in the home's own axes, so lidar, contact and camera stay exact and as fast as
they are; poses are told in the turned frame. The grids of that frame show slanted walls as a
map does: in steps. Cells that touch a wall, or floor that is not known, are not free, and tell how
much of them is solid.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.world.home.free_wall import FreeWall, inside
from roomba.world.home.home import (
    DirtSource,
    Furniture,
    Home,
    Move,
    MovingThing,
    Room,
    TurnedFrom,
)

_SAMPLES: Final = 9
"""Samples of a cell in each direction."""
_TO_SIDE: Final = 0.499
"""Cells; from a cell's middle to the outermost samples."""


def turned_home(home: Home, angle: float) -> Home:
    """Return a home turned counter-clockwise by ``angle``, rad, about the origin of its frame.

    Its doors and carpets are those of ``exact`` alone, since rectangles lie along the axes. Raises
    ValueError for a home that is turned already.
    """
    if home.axes.theta != 0.0:
        raise ValueError("expected a home in its own axes, got one that is turned already")
    home = home.exact
    axes, own = Pose(0.0, 0.0, angle), home.frame
    frame = turned_frame(own, angle)
    return replace(
        home,
        **_grids(home, frame, angle),
        station=axes.compose(home.station),
        rooms=tuple(_room(room, axes) for room in home.rooms),
        furniture=tuple(_furniture(piece, axes) for piece in home.furniture),
        doors=(),
        carpets=(),
        stairs=(),
        dirt_sources=tuple(_dirt_source(source, axes) for source in home.dirt_sources),
        moving=tuple(_moving(thing, axes) for thing in home.moving),
        turned=TurnedFrom(home, axes, _in_middles(home.drop, False, own, frame, angle)),
    )


def with_steps(home: Home) -> Home:
    """Return a home as its map shows it, in steps; ``home`` is exact, with free walls."""
    turned = TurnedFrom(home, Pose(), home.drop)
    return replace(home, **_grids(home, home.frame, 0.0), turned=turned)


def turned_frame(frame: GridFrame, angle: float) -> GridFrame:
    """Return a grid along the axes, of the same cell size, that holds all of a turned grid.

    The corner of the turned grid's first cell is a corner of cells of the new grid, so that after
    quarter turns cells lie on cells.
    """
    x_min, x_max, y_min, y_max = frame.extent
    corners = Pose(0.0, 0.0, angle).transform(
        np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]])
    )
    size, first = frame.resolution, corners[0]
    low = np.floor((corners.min(axis=0) - first) / size + 1e-6)
    high = np.ceil((corners.max(axis=0) - first) / size - 1e-6)
    columns, rows = (high - low).astype(int).tolist()
    x, y = (first + low * size).tolist()
    return GridFrame(size, x, y, rows, columns)


def _grids(home: Home, frame: GridFrame, angle: float) -> dict[str, Any]:
    """Return map, solid and walls of an exact home over ``frame``; None for what has no steps."""
    own, found = home.frame, home.free_walls
    free = found.walls if found is not None else ()
    mapped = [wall for wall in free if wall.on_map]
    walls = [wall for wall in free if wall.line]
    is_wall = _share(home.map.values == OCCUPIED, False, own, frame, angle, mapped) > 0.0
    # The body does not pass what is not known: that is as solid as a wall.
    share = _share(home.map.values != FREE, True, own, frame, angle, mapped)
    grades = np.ceil(OCCUPIED * share).astype(np.int8)
    is_unknown = (share == 1.0) & ~is_wall
    return {
        "map": OccupancyMap(frame, np.where(is_unknown, np.int8(UNKNOWN), grades)),
        "solid": _share(home.solid, True, own, frame, angle, free) > 0.0,
        "walls": _share(home.walls, False, own, frame, angle, walls) > 0.0,
        "free_walls": None,
        "surfaces": None,
    }


def _share(
    cells: Mask,
    beyond: bool,
    own: GridFrame,
    frame: GridFrame,
    angle: float,
    free: Sequence[FreeWall],
) -> Floats:
    """Return how much of each cell of ``frame`` lies on ``cells`` of ``own``, or on walls, 0..1."""
    offsets = np.linspace(-_TO_SIDE, _TO_SIDE, _SAMPLES)
    counts = np.zeros(frame.shape, np.int64)
    for up in offsets.tolist():
        for aside in offsets.tolist():
            x, y = _own_places(frame, angle, (up, aside))
            found = _values_at(cells, beyond, own, x, y)
            counts += (found | inside(free, x, y)) if free else found
    share: Floats = counts / _SAMPLES**2
    return share


def _in_middles(
    values: NDArray[Any], beyond: int, own: GridFrame, frame: GridFrame, angle: float
) -> NDArray[Any]:
    """Return what ``values`` of ``own`` are in the middles of the cells of ``frame``."""
    return _values_at(values, beyond, own, *_own_places(frame, angle, (0.0, 0.0)))


def _own_places(
    frame: GridFrame, angle: float, offset: tuple[float, float]
) -> tuple[Floats, Floats]:
    """Return x and y in a home's own axes of all cells, ``offset`` cells off their middles."""
    columns, rows = np.arange(frame.columns) + offset[1], np.arange(frame.rows) + offset[0]
    x, y = frame.centres(rows, columns)
    cosine, sine = math.cos(angle), math.sin(angle)
    return (
        cosine * x[None, :] + sine * y[:, None],
        cosine * y[:, None] - sine * x[None, :],
    )


def _values_at(
    values: NDArray[Any], beyond: int, own: GridFrame, x: Floats, y: Floats
) -> NDArray[Any]:
    """Return the values of the cells in which places lie."""
    row, column = own.cells_of(x, y)
    padded = np.pad(values, 1, constant_values=beyond)
    found: NDArray[Any] = padded[
        np.clip(row + 1, 0, own.rows + 1), np.clip(column + 1, 0, own.columns + 1)
    ]
    return found


def _room(room: Room, axes: Pose) -> Room:
    return replace(room, outline=tuple(_point(axes, x, y) for x, y in room.outline))


def _furniture(piece: Furniture, axes: Pose) -> Furniture:
    return replace(
        piece,
        pose=axes.compose(piece.pose),
        boxes=tuple(box.placed_at(axes) for box in piece.boxes),
    )


def _dirt_source(source: DirtSource, axes: Pose) -> DirtSource:
    x, y = _point(axes, source.x, source.y)
    return replace(source, x=x, y=y)


def _moving(thing: MovingThing, axes: Pose) -> MovingThing:
    moves = tuple(_move(move, axes) for move in thing.script.moves)
    return replace(thing, pose=axes.compose(thing.pose), script=replace(thing.script, moves=moves))


def _move(move: Move, axes: Pose) -> Move:
    return replace(move, pose=axes.compose(move.pose))


def _point(axes: Pose, x: float, y: float) -> tuple[float, float]:
    point = axes.compose(Pose(x, y, 0.0))
    return point.x, point.y
