"""Compiled column caster of the camera: the runs of rows of a picture column, and what each shows.

The camera looks level, so every upright edge stays upright in the picture: one ray in the plane
per column finds the wall and the boxes, and heights become rows. Row 0 is the top; row r looks up
at the slope ``(half - r - 0.5) / focal``. A ray's parameter ``t`` is its depth along the optical
axis, so that ``position = camera + t * direction`` with a direction of depth 1.
Arrays: see :mod:`roomba.world.camera.scene.arrays`.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.box import add_box
from roomba.world.camera.kernels.compilation import INLINE
from roomba.world.camera.kernels.face import add_face, add_span, row_of
from roomba.world.camera.kernels.light import upright_shade
from roomba.world.camera.scene.arrays import FACE, PLANE, Ray, SceneArrays, Spans, ViewTables

SKIRTING_HEIGHT = 0.07
TILED_HEIGHT = 1.35
LEDGE = 0.006
"""m; the dark line above skirting boards and tiled walls."""
CEILING_LIGHT = 0.97
"""The ceiling's light, the same all over: that of the walls below would make stripes on it."""
NONE = np.int64(0)
SPANS_OF_BOX = 3
SPANS_OF_WALL = 9
"""Most spans of a box, and of a wall and the ceiling above it."""


@compiled(**INLINE)
def add_wall(
    spans: Spans,
    count: int,
    scene: SceneArrays,
    view: ViewTables,
    ray: Ray,
    t: float,
    axis: int,
    room: int,
) -> int:
    """Add a wall at the depth ``t`` from floor to ceiling, and the ceiling.

    ``axis`` is the one that the ray crosses there, 0 for x, 1 for y.
    """
    walls = scene.walls
    x, y, dx, dy = ray
    hit_x = x + t * dx
    hit_y = y + t * dy
    if axis == 0:
        normal_x, normal_y = (-1.0 if dx > 0.0 else 1.0), 0.0
        along, slope = hit_y, abs(dx)
    else:
        normal_x, normal_y = 0.0, (-1.0 if dy > 0.0 else 1.0)
        along, slope = hit_x, abs(dy)
    shade = upright_shade(scene, hit_x, hit_y, normal_x, normal_y, t)
    slant = math.sqrt(dx * dx + dy * dy) / max(slope, 1e-3)
    paint = np.int64(walls.surfaces[room, 0])
    tiles = np.int64(walls.surfaces[room, 1])
    # Bands from the floor up: the height that each reaches, its surface, its share of the light.
    low = 0.0
    for band in range(4):
        surface, share, high = paint, 1.0, walls.height
        if band == 0:
            surface, high = np.int64(walls.skirting), SKIRTING_HEIGHT
        elif band == 1:
            share, high = 0.72, SKIRTING_HEIGHT + LEDGE
        elif band == 2:
            if tiles < 0:
                continue
            surface, high = tiles, TILED_HEIGHT
        count = add_face(
            spans, count, view, t, low, high, surface, scene.surfaces.glows[surface],
            slant, along, FACE, shade * share,
        )  # fmt: skip
        low = high
    gap = walls.height - view.eye
    ceiling_row = row_of(gap / t, 0.5 * view.rows, view.focal, view.rows)
    values = (gap, x, y, dx, dy, CEILING_LIGHT, 0.0)
    return int(add_span(spans, count, NONE, ceiling_row, walls.ceiling, PLANE, values))


@compiled(**INLINE)
def column_spans(
    spans: Spans,
    scene: SceneArrays,
    view: ViewTables,
    ray: Ray,
    column: int,
    hits: NDArray[np.float64],
    seen: NDArray[np.float64],
    boxes: int,
) -> int:
    """Fill in all spans of a column but the floor's, nearest box first; returns how many.

    ``hits`` are the column's depth of the wall, axis and room, ``seen`` the boxes in view.
    """
    # Of one type from the start: numba would compile every kernel below for a literal 0 as well.
    count = NONE
    t = hits[0]
    for b in range(boxes):
        if seen[b, 0] >= t:
            break
        if seen[b, 2] <= column <= seen[b, 3]:
            count = add_box(spans, count, scene, view, int(seen[b, 1]), ray, t)
    return int(add_wall(spans, count, scene, view, ray, t, int(hits[1]), int(hits[2])))
