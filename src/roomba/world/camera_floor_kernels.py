"""Compiled painting of the floor in one picture column: texture, light and dirt."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.world.camera_compilation import KERNEL
from roomba.world.camera_span_kernels import (
    Colours,
    Depths,
    blended,
    scaled,
    smooth_texel,
)
from roomba.world.scene_arrays import Floor, Lighting, Surfaces, ViewTables

CRUMB_TEXELS = 2000.0
"""Texels per metre of the crumbs' pattern."""
CRUMB_MASK = 1023
DIRT_LEVEL = 40.0
"""A level of dirt is this times the square root of g/m2: 4 at 0.01, 40 at 1, 253 at 40 g/m2."""
FILM = 14.0
"""g/m2; the fine dust of so much dirt hides half of what it can of the floor."""
DUST = 0x7A848A
"""Dust, and what many crumbs look like from afar, packed as 0x00BBGGRR."""
CRUMB_BLOCK = 3
"""Texels by the power of two that an entry of ``fewest`` stands for, each way."""


@njit(**KERNEL)
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


@njit(**KERNEL)
def dirt_level(dirt: NDArray[np.int32], row: float, column: float, per_unit: float) -> float:
    """Return the level of dirt, 0..254, at a place in cells (centres at .5).

    ``per_unit`` is the square of a level per microgram in a cell.
    """
    row -= 0.5
    column -= 0.5
    rows, columns = dirt.shape
    if row < 0.0 or column < 0.0 or row >= rows - 1.0 or column >= columns - 1.0:
        return 0.0
    low = int(row)
    left = int(column)
    part = column - left
    share = row - low
    one = dirt[low, left] * (1.0 - part) + dirt[low, left + 1] * part
    two = dirt[low + 1, left] * (1.0 - part) + dirt[low + 1, left + 1] * part
    amount = one + (two - one) * share
    if amount <= 0.0:
        return 0.0
    return min(math.sqrt(amount * per_unit), 254.0)


@njit(**KERNEL)
def veil(cover: NDArray[np.float32], level: float, crispness: float) -> float:
    """Return how much dust, and crumbs too far to be told apart, hide of the floor, 0..256."""
    grams = (level / DIRT_LEVEL) ** 2
    film = 0.8 * grams / (grams + FILM)
    hidden = cover[int(level)] * (1.0 - crispness)
    return float(256.0 * (film + hidden - film * hidden))


@njit(**KERNEL)
def feel_knots(
    lighting: Lighting,
    view: ViewTables,
    x: float,
    y: float,
    dx: float,
    dy: float,
    first_row: int,
    dirt: NDArray[np.int32],
    dirt_place: NDArray[np.float64],
    cover: NDArray[np.float32],
    knots: NDArray[np.float32],
) -> None:
    """Fill in the knots from ``first_row`` down.

    ``knots`` [knots, 3] gets light, 0..256, level of dirt, and how much dust hides, 0..256.
    """
    rows, reach, grid, crispness = view.knots, view.reach, lighting.floor, view.crispness
    per_unit = DIRT_LEVEL * DIRT_LEVEL / (1e6 * dirt_place[0] * dirt_place[0])
    per_cell = 1.0 / lighting.cell
    per_dirt_cell = 1.0 / dirt_place[0]
    count = rows.shape[0]
    for k in range(count):
        if k + 1 < count and rows[k + 1] <= first_row:
            continue
        row = min(rows[k], view.rows - 1)
        t = view.eye * reach[row]
        at_x = x + t * dx
        at_y = y + t * dy
        light = between_bytes(
            grid, (at_y - lighting.origin_y) * per_cell, (at_x - lighting.origin_x) * per_cell
        )
        level = dirt_level(
            dirt,
            (at_y - dirt_place[2]) * per_dirt_cell,
            (at_x - dirt_place[1]) * per_dirt_cell,
            per_unit,
        )
        knots[k, 0] = light * (256.0 / 255.0) * (1.0 - 0.18 * t / (t + 5.0))
        knots[k, 1] = level
        knots[k, 2] = veil(cover, level, crispness[row]) if level > 0.0 else 0.0


@njit(**KERNEL)
def floor_surface(surfaces: NDArray[np.uint8], row: float, column: float) -> int:
    """Return the surface of the floor at a place in cells; the nearest one outside the map."""
    line = min(max(int(row), 0), surfaces.shape[0] - 1)
    return int(surfaces[line, min(max(int(column), 0), surfaces.shape[1] - 1)])


@njit(**KERNEL)
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

    ``below`` is how many rows under the horizon their upper edge is, ``rise`` what depth times
    that is. Places in texels.
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


@njit(**KERNEL)
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
    # Most floor is free of crumbs: a look at a small table spares one at a large one.
    if fewest[line >> CRUMB_BLOCK, column >> CRUMB_BLOCK] > level:
        return colour
    crumb = int(crumbs[line, column])
    if (crumb & 255) > level:
        return colour
    return int(blended(colour, crumb_colours[crumb >> 8], share))


@njit(**KERNEL)
def paint_floor(
    colours: Colours,
    depths: Depths,
    first_row: int,
    floor: Floor,
    surfaces: Surfaces,
    view: ViewTables,
    x: float,
    y: float,
    dx: float,
    dy: float,
    knots: NDArray[np.float32],
) -> None:
    """Paint the floor from ``first_row`` down, where nothing nearer stands."""
    knot_rows, reach, octaves = view.knots, view.reach, view.octave
    row_taps, row_crispness = view.taps, view.crispness
    textures, palettes, texels = surfaces.texture, surfaces.palettes, surfaces.texels
    scales, all_bits, offsets = surfaces.scale, surfaces.bits, surfaces.offsets
    fewest, crumbs, crumb_colours = floor.fewest, floor.crumbs, floor.colours
    texture_octaves, looks = surfaces.octave, floor.surfaces
    eye = view.eye
    focal = view.focal
    smooth = view.smooth
    # Finely sampled pictures need each edge twice, but not each texel: rows are coloured in pairs.
    pair = 2 if smooth else 1
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
            end = until if surface == last_surface else min(row + pair, until)
            texture = textures[surface]
            octave = octaves[row] + texture_octaves[texture]
            halved = min(max(int(octave + 0.4), 0), all_bits[texture])
            bits = all_bits[texture] - halved
            start = offsets[texture, halved]
            scale = float(scales[texture]) / (1 << halved)
            mask = (1 << bits) - 1
            u, v, du, dv = x * scale, y * scale, dx * scale, dy * scale
            taps = row_taps[row]
            near = smooth and octave < 0.0
            until_row = row
            while until_row < end:
                at = until_row
                until_row = min(at + pair - (at & (pair - 1)), end)
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
