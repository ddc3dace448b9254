"""What the camera sees of walls that are free of the grid: blocks along them, frames of glass."""

from __future__ import annotations

import math
from itertools import pairwise

from roomba.world.home.free_wall import FreeWall
from roomba.world.home.home import LEAF_HEIGHT, Box, Home
from roomba.world.home.surface import Finish

RAIL = 0.05
"""m; how wide the frame of a pane is."""
FRAME = "metal_dark"


def free_wall_boxes(home: Home) -> list[Box]:
    """Return a block for each piece of a wall, from the floor to the ceiling.

    Of a pane of glass only its frame and the wall above it are drawn: one sees what is behind it.
    """
    boxes: list[Box] = []
    for wall in home.free_walls.walls if home.free_walls is not None else ():
        is_glass = wall.surface is not None and wall.surface.finish is Finish.GLASS
        for begin, end in pairwise(wall.line):
            piece = (*begin, *end)
            if is_glass:
                top = min(LEAF_HEIGHT, home.wall_height - RAIL)
                boxes.append(_block(wall, piece, (0.0, RAIL), FRAME))
                boxes.append(_block(wall, piece, (top, top + RAIL), FRAME))
                if home.wall_height > top + RAIL:
                    boxes.append(_block(wall, piece, (top + RAIL, home.wall_height), "wall"))
            else:
                boxes.append(_block(wall, piece, (0.0, home.wall_height), wall.material))
        if is_glass:
            first, second, *_ = wall.line
            last, before = wall.line[-1], wall.line[-2]
            boxes += [_post(wall, first, second, home), _post(wall, last, before, home)]
    return boxes


def _block(
    wall: FreeWall,
    piece: tuple[float, float, float, float],
    heights: tuple[float, float],
    material: str,
) -> Box:
    x0, y0, x1, y1 = piece
    return Box(
        0.5 * (x0 + x1),
        0.5 * (y0 + y1),
        math.atan2(y1 - y0, x1 - x0),
        math.hypot(x1 - x0, y1 - y0),
        wall.thickness,
        *heights,
        material,
    )


def _post(wall: FreeWall, end: tuple[float, float], other: tuple[float, float], home: Home) -> Box:
    """Return the upright of the frame at an end of a pane."""
    share = RAIL / math.dist(end, other)
    inner = tuple(a + share * (b - a) for a, b in zip(end, other, strict=True))
    return _block(wall, (*end, inner[0], inner[1]), (0.0, home.wall_height), FRAME)
