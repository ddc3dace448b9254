"""Compiled single beams: what one ray meets first, how far away, and how squarely.

For lidars whose beams each have a pose of their own; a scan from one pose is quicker as a whole,
see :mod:`.projection`. Metres and radians, map frame; double precision.
"""

from __future__ import annotations

import math
from typing import Final

from roomba.compilation import inner_part, part
from roomba.world.engine.state.arrays import Row, Rows, Solid

_HALF_DIAGONAL: Final = 0.7072
"""Cells; from the middle of a cell to its corner, rounded up."""
_TINY: Final = 1e-12
"""A direction with a smaller component never comes to a line across it."""
_PAST: Final = 1e-9
"""m; so far past a line between cells a ray is in the next one."""


@inner_part
def ray_to_cells(
    cells: Rows, home: Row, x: float, y: float, cosine: float, sine: float, reach: float
) -> tuple[float, float]:
    """Return the way to the nearest solid cell, m, and the cosine of the angle to its normal.

    All outside of the grid is solid; what is farther than ``reach`` is (inf, 1). Where the nearest
    solid cell is far the ray leaps as far as all is free, elsewhere it goes from cell to cell.
    """
    resolution = home.resolution
    x, y = x - home.left, y - home.bottom
    along = 0.0
    facing = 1.0
    while along <= reach:
        here_x, here_y = x + along * cosine, y + along * sine
        column, row = math.floor(here_x / resolution), math.floor(here_y / resolution)
        if column < 0 or column >= home.columns or row < 0 or row >= home.rows:
            return max(0.0, along - _PAST), facing
        cell = cells[home.cells_at + row * home.columns + column]
        if cell.solid:
            return max(0.0, along - _PAST), facing
        leap = cell.room - _HALF_DIAGONAL * resolution
        if leap > resolution:
            along += leap
            continue
        across_x = across_y = math.inf
        if abs(cosine) > _TINY:
            line = (column + (1 if cosine > 0.0 else 0)) * resolution
            across_x = (line - here_x) / cosine
        if abs(sine) > _TINY:
            line = (row + (1 if sine > 0.0 else 0)) * resolution
            across_y = (line - here_y) / sine
        facing = abs(cosine) if across_x < across_y else abs(sine)
        along += max(0.0, min(across_x, across_y)) + _PAST
    return math.inf, 1.0


@part
def ray_to_disc(
    x: float, y: float, cosine: float, sine: float, radius: float
) -> tuple[float, float]:
    """Return the same for a disc, its middle as seen from the ray's start; inf from inside."""
    ahead, aside = x * cosine + y * sine, y * cosine - x * sine
    depth = radius * radius - aside * aside
    if ahead <= 0.0 or depth <= 0.0 or x * x + y * y <= radius * radius:
        return math.inf, 1.0
    return ahead - math.sqrt(depth), math.sqrt(depth) / radius


@inner_part
def ray_to_box(
    box: Row, x: float, y: float, turn: float, cosine: float, sine: float
) -> tuple[float, float]:
    """Return the same for a box turned by ``turn``, its middle as seen from the ray's start."""
    cos_turn, sin_turn = math.cos(turn), math.sin(turn)
    # The ray in the frame of the box.
    start_x, start_y = -(cos_turn * x + sin_turn * y), sin_turn * x - cos_turn * y
    way_x, way_y = cos_turn * cosine + sin_turn * sine, cos_turn * sine - sin_turn * cosine
    if abs(start_x) < box.half_length and abs(start_y) < box.half_width:
        return math.inf, 1.0
    enter, leave, facing = -math.inf, math.inf, 1.0
    for axis in range(2):
        start, way = (start_x, way_x) if axis == 0 else (start_y, way_y)
        half = box.half_length if axis == 0 else box.half_width
        if abs(way) <= _TINY:
            if abs(start) > half:
                return math.inf, 1.0
            continue
        near, far = (-half - start) / way, (half - start) / way
        near, far = min(near, far), max(near, far)
        if near > enter:
            enter, facing = near, abs(way)
        leave = min(leave, far)
    if enter > leave or enter < 0.0:
        return math.inf, 1.0
    return enter, facing


@inner_part
def ray_to_movable(
    solid: Solid,
    world: Row,
    robot: int,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    height: float,
    radius: float,
) -> tuple[float, float]:
    """Return the same for all that is no part of the home: things, round things, other robots.

    Boxes count that reach ``height``, m; robots are discs of ``radius`` m.
    """
    nearest, facing = math.inf, 1.0
    for number in range(world.things_at, world.things_end):
        thing = solid.things[number]
        if thing.present == 0.0:
            continue
        cos_thing, sin_thing = math.cos(thing.theta), math.sin(thing.theta)
        for index in range(thing.boxes_at, thing.boxes_end):
            box = solid.boxes[index]
            if box.bottom <= height < box.top:
                box_x = thing.x - x + cos_thing * box.x - sin_thing * box.y
                box_y = thing.y - y + sin_thing * box.x + cos_thing * box.y
                turn = thing.theta + box.theta
                found, square = ray_to_box(box, box_x, box_y, turn, cosine, sine)
                if found < nearest:
                    nearest, facing = found, square
    for number in range(world.discs_at, world.discs_end):
        disc = solid.discs[number]
        found, square = ray_to_disc(disc.x - x, disc.y - y, cosine, sine, disc.radius)
        if found < nearest:
            nearest, facing = found, square
    for number in range(world.robots_at, world.robots_end):
        other = solid.robots[number]
        if number != robot:
            found, square = ray_to_disc(other.x - x, other.y - y, cosine, sine, radius)
            if found < nearest:
                nearest, facing = found, square
    return nearest, facing
