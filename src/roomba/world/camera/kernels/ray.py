"""Compiled rays of the camera in the plane: which wall a column meets, which boxes are in view."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE, INNER
from roomba.world.camera.scene.arrays import Ray, ViewTables, WallGrid

NEAR = 0.004
"""m; what is nearer than this to the lens is not seen."""


@compiled(**INLINE)
def column_ray(view: ViewTables, axis: Ray, column: float) -> Ray:
    """Return the ray of a column; ``axis`` is the optical axis.

    A whole number is a column's left edge.
    """
    k = (view.middle - column) / view.focal
    return Ray(axis.x, axis.y, axis.dx - k * axis.dy, axis.dy + k * axis.dx)


@compiled(**INLINE)
def cast_wall(walls: WallGrid, ray: Ray) -> tuple[float, int, int, int]:
    """Return depth, m, axis crossed (0: x, 1: y), and the free cell (row, column) before a wall.

    Free space is crossed in jumps that cannot pass a wall; the last cells are walked exactly.
    A camera inside a wall sees it at ``NEAR``. The cells are those of the map with its border.
    """
    skip, dx, dy = walls.skip, ray.dx, ray.dy
    rows, columns = skip.shape
    # In cells of the bordered grid.
    px = (ray.x - walls.origin_x) / walls.resolution + 1.0
    py = (ray.y - walls.origin_y) / walls.resolution + 1.0
    column = math.floor(px)
    row = math.floor(py)
    if row < 0 or column < 0 or row >= rows or column >= columns or skip[row, column] == 0:
        return NEAR, 0, min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)
    longer = max(abs(dx), abs(dy))
    step_x = 1 if dx > 0.0 else -1
    step_y = 1 if dy > 0.0 else -1
    gain_x = 1.0 / abs(dx) if dx != 0.0 else math.inf
    gain_y = 1.0 / abs(dy) if dy != 0.0 else math.inf
    t = 0.0
    while True:
        free = skip[row, column]
        if free > 2:
            # Not quite to the last cell: rounding must not carry a ray from an edge past it.
            t += (free - 1 - 1e-6) / longer
            column = math.floor(px + t * dx)
            row = math.floor(py + t * dy)
            continue
        to_x = math.inf
        to_y = math.inf
        if dx != 0.0:
            to_x = (column + (1 if step_x > 0 else 0) - px) / dx
        if dy != 0.0:
            to_y = (row + (1 if step_y > 0 else 0) - py) / dy
        while True:
            if to_x < to_y:
                t = to_x
                to_x += gain_x
                column += step_x
                if skip[row, column] == 0:
                    return t * walls.resolution, 0, row, column - step_x
            else:
                t = to_y
                to_y += gain_y
                row += step_y
                if skip[row, column] == 0:
                    return t * walls.resolution, 1, row - step_y, column
            if skip[row, column] > 4:
                break


@compiled(**INNER)
def cast_walls(walls: WallGrid, view: ViewTables, axis: Ray, hits: NDArray[np.float64]) -> float:
    """Find the wall in every column; returns the depth of the farthest, m.

    ``axis`` is the optical axis; ``hits`` [columns, 3] gets depth, axis crossed and room.
    """
    farthest = 0.0
    for c in range(view.columns):
        t, crossed, row, column = cast_wall(walls, column_ray(view, axis, c + 0.5))
        hits[c, 0] = max(t, NEAR)
        hits[c, 1] = crossed
        hits[c, 2] = walls.rooms[row, column]
        farthest = max(farthest, t)
    return farthest


@compiled(**INNER)
def find_boxes(
    shapes: NDArray[np.float32],
    view: ViewTables,
    axis: Ray,
    farthest: float,
    seen: NDArray[np.float64],
) -> int:
    """List the boxes in view, nearest first; returns how many.

    ``axis`` is the optical axis; ``seen`` [boxes, 4] gets distance, index, first and last column.
    """
    x, y, cosine, sine = axis
    count = 0
    for b in range(shapes.shape[0]):
        box = shapes[b]
        if not box[4] > 0.0:
            continue
        ahead = (box[0] - x) * cosine + (box[1] - y) * sine
        aside = (box[1] - y) * cosine - (box[0] - x) * sine
        width = box[5] if box[5] > 0.0 else box[4]
        size = math.hypot(box[4], width)
        if ahead < -size or ahead - size > farthest:
            continue
        first = float(view.columns)
        last = -1.0
        nearest = math.inf
        for corner in range(4):
            along = box[4] if corner & 1 else -box[4]
            across = width if corner & 2 else -width
            corner_x = box[0] + along * box[2] - across * box[3] - x
            corner_y = box[1] + along * box[3] + across * box[2] - y
            depth = corner_x * cosine + corner_y * sine
            left = corner_y * cosine - corner_x * sine
            nearest = min(nearest, depth)
            if depth < 0.01:
                # A corner beside or behind the lens: its side of the picture is all in reach.
                first = 0.0 if left > 0.0 or abs(aside) < size else first
                last = view.columns - 1.0 if left < 0.0 or abs(aside) < size else last
                continue
            column = view.middle - 0.5 - view.focal * left / depth
            first = min(first, column)
            last = max(last, column)
        first = max(math.floor(first), 0.0)
        last = min(math.ceil(last), view.columns - 1.0)
        if first > last:
            continue
        place = count
        while place > 0 and seen[place - 1, 0] > nearest:
            for part in range(4):
                seen[place, part] = seen[place - 1, part]
            place -= 1
        seen[place, 0] = nearest
        seen[place, 1] = b
        seen[place, 2] = first
        seen[place, 3] = last
        count += 1
    return count
