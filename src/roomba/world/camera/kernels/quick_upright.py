"""Compiled painting of what stands, of one sample per pixel: down a column, lanes of rows."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.colour import level_of
from roomba.world.camera.kernels.span import column_spans
from roomba.world.camera.lanes.compilation import INLINE, INNER
from roomba.world.camera.lanes.lane_memory import fetch, load, look_up, store
from roomba.world.camera.lanes.lanes import LANES, any_of, floored, steps, where
from roomba.world.camera.scene.arrays import (
    GREYS,
    PLANE,
    SHADES,
    TURNED_FACE,
    SceneArrays,
    Surfaces,
    ViewTables,
    Workspace,
)

LIGHT = SHADES - 1.0
GREY_BITS = 6
GREY_SHIFT = 2
"""From the greys of a texture to the fewer that a surface's colours are kept in."""
POINT = 16
"""Bits behind the point of numbers in fixed point."""


@compiled(**INLINE)
def paint_face(
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    surfaces: Surfaces,
    place: NDArray[np.int64],
    value: NDArray[np.float64],
) -> None:
    """Paint a span of an upright face where nothing nearer is painted."""
    first, last, surface = place[0], place[1], place[2]
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
    at = steps() * advance + np.int64(math.floor(value[2] * scale * (1 << POINT)))
    light = steps() * gain + np.int64(value[5] * LIGHT * (1 << POINT))
    base = surface * (SHADES * GREYS)
    near = np.float32(value[0])
    for row in range(first, last, LANES):
        before = load(depths, row)
        seen = (before > near) & (steps() < last - row)
        if any_of(seen):
            grey = look_up(surfaces.texels, (((at >> POINT) & mask) << across) + start)
            # In lanes past the last row the light may be out of bounds.
            shade = (light >> POINT) & (SHADES - 1)
            colour = look_up(surfaces.shaded, (shade << GREY_BITS) + (grey >> GREY_SHIFT) + base)
            store(colours, row, where(seen, colour, load(colours, row)))
            store(depths, row, where(seen, near, before))
        at = at + LANES * advance
        light = light + LANES * gain


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

    The rows of all lanes share one halving of the texture, and one light.
    """
    first, last, surface = place[0], place[1], place[2]
    texture = surfaces.texture[surface]
    all_bits = surfaces.bits[texture]
    gap = np.float32(value[0])
    base = surface * (SHADES * GREYS)
    for row in range(first, last, LANES):
        near = load(view.reach, row) * gap
        before = load(depths, row)
        seen = (near < before) & (steps() < last - row)
        if any_of(seen):
            scale = surfaces.scale[texture]
            middle = (row + min(row + LANES, last)) // 2
            level = level_of(gap * view.spread[middle] * scale, all_bits)
            bits = np.int64(all_bits - level)
            mask = (1 << bits) - 1
            start = np.int64(surfaces.offsets[texture, level])
            scale /= np.float32(1 << level)
            column = floored(near * (value[3] * scale) + value[1] * scale) & mask
            line = floored(near * (value[4] * scale) + value[2] * scale) & mask
            grey = look_up(surfaces.texels, (line << bits) + column + start)
            shade = np.int64((value[5] + value[6] * (row - first)) * LIGHT) << GREY_BITS
            colour = look_up(surfaces.shaded, (grey >> GREY_SHIFT) + (base + shade))
            store(colours, row, where(seen, colour, load(colours, row)))
            store(depths, row, where(seen, near, before))


@compiled(**INNER)
def paint_columns(
    scene: SceneArrays,
    view: ViewTables,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    begin: int,
    boxes: int,
    first_row: int,
    work: Workspace,
    picture_depths: NDArray[np.float32],
) -> int:
    """Paint what stands in a tile's columns; returns the row below which nothing stands.

    Into ``work``. The picture's rows of depths above ``first_row`` are brought near meanwhile: they
    are so far apart that the processor does not see by itself what comes next.
    """
    lowest = 0
    for i in range(LANES):
        k = (view.middle - begin - i - 0.5) / view.focal
        spans = column_spans(
            work.spans, scene, view, x, y, cosine - k * sine, sine + k * cosine, begin + i,
            work.hits[begin + i], work.seen, boxes,
        )  # fmt: skip
        for row in range(i * first_row // LANES, (i + 1) * first_row // LANES):
            fetch(picture_depths, row * view.columns + begin)
        colours, depths = work.colours[i], work.depths[i]
        for row in range(0, view.rows, LANES):
            store(depths, row, load(view.floor_depth, row))
        for s in range(spans):
            place, value = work.spans.places[s], work.spans.values[s]
            lowest = max(lowest, place[1])
            if place[3] == PLANE:
                paint_plane(colours, depths, scene.surfaces, view, place, value)
            else:
                paint_face(colours, depths, scene.surfaces, place, value)
    return int(lowest)
