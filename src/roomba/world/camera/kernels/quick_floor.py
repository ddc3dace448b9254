"""Compiled painting of the floor, of one sample per pixel: row by row of a tile."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.colour import mixed
from roomba.world.camera.kernels.compilation import INLINE, INNER
from roomba.world.camera.kernels.dirt import CRUMB_BLOCK, CRUMB_MASK, CRUMB_TEXELS
from roomba.world.camera.kernels.film import put_pixel
from roomba.world.camera.kernels.quick_upright import GREY_BITS, GREY_SHIFT
from roomba.world.camera.scene.arrays import (
    GREYS,
    SHADES,
    TILE,
    FloorSurfaces,
    SceneArrays,
    Surfaces,
    ViewTables,
)

PER_COLUMN = np.float32(1.0 / TILE)
HALF, NEARLY_HALF = np.float32(0.5), np.float32(0.4)
TEXELS = np.float32(CRUMB_TEXELS)
CRUMB_BITS, BLOCK_BITS = 10, 7
"""Base 2 logarithms of the widths of the tables of crumbs and of the fewest of them."""
DUST_ROW = 16 * SHADES
LEAST_LEVEL = 4.0
"""No crumb is seen at less dirt than this; see :func:`roomba.world.home.crumbs.crumbs`."""


@compiled(**INLINE)
def place_in(at: np.float32, origin: np.float32, cell: np.float32, count: int) -> int:
    """Return the cell, 0..count - 1, that a place, m, lies in, or the nearest one."""
    return min(max(int(np.int32((at - origin) / cell)), 0), count - 1)


@compiled(**INLINE)
def surface_within(floor: FloorSurfaces, x: np.float32, y: np.float32) -> int:
    """Return the surface of the floor in a pixel; the nearest one outside the map."""
    cell = np.float32(floor.cell)
    row = place_in(y, np.float32(floor.origin_y), cell, floor.surfaces.shape[0])
    column = place_in(x, np.float32(floor.origin_x), cell, floor.surfaces.shape[1])
    return int(floor.surfaces[np.uint64(row), np.uint64(column)])


@compiled(**INLINE)
def end_surfaces(
    floor: FloorSurfaces,
    x: float,
    y: float,
    t: float,
    directions: tuple[float, float, float, float],
) -> tuple[int, int]:
    """Return the surfaces of the floor at a depth, in two directions."""
    left_x, left_y, right_x, right_y = directions
    return (
        surface_at(floor, x + t * left_x, y + t * left_y),
        surface_at(floor, x + t * right_x, y + t * right_y),
    )


@compiled(**INLINE)
def surface_at(floor: FloorSurfaces, x: float, y: float) -> int:
    """Return the surface of the floor at a place, m; the nearest one outside the map."""
    row = min(max(int((y - floor.origin_y) / floor.cell), 0), floor.surfaces.shape[0] - 1)
    column = min(max(int((x - floor.origin_x) / floor.cell), 0), floor.surfaces.shape[1] - 1)
    return int(floor.surfaces[np.uint64(row), np.uint64(column)])


@compiled(**INLINE)
def look_of(
    surfaces: Surfaces, surface: int, octave: np.float32
) -> tuple[np.float32, int, int, int]:
    """Return how a surface looks in pixels of a size whose base 2 logarithm is given.

    Of the halving of its texture that suits: texels per metre, the first texel, and the base 2
    logarithm of the width; and the first of the surface's colours.
    """
    texture = np.uint64(surfaces.texture[np.uint64(surface)])
    bits = int(surfaces.bits[texture])
    size = surfaces.octave[texture] + np.float32(octave + NEARLY_HALF)
    halved = min(max(int(np.int32(size)), 0), bits)
    scale = np.float32(surfaces.scale[texture] / np.float32(1 << halved))
    start = int(surfaces.offsets[int(texture), halved])
    return scale, start, bits - halved, surface * (SHADES * GREYS)


@compiled(**INLINE)
def with_crumb(
    floor: FloorSurfaces,
    colour: int,
    shade: int,
    x: np.float32,
    y: np.float32,
    level: int,
    share: int,
) -> int:
    """Return a colour with the crumb that lies at a place, m, where the dirt has this level."""
    line = np.int64(np.int32(np.floor(y * TEXELS))) & CRUMB_MASK
    column = np.int64(np.int32(np.floor(x * TEXELS))) & CRUMB_MASK
    block = ((line >> CRUMB_BLOCK) << BLOCK_BITS) + (column >> CRUMB_BLOCK)
    # Most floor is free of crumbs: a look at a small table spares one at a large one.
    if floor.fewest[np.uint64(block)] > level:
        return colour
    crumb = np.int64(floor.crumbs[np.uint64((line << CRUMB_BITS) + column)])
    if (crumb & 255) > level:
        return colour
    crumb_colour = np.int64(floor.shaded[np.uint64((crumb >> 8) * SHADES + shade)])
    return int(mixed(colour, crumb_colour, share))


@compiled(**INLINE)
def find_ways(
    view: ViewTables, cosine: float, sine: float, begin: int, ways: NDArray[np.float32]
) -> None:
    """Fill in the directions, x and y per metre of depth, in which a tile's columns look."""
    middle, focal = np.float32(view.middle - begin), np.float32(view.focal)
    ahead_x, ahead_y = np.float32(cosine), np.float32(sine)
    for i in range(TILE):
        aside = (middle - (np.float32(i) + HALF)) / focal
        ways[0, i] = ahead_x - aside * ahead_y
        ways[1, i] = ahead_y + aside * ahead_x


