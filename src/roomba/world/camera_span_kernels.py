"""Compiled column caster of the camera: which runs of rows of a picture column show what.

The camera looks level, so every upright edge stays upright in the picture: one ray in the plane
per column finds the wall and the boxes, and heights become rows. Row 0 is the top; row r looks up
at the slope ``(half - r - 0.5) / focal``. A ray's parameter ``t`` is its depth along the optical
axis, so that ``position = camera + t * direction`` with a direction of depth 1.
Arrays: see :mod:`roomba.world.scene_arrays`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.world.camera_compilation import INLINE
from roomba.world.camera_ray_kernels import NEAR
from roomba.world.scene_arrays import (
    FACE,
    PLANE,
    TURNED_FACE,
    SceneArrays,
    Spans,
    ViewTables,
)

CONTACT_HEIGHT = 0.22
"""m; below this, faces that stand on the floor grow darker towards it."""
CONTACT_SHADE = 0.70
"""How bright such a face is at the floor, against its upper part."""
SKIRTING_HEIGHT = 0.07
TILED_HEIGHT = 1.35
LEDGE = 0.006
"""m; the dark line above skirting boards and tiled walls."""
UNDERSIDE_SHADE = 0.46
CEILING_LIGHT = 0.97
"""The same all over: the light of the walls below would paint stripes on it."""
NONE = np.int64(0)
SPANS_OF_BOX = 3
SPANS_OF_WALL = 9
"""Most spans of a box, and of a wall and the ceiling above it."""


@njit(**INLINE)
def row_of(slope: float, half: float, focal: float, rows: int) -> int:
    """Return the first row that looks at or below a slope, 0..rows."""
    row = math.ceil(half - 0.5 - focal * slope)
    return int(min(max(row, 0.0), float(rows)))


@njit(**INLINE)
def between_bytes(grid: NDArray[np.uint8], row: float, column: float) -> float:
    """Return a grid's value at a place in cells (centres at .5), smooth, 0..255."""
    row = min(max(row - 0.5, 0.0), grid.shape[0] - 1.0)
    column = min(max(column - 0.5, 0.0), grid.shape[1] - 1.0)
    low = int(row)
    left = int(column)
    high = min(low + 1, grid.shape[0] - 1)
    right = min(left + 1, grid.shape[1] - 1)
    part = column - left
    one = grid[low, left] * (1.0 - part) + grid[low, right] * part
    two = grid[high, left] * (1.0 - part) + grid[high, right] * part
    share = row - low
    return float(one + (two - one) * share)


@njit(**INLINE)
def upright_shade(
    scene: SceneArrays, x: float, y: float, normal_x: float, normal_y: float, t: float
) -> float:
    """Return the light, 0..1, on an upright face at a place, m, with an outward normal."""
    lighting = scene.lighting
    light = between_bytes(
        lighting.air,
        (y + 0.1 * normal_y - lighting.origin_y) / lighting.cell,
        (x + 0.1 * normal_x - lighting.origin_x) / lighting.cell,
    )
    # As if most of the light came from one side: neighbouring faces must differ to be told apart.
    facing = 0.93 + 0.09 * (0.78 * normal_x + 0.62 * normal_y)
    return float(light / 255.0 * facing * (1.0 - 0.20 * t / (t + 5.0)))


@njit(**INLINE)
def add_span(
    spans: Spans,
    count: int,
    first: int,
    last: int,
    surface: int,
    kind: int,
    values: tuple[float, float, float, float, float, float, float],
) -> int:
    """Add a span unless it is empty; returns how many there are."""
    if first >= last:
        return count
    place = spans.places[count]
    place[0], place[1], place[2], place[3] = first, last, surface, kind
    value = spans.values[count]
    for index in range(7):
        value[index] = values[index]
    return count + 1


@njit(**INLINE)
def add_face(
    spans: Spans,
    count: int,
    view: ViewTables,
    t: float,
    bottom: float,
    top: float,
    surface: int,
    glows: bool,
    slant: float,
    u: float,
    kind: int,
    shade: float,
) -> int:
    """Add an upright face of depth ``t`` between two heights above the floor, m.

    ``slant`` is how much wider than high a sample is on the face, ``u`` the place along the face,
    m. The face darkens towards the floor.
    """
    half = 0.5 * view.rows
    step = -t / view.focal
    per_depth = 1.0 / t
    footprint = -step * min(math.sqrt(slant), 4.0)
    first = row_of((top - view.eye) * per_depth, half, view.focal, view.rows)
    last = row_of((bottom - view.eye) * per_depth, half, view.focal, view.rows)
    middle = last
    if bottom < CONTACT_HEIGHT and not glows:
        middle = row_of((CONTACT_HEIGHT - view.eye) * per_depth, half, view.focal, view.rows)
        middle = min(max(middle, first), last)
    height = view.eye - (half - first - 0.5) * step
    count = add_span(
        spans, count, first, middle, surface, kind, (t, u, height, step, footprint, shade, 0.0)
    )
    height = view.eye - (half - middle - 0.5) * step
    gain = shade * (1.0 - CONTACT_SHADE) / CONTACT_HEIGHT
    low = shade * CONTACT_SHADE + gain * max(min(height, CONTACT_HEIGHT), 0.0)
    values = (t, u, height, step, footprint, low, gain * step)
    return int(add_span(spans, count, middle, last, surface, kind, values))


