"""Compiled pictures of four samples per pixel, with textures smoothed near and far.

Columns of samples are painted one after the other, and two of them make a column of the picture.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.colour import level_of, scaled, smooth_texel
from roomba.world.camera.kernels.compilation import INLINE, KERNEL
from roomba.world.camera.kernels.dirt import feel_knots
from roomba.world.camera.kernels.face import row_of
from roomba.world.camera.kernels.film import shrink
from roomba.world.camera.kernels.ray import cast_walls, column_ray, find_boxes
from roomba.world.camera.kernels.smooth_floor import paint_floor
from roomba.world.camera.kernels.span import column_spans
from roomba.world.camera.scene.arrays import (
    PLANE,
    TURNED_FACE,
    FloorDirt,
    Ray,
    SceneArrays,
    Surfaces,
    ViewTables,
    Workspace,
)

GROUP = 4
"""Columns that share one sampling of the floor's light and dirt."""


@compiled(**INLINE)
def paint_face(
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    surfaces: Surfaces,
    place: NDArray[np.int64],
    value: NDArray[np.float64],
) -> None:
    """Paint a span of an upright face where nothing nearer is painted."""
    texels, palettes = surfaces.texels, surfaces.palettes
    first, last, surface, upright = place[0], place[1], place[2], place[3] == TURNED_FACE
    u, v, step, footprint = value[1], value[2], value[3], value[4]
    texture = surfaces.texture[surface]
    scale = float(surfaces.scale[texture])
    level = level_of(footprint * scale, surfaces.bits[texture])
    bits = surfaces.bits[texture] - level
    start = surfaces.offsets[texture, level]
    scale /= 1 << level
    light = value[5] * 256.0
    light_step = value[6] * 256.0
    near = np.float32(value[0])
    if footprint * scale < 0.75:
        colour = 0
        for row in range(first, last):
            if near < depths[row]:
                depths[row] = near
                # Samples are so much smaller than texels that two may share a colour.
                if not row & 1 or colour == 0:
                    at = (v + step * (row - first)) * scale
                    if upright:
                        grey = smooth_texel(texels, start, bits, at, u * scale)
                    else:
                        grey = smooth_texel(texels, start, bits, u * scale, at)
                    colour = scaled(
                        palettes[surface, grey], int(light + light_step * (row - first))
                    )
                colours[row] = colour
            else:
                colour = 0
        return
    mask = (1 << bits) - 1
    fixed = math.floor(u * scale) & mask
    across = bits
    if upright:
        start += fixed << bits
        across = 0
    else:
        start += fixed
    # Fixed point with 16 bits behind the point: wraps around the texture by itself.
    along = np.int64(math.floor(v * scale * 65536.0))
    advance = np.int64(math.floor(step * scale * 65536.0))
    for row in range(first, last):
        if near < depths[row]:
            depths[row] = near
            grey = texels[start + (((along >> 16) & mask) << across)]
            shade_now = int(light + light_step * (row - first))
            colours[row] = scaled(palettes[surface, grey], shade_now)
        along += advance


@compiled(**INLINE)
def paint_plane(
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    surfaces: Surfaces,
    view: ViewTables,
    place: NDArray[np.int64],
    value: NDArray[np.float64],
) -> None:
    """Paint a span of a level plane where nothing nearer is painted."""
    texels, palettes, offsets = surfaces.texels, surfaces.palettes, surfaces.offsets
    first, last, surface = place[0], place[1], place[2]
    gap, u, v, u_step, v_step = value[0], value[1], value[2], value[3], value[4]
    reach, focal = view.reach, view.focal
    texture = surfaces.texture[surface]
    all_scale = float(surfaces.scale[texture])
    all_bits = surfaces.bits[texture]
    light = value[5] * 256.0
    light_step = value[6] * 256.0
    row = first
    while row < last:
        until = min(row + 16, last)
        t = gap * reach[(row + until) // 2]
        along = t * t / (gap * focal)
        scale = all_scale
        level = level_of(math.sqrt(along * t / focal) * scale, all_bits)
        bits = all_bits - level
        start = offsets[texture, level]
        scale /= 1 << level
        mask = (1 << bits) - 1
        for at in range(row, until):
            t = gap * reach[at]
            if t < depths[at]:
                depths[at] = t
                column = math.floor((u + t * u_step) * scale) & mask
                line = math.floor((v + t * v_step) * scale) & mask
                grey = texels[start + (line << bits) + column]
                shade = int(light + light_step * (at - first))
                colours[at] = scaled(palettes[surface, grey], shade)
        row = until


@compiled(**KERNEL)
def render_smooth(
    scene: SceneArrays,
    view: ViewTables,
    axis: Ray,
    dirt: FloorDirt,
    work: Workspace,
    colours: NDArray[np.uint32],
) -> None:
    """Paint ``colours`` [columns / 2, rows / 2], not toned.

    ``axis`` is the optical axis.
    """
    half = 0.5 * view.rows
    farthest = cast_walls(scene.walls, view, axis, work.hits)
    boxes = find_boxes(scene.boxes.shapes, view, axis, farthest, work.seen)
    depth = work.depths[0]
    knots = work.knots[0]
    for c in range(view.columns):
        ray = column_ray(view, axis, c + 0.5)
        colour = work.colours[c & 1]
        depth[:] = np.float32(np.inf)
        spans = column_spans(work.spans, scene, view, ray, c, work.hits[c], work.seen, boxes)
        for s in range(spans):
            place, value = work.spans.places[s], work.spans.values[s]
            if place[3] == PLANE:
                paint_plane(colour, depth, scene.surfaces, view, place, value)
            else:
                paint_face(colour, depth, scene.surfaces, place, value)
        if c % GROUP == 0:
            first_row = view.rows
            for other in range(c, min(c + GROUP, view.columns)):
                slope = -view.eye / work.hits[other, 0]
                first_row = min(first_row, row_of(slope, half, view.focal, view.rows))
            feel_knots(
                scene.lighting, view, column_ray(view, axis, c + 0.5 * GROUP),
                first_row, dirt, scene.floor.cover, 256.0, knots,
            )  # fmt: skip
        floor_row = row_of(-view.eye / work.hits[c, 0], half, view.focal, view.rows)
        paint_floor(colour, depth, floor_row, scene, view, ray, knots)
        if c & 1:
            shrink(work.colours, colours[c >> 1])