@compiled(**INNER)
def paint_floor(
    scene: SceneArrays,
    view: ViewTables,
    place_x: float,
    place_y: float,
    cosine: float,
    sine: float,
    begin: int,
    first_row: int,
    left: NDArray[np.float32],
    right: NDArray[np.float32],
    ways: NDArray[np.float32],
    picture: NDArray[np.uint8],
    depths: NDArray[np.float32],
) -> None:
    """Paint the floor of a tile from ``first_row`` down, where nothing stands before it.

    ``left`` and ``right`` are the knots at the tile's edges, ``ways`` is room to work in.
    """
    surfaces, floor = scene.surfaces, scene.floor
    x, y = np.float32(place_x), np.float32(place_y)
    find_ways(view, cosine, sine, begin, ways)
    first = (view.middle - begin - 0.5) / view.focal
    last = (view.middle - begin - TILE + 0.5) / view.focal
    ends = (
        cosine - first * sine, sine + first * cosine, cosine - last * sine, sine + last * cosine
    )  # fmt: skip
    above = (-1, -1)
    look = look_of(surfaces, 0, np.float32(0.0))
    for k in range(view.knots.shape[0] - 1):
        top, until = view.knots[k], view.knots[k + 1]
        if until <= first_row:
            continue
        if above[0] < 0:
            above = end_surfaces(floor, x, y, view.floor_depth[top], ends)
        below = end_surfaces(floor, x, y, view.floor_depth[min(until, view.rows - 1)], ends)
        is_even = above[0] == above[1] and above == below
        above = below
        if is_even:
            look = look_of(surfaces, above[0], view.octave[top])
        crumb_share = int(view.crispness[top] * 256.0)
        gain = np.float32(1.0 / (until - top))
        for row in range(max(top, first_row), until):
            t = view.floor_depth[row]
            line_depths, line_pixels = depths[row], picture[row]
            part = np.float32(row - top) * gain
            light = left[k, 0] + (left[k + 1, 0] - left[k, 0]) * part
            light_gain = (right[k, 0] + (right[k + 1, 0] - right[k, 0]) * part - light) * PER_COLUMN
            level = left[k, 1] + (left[k + 1, 1] - left[k, 1]) * part
            level_right = right[k, 1] + (right[k + 1, 1] - right[k, 1]) * part
            has_crumbs = crumb_share > 0 and max(level, level_right) >= LEAST_LEVEL
            level_gain = (level_right - level) * PER_COLUMN
            dust = left[k, 2] + (left[k + 1, 2] - left[k, 2]) * part
            dust_gain = (right[k, 2] + (right[k + 1, 2] - right[k, 2]) * part - dust) * PER_COLUMN
            veil = np.int64(floor.shaded[np.uint64(DUST_ROW + np.int64(light))])
            for i in range(TILE):
                place = np.uint64(begin + i)
                if line_depths[place] < t:
                    continue
                at_x, at_y = ways[0, np.uint64(i)] * t + x, ways[1, np.uint64(i)] * t + y
                scale, start, bits, base = look
                if not is_even:
                    surface = surface_within(floor, at_x, at_y)
                    scale, start, bits, base = look_of(surfaces, surface, view.octave[row])
                mask = (1 << bits) - 1
                across = np.float32(i) + HALF
                shade = np.int64(np.int32(across * light_gain + light))
                column = np.int64(np.int32(np.floor(at_x * scale))) & mask
                line = np.int64(np.int32(np.floor(at_y * scale))) & mask
                grey = np.int64(surfaces.texels[np.uint64((line << bits) + column + start)])
                at = (shade << GREY_BITS) + (grey >> GREY_SHIFT) + base
                colour = np.int64(surfaces.shaded[np.uint64(at)])
                if has_crumbs:
                    at_level = np.int64(np.int32(across * level_gain + level))
                    colour = with_crumb(floor, colour, shade, at_x, at_y, at_level, crumb_share)
                colour = mixed(colour, veil, np.int64(np.int32(across * dust_gain + dust)))
                put_pixel(line_pixels, place, colour)
