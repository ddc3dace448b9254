"""Compiled column caster of the camera: what each picture column meets, painted nearest first.

The camera looks level, so every upright edge stays upright in the picture: one ray in the plane
per column finds the wall and the boxes, and heights become rows. Units and conventions are those
of :mod:`roomba.world.camera_span_kernels`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.world.camera_compilation import KERNEL
from roomba.world.camera_film_kernels import shrink
from roomba.world.camera_floor_kernels import between_bytes, feel_knots, paint_floor
from roomba.world.camera_ray_kernels import NEAR, cast_wall, find_boxes
from roomba.world.camera_span_kernels import (
    Colours,
    Depths,
    paint_face,
    paint_plane,
    row_of,
)
from roomba.world.scene_arrays import Boxes, Lighting, SceneArrays, Surfaces, ViewTables, Walls

GROUP = 4
"""Columns that share one feeling of the floor's light and dirt."""
SKIRTING_HEIGHT = 0.07
TILED_HEIGHT = 1.35
LEDGE = 0.006
"""m; the dark line above skirting boards and tiled walls."""
UNDERSIDE_SHADE = 0.46
CEILING_LIGHT = 0.97
"""The same all over: the light of the walls below would paint stripes on it."""


@njit(**KERNEL)
def upright_shade(
    lighting: Lighting, x: float, y: float, normal_x: float, normal_y: float, t: float
) -> float:
    """Return the light, 0..1, on an upright face at a place, m, with an outward normal."""
    light = between_bytes(
        lighting.air,
        (y + 0.1 * normal_y - lighting.origin_y) / lighting.cell,
        (x + 0.1 * normal_x - lighting.origin_x) / lighting.cell,
    )
    # As if most of the light came from one side: neighbouring faces must differ to be told apart.
    facing = 0.93 + 0.09 * (0.78 * normal_x + 0.62 * normal_y)
    return float(light / 255.0 * facing * (1.0 - 0.20 * t / (t + 5.0)))


@njit(**KERNEL)
def paint_box(
    colours: Colours,
    depths: Depths,
    boxes: Boxes,
    surfaces: Surfaces,
    lighting: Lighting,
    view: ViewTables,
    index: int,
    x: float,
    y: float,
    dx: float,
    dy: float,
    limit: float,
) -> None:
    """Paint one box where it is met before the depth ``limit``."""
    box = boxes.shapes[index]
    away_x = x - box[0]
    away_y = y - box[1]
    u = away_x * box[2] + away_y * box[3]
    v = away_y * box[2] - away_x * box[3]
    du = dx * box[2] + dy * box[3]
    dv = dy * box[2] - dx * box[3]
    enter = -math.inf
    leave = math.inf
    across_length = True
    for axis in range(2):
        place, gain, size = (u, du, float(box[4])) if axis == 0 else (v, dv, float(box[5]))
        if gain == 0.0:
            if abs(place) > size:
                return
            continue
        one = (-size - place) / gain
        two = (size - place) / gain
        low = min(one, two)
        if low > enter:
            enter = low
            across_length = axis == 0
        leave = min(leave, max(one, two))
    if leave <= max(enter, NEAR) or enter >= limit:
        return
    half = 0.5 * view.rows
    surface = boxes.surfaces[index]
    bottom = float(box[6])
    top = float(box[7])
    begin = max(enter, NEAR)
    until = min(leave, limit)
    # Above the picture's upper edge, as most of a shelf is from nearby.
    if bottom > view.eye and (bottom - view.eye) * view.focal > half * until:
        return
    hit_x = x + begin * dx
    hit_y = y + begin * dy
    # The face's outward normal looks back along the ray.
    if across_length:
        turn = -1.0 if du > 0.0 else 1.0
        normal_x = turn * box[2]
        normal_y = turn * box[3]
        along = v + enter * dv
        size = float(box[5])
        slope = abs(du)
    else:
        turn = -1.0 if dv > 0.0 else 1.0
        normal_x = -turn * box[3]
        normal_y = turn * box[2]
        along = u + enter * du
        size = float(box[4])
        slope = abs(dv)
    shade = upright_shade(lighting, hit_x, hit_y, normal_x, normal_y, begin)
    if surfaces.glows[surface]:
        shade = 1.0
    if enter > NEAR:
        slant = math.hypot(du, dv) / max(slope, 1e-3)
        edge = size - abs(along)
        width = max(0.005, enter / view.focal)
        face_shade = shade
        if edge < width and size > 0.03:
            face_shade *= 1.0 - 0.22 * min(1.0, 0.005 * view.focal / enter)
        paint_face(
            colours, depths, enter, bottom, top, view.eye, half, view.focal, surfaces, surface,
            slant, along + 0.37 * index, top - bottom > 2.0 * size, face_shade, view.smooth,
        )  # fmt: skip
    if top < view.eye:
        gap = view.eye - top
        first = row_of(-gap / until, half, view.focal, view.rows)
        last = row_of(-gap / begin, half, view.focal, view.rows)
        light = shade if surfaces.glows[surface] else min(shade * 1.12, 1.0)
        paint_plane(
            colours, depths, first, last, view.reach, gap, view.focal, surfaces, surface,
            u, v, du, dv, light, light,
        )  # fmt: skip
    elif bottom > view.eye:
        gap = bottom - view.eye
        first = row_of(gap / begin, half, view.focal, view.rows)
        last = row_of(gap / until, half, view.focal, view.rows)
        light = shade if surfaces.glows[surface] else UNDERSIDE_SHADE
        paint_plane(
            colours, depths, first, last, view.reach, gap, view.focal, surfaces, surface,
            u, v, du, dv, light, light * 0.86,
        )  # fmt: skip


