"""Compiled boxes in a picture column: which rows show one; see the kernels of spans."""

from __future__ import annotations

import math

import numpy as np

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE
from roomba.world.camera.kernels.face import add_face, add_span, row_of
from roomba.world.camera.kernels.light import upright_shade
from roomba.world.camera.kernels.ray import NEAR
from roomba.world.camera.scene.arrays import (
    FACE,
    PLANE,
    TURNED_FACE,
    Ray,
    SceneArrays,
    Spans,
    ViewTables,
)

UNDERSIDE_SHADE = 0.46


@compiled(**INLINE)
def add_box(
    spans: Spans,
    count: int,
    scene: SceneArrays,
    view: ViewTables,
    index: int,
    ray: Ray,
    limit: float,
) -> int:
    """Add what is seen of one box where a ray meets it before the depth ``limit``."""
    x, y, dx, dy = ray
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
