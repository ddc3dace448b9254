"""Compiled painting of the floor, of four samples per pixel: down a column, in pairs of rows."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.colour import blended, scaled, smooth_texel
from roomba.world.camera.kernels.compilation import INLINE
from roomba.world.camera.kernels.dirt import (
    CRUMB_BLOCK,
    CRUMB_MASK,
    CRUMB_TEXELS,
    floor_surface,
)
from roomba.world.camera.scene.arrays import Ray, SceneArrays, ViewTables
from roomba.world.home.crumbs import DUST

PAIR = 2
"""Finely sampled pictures need each edge twice, but not each texel: rows are coloured in pairs."""


@compiled(**INLINE)
def far_grey(
    texels: NDArray[np.uint8],
    start: int,
    bits: int,
    taps: int,
    below: float,
    rows: int,
    rise: float,
    x: float,
    y: float,
    dx: float,
    dy: float,
) -> int:
    """Return a texture's grey averaged over ``taps`` places along the ray within some rows.

    ``below`` is how many rows below the horizon the upper edge of these rows lies, ``rise`` is
    depth times that number. Places are in texels.
    """
    mask = (1 << bits) - 1
    total = 0
    share = 1.0 / taps
    step = rows * share
    below += 0.5 * step
    for _ in range(taps):
        t = rise / below
        below += step
        column = math.floor(x + t * dx) & mask
        line = math.floor(y + t * dy) & mask
        total += texels[start + (line << bits) + column]
    return int(total * share)


@compiled(**INLINE)
def with_crumb(
    fewest: NDArray[np.uint8],
    crumbs: NDArray[np.uint16],
    crumb_colours: NDArray[np.uint32],
    colour: int,
    level: float,
    share: int,
    x: float,
    y: float,
) -> int:
    """Return a colour with the crumb that lies at a place, m, on it, if one does."""
    line = math.floor(y * CRUMB_TEXELS) & CRUMB_MASK
    column = math.floor(x * CRUMB_TEXELS) & CRUMB_MASK
    # Most floor is free of crumbs: looking into the small table spares the large one.
    if fewest[((line >> CRUMB_BLOCK) << 7) + (column >> CRUMB_BLOCK)] > level:
        return colour
    crumb = int(crumbs[(line << 10) + column])
    if (crumb & 255) > level:
        return colour
    return int(blended(colour, crumb_colours[crumb >> 8], share))


@compiled(**INLINE)
def paint_floor(
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    first_row: int,
    scene: SceneArrays,
    view: ViewTables,
    ray: Ray,
    knots: NDArray[np.float32],
) -> None:
    """Paint the floor below a ray from ``first_row`` down, where nothing nearer stands."""
    x, y, dx, dy = ray
    floor, surfaces = scene.floor, scene.surfaces
    knot_rows, reach, octaves = view.knots, view.reach, view.octave
    row_taps, row_crispness = view.taps, view.crispness
    textures, palettes, texels = surfaces.texture, surfaces.palettes, surfaces.texels
    scales, all_bits, offsets = surfaces.scale, surfaces.bits, surfaces.offsets
    fewest, crumbs, crumb_colours = floor.fewest, floor.crumbs, floor.colours
    texture_octaves, looks = surfaces.octave, floor.surfaces
    eye = view.eye
    focal = view.focal
    half = 0.5 * view.rows
    per_cell = 1.0 / floor.cell
    cell_x = (x - floor.origin_x) * per_cell
    cell_y = (y - floor.origin_y) * per_cell
    for k in range(knot_rows.shape[0] - 1):
        top = knot_rows[k]
        until = knot_rows[k + 1]
        if until <= first_row:
            continue
        row = max(top, first_row)
        share = 1.0 / (until - top)
        light, level, dust = float(knots[k, 0]), float(knots[k, 1]), float(knots[k, 2])
        light_step = (knots[k + 1, 0] - light) * share
        level_step = (knots[k + 1, 1] - level) * share
        dust_step = (knots[k + 1, 2] - dust) * share
        clean = level <= 0.0 and level_step <= 0.0
        crumb_share = int(row_crispness[top] * 256.0)
        step = eye * reach[until - 1] * per_cell
        last_surface = floor_surface(looks, cell_y + step * dy, cell_x + step * dx)
        while row < until:
            step = eye * reach[row] * per_cell
            surface = floor_surface(looks, cell_y + step * dy, cell_x + step * dx)
            end = until if surface == last_surface else min(row + PAIR, until)
            texture = textures[surface]
            octave = octaves[row] + texture_octaves[texture]
            halved = min(max(int(octave + 0.4), 0), all_bits[texture])
            bits = all_bits[texture] - halved
            start = offsets[texture, halved]
            scale = float(scales[texture]) / (1 << halved)
            mask = (1 << bits) - 1
            u, v, du, dv = x * scale, y * scale, dx * scale, dy * scale
            taps = row_taps[row]
            near = octave < 0.0
            until_row = row
            while until_row < end:
                at = until_row
                until_row = min(at + PAIR - (at & (PAIR - 1)), end)
                t = eye * reach[at]
                low = until_row - 1
                if t >= depths[at] and eye * reach[low] >= depths[low]:
                    continue
                if near:
                    grey = smooth_texel(texels, start, bits, u + t * du, v + t * dv)
                elif taps == 1:
                    column = math.floor(u + t * du) & mask
                    line = math.floor(v + t * dv) & mask
                    grey = int(texels[start + (line << bits) + column])
                else:
                    grey = far_grey(
                        texels, start, bits, taps, at - half, until_row - at, eye * focal,
                        u, v, du, dv,
                    )  # fmt: skip
                colour = int(palettes[surface, grey])
                part = at - top
                if not clean:
                    colour = blended(colour, DUST, int(dust + part * dust_step))
                    if crumb_share > 0:
                        colour = with_crumb(
                            fewest, crumbs, crumb_colours, colour, level + part * level_step,
                            crumb_share, x + t * dx, y + t * dy,
                        )  # fmt: skip
                colour = scaled(colour, int(light + part * light_step))
                for same in range(at, until_row):
                    t = eye * reach[same]
                    if t < depths[same]:
                        depths[same] = t
                        colours[same] = colour
            row = end
