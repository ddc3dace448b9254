"""What the camera sees of doors: frames, the wall above, and leaves that are shut."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.world.home.home import LEAF_HEIGHT, Box, Home, MovingKind

FRAME_WIDTH = 0.06
FRAME_PROUD = 0.015
"""m; how far a frame stands out of its wall."""


def door_boxes(home: Home, walls: NDArray[np.bool_]) -> list[Box]:
    """Return the frame, the wall above, and the leaf if it is shut, of every door.

    A leaf that is among the things that move is left to them.
    """
    moving = {thing.name for thing in home.moving if thing.kind is MovingKind.DOOR}
    boxes: list[Box] = []
    for door in home.doors:
        opening = door.opening
        x, y = 0.5 * (opening.x_min + opening.x_max), 0.5 * (opening.y_min + opening.y_max)
        size_x, size_y = opening.x_max - opening.x_min, opening.y_max - opening.y_min
        along_x = _walls_beside(home, walls, x, y, size_x, size_y) if size_x != size_y else True
        theta, length, thick = (0.0, size_x, size_y) if along_x else (math.pi / 2, size_y, size_x)
        cosine, sine = math.cos(theta), math.sin(theta)
        deep = thick + 2.0 * FRAME_PROUD
        top = min(LEAF_HEIGHT, home.wall_height)
        for side in (-1.0, 1.0):
            # Half in the opening: a jamb is thin there, and wider where it covers the wall's edge.
            place = side * 0.5 * length
            at = (x + place * cosine, y + place * sine)
            boxes.append(Box(*at, theta, 2 * FRAME_PROUD, deep, 0.0, top, "door_frame"))
            place += side * 0.5 * FRAME_WIDTH
            at = (x + place * cosine, y + place * sine)
            boxes.append(Box(*at, theta, FRAME_WIDTH, deep, 0.0, top, "door_frame"))
        wide = length + 2.0 * FRAME_WIDTH
        boxes.append(Box(x, y, theta, wide, deep, top, top + FRAME_WIDTH, "door_frame"))
        boxes.append(Box(x, y, theta, length, thick, top + FRAME_WIDTH, home.wall_height, "wall"))
        if not door.is_open and door.name not in moving:
            boxes.append(Box(x, y, theta, length, 0.04, 0.006, top, "door"))
            handle = 0.5 * length - 0.1
            at = (x + handle * cosine, y + handle * sine)
            boxes.append(Box(*at, theta, 0.12, 0.14, 1.0, 1.02, "steel"))
    return boxes


def _walls_beside(
    home: Home, walls: NDArray[np.bool_], x: float, y: float, size_x: float, size_y: float
) -> bool:
    """Whether an opening's wall runs along x, judged by what is past its ends."""
    past = 0.5 * home.frame.resolution

    def solid(at_x: float, at_y: float) -> int:
        row, column = home.frame.cell_of(at_x, at_y)
        inside = home.frame.contains(at_x, at_y)
        return int(not inside or bool(walls[row, column]))

    ends_x = solid(x - size_x / 2 - past, y) + solid(x + size_x / 2 + past, y)
    ends_y = solid(x, y - size_y / 2 - past) + solid(x, y + size_y / 2 + past)
    return size_x > size_y if ends_x == ends_y else ends_x > ends_y
