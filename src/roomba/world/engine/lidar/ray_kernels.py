"""Compiled single beams: what one ray meets first, how far away, and how squarely.

For lidars whose beams each have a pose of their own; a scan from one pose is quicker as a whole,
see :mod:`.projection`. Metres and radians, map frame; double precision.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import inner_part, part
from roomba.world.engine.lidar.free_squares import MARGIN, RIGHT, UP
from roomba.world.engine.state.arrays import Row, Solid

_TINY: Final = 1e-12
"""A direction with a smaller component never comes to a line across it."""
_NEVER: Final = 1e30
"""Length of a ray, cells, per cell along an axis, if it never moves along that axis."""


@inner_part
def ray_to_cells(
    squares: NDArray[np.uint8],
    home: Row,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    reach: float,
) -> tuple[float, float]:
    """Return the way to the nearest solid cell, m, and the cosine of the angle to its normal.

    All outside of the grid is solid; what is farther than ``reach`` is (inf, 1). The ray goes from
    free square to free square (:mod:`.free_squares`), counted in cells. It never goes back to
    an earlier column or row, as rounding at a corner might make it.
    """
    x, y = (x - home.left) / home.resolution, (y - home.bottom) / home.resolution
    column, row = math.floor(x), math.floor(y)
    if not (0 <= column < home.columns and 0 <= row < home.rows):
        return 0.0, 1.0
    goes_right, goes_up = cosine >= 0.0, sine >= 0.0
    # Unsigned: numba then does not check at each cell whether an index counts from the end.
    quadrant = np.uint64((RIGHT if goes_right else 0) + (UP if goes_up else 0))
    width = home.columns + 2 * MARGIN
    first = home.squares_at + MARGIN * width + MARGIN
    per_column, per_row = inverse_of(cosine), inverse_of(sine)
    farthest = reach / home.resolution
    along, facing = 0.0, 1.0
    while along <= farthest:
        side = int(squares[quadrant, np.uint64(first + row * width + column)])
        if side == 0:
            return along * home.resolution, facing
        line_x = column + side if goes_right else column + 1 - side
        line_y = row + side if goes_up else row + 1 - side
        across_x, across_y = (line_x - x) * per_column, (line_y - y) * per_row
        if across_x < across_y:
            along, facing = max(along, across_x), abs(cosine)
            column = line_x if goes_right else line_x - 1
            beside = math.floor(y + along * sine)
            row = max(row, beside) if goes_up else min(row, beside)
        else:
            along, facing = max(along, across_y), abs(sine)
            row = line_y if goes_up else line_y - 1
            beside = math.floor(x + along * cosine)
            column = max(column, beside) if goes_right else min(column, beside)
    return math.inf, 1.0


@inner_part
def inverse_of(component: float) -> float:
    """Return 1 / component; for next to nothing a very large number of its sign."""
    if abs(component) > _TINY:
        return 1.0 / component
    return _NEVER if component >= 0.0 else -_NEVER


@part
def ray_to_disc(
    x: float, y: float, cosine: float, sine: float, radius: float
) -> tuple[float, float]:
    """Return way and cosine for a disc, its middle as seen from the start; inf from inside."""
    ahead, aside = x * cosine + y * sine, y * cosine - x * sine
    depth = radius * radius - aside * aside
    if ahead <= 0.0 or depth <= 0.0 or x * x + y * y <= radius * radius:
        return math.inf, 1.0
    return ahead - math.sqrt(depth), math.sqrt(depth) / radius


@inner_part
def ray_to_box(
    box: Row, x: float, y: float, turn: float, cosine: float, sine: float
) -> tuple[float, float]:
    """Return way and cosine for a box turned by ``turn``, its middle as seen from the start."""
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
    """Return way and cosine for what is no part of the home: things, round things, other robots.

    Only boxes that reach ``height``, m, count; robots are discs of ``radius`` m.
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