@njit(**INLINE)
def add_box(
    spans: Spans,
    count: int,
    scene: SceneArrays,
    view: ViewTables,
    index: int,
    x: float,
    y: float,
    dx: float,
    dy: float,
    limit: float,
) -> int:
    """Add what is seen of one box where it is met before the depth ``limit``."""
    box = scene.boxes.shapes[index]
    length = np.float64(box[4])
    width = np.float64(box[5])
    away_x = x - box[0]
    away_y = y - box[1]
    u = away_x * box[2] + away_y * box[3]
    v = away_y * box[2] - away_x * box[3]
    du = dx * box[2] + dy * box[3]
    dv = dy * box[2] - dx * box[3]
    speed = math.sqrt(dx * dx + dy * dy)
    if width > 0.0:
        # A ray along a side enters and leaves it far away: on one side of the lens if it misses.
        gain_u = 1.0 / du if du != 0.0 else 1e300
        gain_v = 1.0 / dv if dv != 0.0 else 1e300
        enter_u = -u * gain_u - length * abs(gain_u)
        enter_v = -v * gain_v - width * abs(gain_v)
        across_length = enter_u > enter_v
        enter = max(enter_u, enter_v)
        leave = min(-u * gain_u + length * abs(gain_u), -v * gain_v + width * abs(gain_v))
    else:
        across_length = False
        middle = -(u * du + v * dv) / (speed * speed)
        miss = (u * dv - v * du) / speed
        if abs(miss) >= length:
            return count
        reach = math.sqrt(length * length - miss * miss) / speed
        enter = middle - reach
        leave = middle + reach
    if leave <= max(enter, NEAR) or enter >= limit:
        return count
    bottom = np.float64(box[6])
    top = np.float64(box[7])
    begin = max(enter, NEAR)
    until = min(leave, limit)
    # Above the picture's upper edge, as most of a shelf is from nearby.
    half = 0.5 * view.rows
    if bottom > view.eye and (bottom - view.eye) * view.focal > half * until:
        return count
    surface = np.int64(scene.boxes.surfaces[index])
    glows = scene.surfaces.glows[surface]
    # The face's outward normal looks back along the ray.
    if width <= 0.0:
        size = length
        normal_u = (u + enter * du) / length
        normal_v = (v + enter * dv) / length
        along = length * math.atan2(normal_v, normal_u)
        slope = -(normal_u * du + normal_v * dv)
        edge = 1.0
    elif across_length:
        normal_u = -1.0 if du > 0.0 else 1.0
        normal_v = 0.0
        along = v + enter * dv
        size = width
        slope = abs(du)
        edge = size - abs(along)
    else:
        normal_u = 0.0
        normal_v = -1.0 if dv > 0.0 else 1.0
        along = u + enter * du
        size = length
        slope = abs(dv)
        edge = size - abs(along)
    shade = 1.0
    if not glows:
        shade = upright_shade(
            scene,
            x + begin * dx,
            y + begin * dy,
            normal_u * box[2] - normal_v * box[3],
            normal_u * box[3] + normal_v * box[2],
            begin,
        )
    if enter > NEAR:
        face_shade = shade
        if edge < max(0.005, enter / view.focal) and size > 0.03:
            face_shade *= 1.0 - 0.22 * min(1.0, 0.005 * view.focal / enter)
        kind = TURNED_FACE if top - bottom > 2.0 * size else FACE
        count = add_face(
            spans, count, view, enter, bottom, top, surface, glows,
            speed / max(slope, 1e-3), along + 0.37 * index, kind, face_shade,
        )  # fmt: skip
    if top < view.eye:
        gap = view.eye - top
        first = row_of(-gap / until, half, view.focal, view.rows)
        last = row_of(-gap / begin, half, view.focal, view.rows)
        light = shade if glows else min(shade * 1.12, 1.0)
        count = add_span(spans, count, first, last, surface, PLANE, (gap, u, v, du, dv, light, 0.0))
    elif bottom > view.eye:
        gap = bottom - view.eye
        first = row_of(gap / begin, half, view.focal, view.rows)
        last = row_of(gap / until, half, view.focal, view.rows)
        light = shade if glows else UNDERSIDE_SHADE
        fade = -0.14 * light / max(last - first, 1)
        count = add_span(
            spans, count, first, last, surface, PLANE, (gap, u, v, du, dv, light, fade)
        )
    return int(count)


@njit(**INLINE)
def add_wall(
    spans: Spans,
    count: int,
    scene: SceneArrays,
    view: ViewTables,
    x: float,
    y: float,
    dx: float,
    dy: float,
    t: float,
    axis: int,
    room: int,
) -> int:
    """Add a wall from floor to ceiling, and the ceiling."""
    walls = scene.walls
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


@njit(**INLINE)
def column_spans(
    spans: Spans,
    scene: SceneArrays,
    view: ViewTables,
    x: float,
    y: float,
    dx: float,
    dy: float,
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
            count = add_box(spans, count, scene, view, int(seen[b, 1]), x, y, dx, dy, t)
    return int(add_wall(spans, count, scene, view, x, y, dx, dy, t, int(hits[1]), int(hits[2])))
