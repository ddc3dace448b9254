"""Compiled painting of what stands, of one sample per pixel: down a column."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.colour import level_of
from roomba.world.camera.kernels.compilation import INLINE, INNER
from roomba.world.camera.kernels.ray import column_ray
from roomba.world.camera.kernels.span import column_spans
from roomba.world.camera.scene.arrays import (
    GREY_BITS,
    GREY_SHIFT,
    GREYS,
    PLANE,
    SHADES,
    STRIP,
    TURNED_FACE,
    Ray,
    SceneArrays,
    Surfaces,
    ViewTables,
    Workspace,
)

LIGHT = SHADES - 1.0
POINT = 16
"""Fraction bits of fixed-point numbers."""
TOGETHER = 16
"""Rows of a level plane that share one halving of its texture, and one light."""


@compiled(**INLINE)
def paint_face(
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    surfaces: Surfaces,
    place: NDArray[np.int64],
    value: NDArray[np.float64],
) -> None:
    """Paint a span of an upright face where nothing nearer is painted."""
    texels, shaded = surfaces.texels, surfaces.shaded
    first, last, surface = place[0], place[1], place[2]
    near = np.float32(value[0])
    texture = surfaces.texture[surface]
    scale = float(surfaces.scale[texture])
    level = level_of(value[4] * scale, surfaces.bits[texture])
    bits = np.int64(surfaces.bits[texture] - level)
    start = np.int64(surfaces.offsets[texture, level])
    scale /= 1 << level
    mask = (1 << bits) - 1
    fixed = math.floor(value[1] * scale) & mask
    turned = place[3] == TURNED_FACE
    across = 0 if turned else bits
    start += fixed << (bits if turned else 0)
    # Fixed point wraps around the texture by itself.
    advance = np.int64(math.floor(value[3] * scale * (1 << POINT)))
    gain = np.int64(value[6] * LIGHT * (1 << POINT))
    at = np.int64(math.floor(value[2] * scale * (1 << POINT)))
    light = np.int64(value[5] * LIGHT * (1 << POINT))
    base = surface * (SHADES * GREYS)
    for at_row in range(first, last):
        row = np.uint64(at_row)
        if depths[row] > near:
            grey = np.int64(texels[np.uint64((((at >> POINT) & mask) << across) + start)])
            shade = (light >> POINT) << GREY_BITS
            colours[row] = shaded[np.uint64(shade + (grey >> GREY_SHIFT) + base)]
            depths[row] = near
        at += advance
        light += gain


@compiled(**INLINE)
def paint_plane(
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    surfaces: Surfaces,
    view: ViewTables,
    place: NDArray[np.int64],
    value: NDArray[np.float64],
) -> None:
    """Paint a span of a level plane where nothing nearer is painted.

    Some rows share one halving of the texture, and one light.
    """
    texels, shaded, reach = surfaces.texels, surfaces.shaded, view.reach
    first, last, surface = place[0], place[1], place[2]
    texture = surfaces.texture[surface]
    all_bits = surfaces.bits[texture]
    gap = np.float32(value[0])
    base = surface * (SHADES * GREYS)
    for low in range(first, last, TOGETHER):
        high = min(low + TOGETHER, last)
        scale = surfaces.scale[texture]
        level = level_of(gap * view.spread[(low + high) // 2] * scale, all_bits)
        bits = np.int64(all_bits - level)
        mask = (1 << bits) - 1
        start = np.int64(surfaces.offsets[texture, level])
        scale /= np.float32(1 << level)
        u, v = np.float32(value[1] * scale), np.float32(value[2] * scale)
        u_gain, v_gain = np.float32(value[3] * scale), np.float32(value[4] * scale)
        shade = np.int64((value[5] + value[6] * (low - first)) * LIGHT) << GREY_BITS
        for at_row in range(low, high):
            row = np.uint64(at_row)
            near = reach[row] * gap
            if near < depths[row]:
                column = np.int64(np.int32(np.floor(near * u_gain + u))) & mask
                line = np.int64(np.int32(np.floor(near * v_gain + v))) & mask
                grey = np.int64(texels[np.uint64((line << bits) + column + start)])
                colours[row] = shaded[np.uint64((grey >> GREY_SHIFT) + (base + shade))]
                depths[row] = near


@compiled(**INNER)
def paint_columns(
    scene: SceneArrays,
    view: ViewTables,
    axis: Ray,
    begin: int,
    boxes: int,
    work: Workspace,
) -> int:
    """Paint what stands in a strip's columns into ``work``; return the first row below it."""
    lowest = 0
    for i in range(STRIP):
        column = begin + i
        ray, hits = column_ray(view, axis, column + 0.5), work.hits[column]
        spans = column_spans(work.spans, scene, view, ray, column, hits, work.seen, boxes)
        colours, depths = work.colours[i], work.depths[i]
        for row in range(view.rows):
            depths[row] = view.floor_depth[row]
        for s in range(spans):
            place, value = work.spans.places[s], work.spans.values[s]
            lowest = max(lowest, place[1])
            if place[3] == PLANE:
                paint_plane(colours, depths, scene.surfaces, view, place, value)
            else:
                paint_face(colours, depths, scene.surfaces, place, value)
    return int(lowest)