@njit(**KERNEL)
def paint_wall(
    colours: Colours,
    depths: Depths,
    walls: Walls,
    surfaces: Surfaces,
    lighting: Lighting,
    view: ViewTables,
    x: float,
    y: float,
    dx: float,
    dy: float,
    t: float,
    axis: int,
    room: int,
) -> int:
    """Paint a wall from floor to ceiling; returns the first row of the floor."""
    half = 0.5 * view.rows
    eye = view.eye
    focal = view.focal
    hit_x = x + t * dx
    hit_y = y + t * dy
    if axis == 0:
        normal_x, normal_y = (-1.0 if dx > 0.0 else 1.0), 0.0
        along, slope = hit_y, abs(dx)
    else:
        normal_x, normal_y = 0.0, (-1.0 if dy > 0.0 else 1.0)
        along, slope = hit_x, abs(dy)
    shade = upright_shade(lighting, hit_x, hit_y, normal_x, normal_y, t)
    slant = math.hypot(dx, dy) / max(slope, 1e-3)
    paint = walls.surfaces[room, 0]
    tiles = walls.surfaces[room, 1]
    # Bands from the floor up: the height that each reaches, its surface, its share of the light.
    low = 0.0
    for band in range(4):
        surface, share, high = paint, 1.0, walls.height
        if band == 0:
            surface, high = walls.skirting, SKIRTING_HEIGHT
        elif band == 1:
            share, high = 0.72, SKIRTING_HEIGHT + LEDGE
        elif band == 2:
            if tiles < 0:
                continue
            surface, high = tiles, TILED_HEIGHT
        paint_face(
            colours, depths, t, low, high, eye, half, focal, surfaces, surface,
            slant, along, False, shade * share, view.smooth,
        )  # fmt: skip
        low = high
    return int(row_of(-eye / t, half, focal, view.rows))


@njit(**KERNEL)
def render(
    scene: SceneArrays,
    view: ViewTables,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    dirt: NDArray[np.int32],
    dirt_place: NDArray[np.float64],
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    pair: NDArray[np.uint32],
    hits: NDArray[np.float64],
    seen: NDArray[np.float64],
    knots: NDArray[np.float32],
) -> None:
    """Paint a picture by columns: ``colours`` is [columns, rows], half of both if smooth.

    The camera is at (x, y) and looks along (cosine, sine). ``dirt_place`` is cell, origin x and
    origin y of ``dirt``. ``depths`` is [columns, rows], or fewer columns that are written again
    and again. ``pair`` [2, rows], ``hits`` [columns, 3], ``seen`` [boxes, 4] and ``knots``
    [knots, 3] are room to work in.
    """
    half_columns = 0.5 * view.columns
    half = 0.5 * view.rows
    farthest = 0.0
    for c in range(view.columns):
        k = (half_columns - c - 0.5) / view.focal
        t, axis, row, column = cast_wall(scene.walls, x, y, cosine - k * sine, sine + k * cosine)
        hits[c, 0] = max(t, NEAR)
        hits[c, 1] = axis
        hits[c, 2] = scene.walls.rooms[row, column]
        farthest = max(farthest, t)
    boxes = find_boxes(scene.boxes.shapes, view, x, y, cosine, sine, farthest, seen)
    for c in range(view.columns):
        k = (half_columns - c - 0.5) / view.focal
        dx = cosine - k * sine
        dy = sine + k * cosine
        t = hits[c, 0]
        colour = pair[c & 1] if view.smooth else colours[c]
        depth = depths[c % depths.shape[0]]
        depth[:] = np.float32(np.inf)
        for b in range(boxes):
            if seen[b, 0] >= t:
                break
            if seen[b, 2] <= c <= seen[b, 3]:
                paint_box(
                    colour, depth, scene.boxes, scene.surfaces, scene.lighting, view,
                    int(seen[b, 1]), x, y, dx, dy, t,
                )  # fmt: skip
        floor_row = paint_wall(
            colour, depth, scene.walls, scene.surfaces, scene.lighting, view,
            x, y, dx, dy, t, int(hits[c, 1]), int(hits[c, 2]),
        )  # fmt: skip
        gap = scene.walls.height - view.eye
        ceiling_row = row_of(gap / t, half, view.focal, view.rows)
        paint_plane(
            colour, depth, 0, ceiling_row, view.reach, gap, view.focal, scene.surfaces,
            scene.walls.ceiling,
            x, y, dx, dy, CEILING_LIGHT, CEILING_LIGHT,
        )  # fmt: skip
        if c % GROUP == 0:
            first_row = view.rows
            for other in range(c, min(c + GROUP, view.columns)):
                first_row = min(
                    first_row, row_of(-view.eye / hits[other, 0], half, view.focal, view.rows)
                )
            middle = k - (GROUP - 1) * 0.5 / view.focal
            feel_knots(
                scene.lighting, view, x, y, cosine - middle * sine, sine + middle * cosine,
                first_row,
                dirt, dirt_place, scene.floor.cover, knots,
            )  # fmt: skip
        paint_floor(
            colour, depth, floor_row, scene.floor, scene.surfaces, view,
            x, y, dx, dy, knots,
        )  # fmt: skip
        if view.smooth and c & 1:
            shrink(pair, colours[c >> 1])
