"""Compiled steps of a row of a strip's floor, of one sample per pixel.

Each step goes over all columns before the next one begins: arithmetic is then vectorized, and table
look-ups do not wait for one another. No step reads and writes more than a few arrays, and no array
is a view of another: else the compiler does not see that it may work on several columns at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.colour import mixed
from roomba.world.camera.kernels.compilation import INLINE, INNER
from roomba.world.camera.kernels.dirt import CRUMB_BLOCK, CRUMB_MASK, CRUMB_TEXELS
from roomba.world.camera.scene.arrays import (
    GREY_BITS,
    GREY_SHIFT,
    SHADES,
    STRIP,
    TILE,
    FloorSurfaces,
    Ray,
    StripRow,
    ViewTables,
)

PER_COLUMN = np.float32(1.0 / TILE)
HALF = np.float32(0.5)
TEXELS = np.float32(CRUMB_TEXELS)
CRUMB_BITS = CRUMB_MASK.bit_length()
BLOCK_BITS = CRUMB_BITS - CRUMB_BLOCK
"""Base 2 logarithms of the widths of the tables ``crumbs`` and ``fewest``."""
DUST_ROW = 16 * SHADES
"""Where the colours of dust begin among those of crumbs."""
OF_LIGHT, OF_DIRT, OF_DUST = 0, 1, 2
"""Columns of the knots."""


@compiled(**INLINE)
def find_ways(view: ViewTables, axis: Ray, begin: int, row: StripRow) -> None:
    """Fill in the directions, x and y per metre of depth, in which a strip's columns look."""
    focal = np.float32(view.focal)
    ahead_x, ahead_y = np.float32(axis.dx), np.float32(axis.dy)
    way_x, way_y = row.way_x, row.way_y
    for tile in range(0, STRIP, TILE):
        middle = np.float32(view.middle - (begin + tile))
        for i in range(TILE):
            aside = (middle - (np.float32(i) + HALF)) / focal
            way_x[tile + i] = ahead_x - aside * ahead_y
            way_y[tile + i] = ahead_y + aside * ahead_x


@compiled(**INLINE)
def between(knots: NDArray[np.float32], k: int, what: int, part: np.float32) -> np.float32:
    """Return light, dirt or dust at an edge of a tile, at a part of the way to the next knot."""
    return np.float32(knots[k, what] + (knots[k + 1, what] - knots[k, what]) * part)


@compiled(**INLINE)
def spread(
    left: NDArray[np.float32],
    right: NDArray[np.float32],
    k: int,
    what: int,
    part: np.float32,
    tile: int,
    values: NDArray[np.int32],
) -> None:
    """Fill in light, dirt or dust of a tile of a row, from those at its edges."""
    of_tile = values[tile : tile + TILE]
    low = between(left, k, what, part)
    gain = (between(right, k, what, part) - low) * PER_COLUMN
    # Not to TILE: the compiler unrolls a loop of so few known steps, and makes no vectors.
    for i in range(of_tile.shape[0]):
        of_tile[i] = np.int32((np.float32(i) + HALF) * gain + low)


@compiled(**INLINE)
def feel_light_and_dust(
    knots: NDArray[np.float32],
    k: int,
    part: np.float32,
    shaded: NDArray[np.uint32],
    row: StripRow,
) -> np.float32:
    """Fill in light, and dust with its colour; returns the highest level of dirt at an edge.

    ``knots`` [edges, knots, 3] begins with the strip's first edge.
    """
    most_dirt, veil = np.float32(0.0), row.veil
    for tile in range(0, STRIP, TILE):
        left, right = knots[tile // TILE], knots[tile // TILE + 1]
        spread(left, right, k, OF_LIGHT, part, tile, row.shade)
        spread(left, right, k, OF_DUST, part, tile, row.dust)
        grey = shaded[np.uint64(DUST_ROW + np.int64(between(left, k, OF_LIGHT, part)))]
        for i in range(tile, tile + TILE):
            veil[i] = grey
        most_dirt = max(
            most_dirt, between(left, k, OF_DIRT, part), between(right, k, OF_DIRT, part)
        )
    return most_dirt


@compiled(**INLINE)
def feel_dirt(
    knots: NDArray[np.float32], k: int, part: np.float32, level: NDArray[np.int32]
) -> None:
    """Fill in the levels of dirt; arguments as of :func:`feel_light_and_dust`."""
    for tile in range(0, STRIP, TILE):
        spread(knots[tile // TILE], knots[tile // TILE + 1], k, OF_DIRT, part, tile, level)


@compiled(**INLINE)
def find_texels(x: np.float32, y: np.float32, t: np.float32, row: StripRow) -> None:
    """Fill in which texel each column of a row of floor shows."""
    way_x, way_y, scale, start, width = row.way_x, row.way_y, row.scale, row.start, row.width
    place = row.place
    for i in range(STRIP):
        mask = width[i] - np.int32(1)
        column = np.int32(np.floor((way_x[i] * t + x) * scale[i])) & mask
        line = np.int32(np.floor((way_y[i] * t + y) * scale[i])) & mask
        place[i] = np.int32(line * width[i] + column + start[i])


@compiled(**INLINE)
def look_up_colours(texels: NDArray[np.uint8], shaded: NDArray[np.uint32], row: StripRow) -> None:
    """Fill in the colours of the texels in their light."""
    place, shade, base, colour = row.place, row.shade, row.base, row.colour
    for i in range(STRIP):
        grey = np.int32(texels[np.uint32(place[i])])
        at = (shade[i] << GREY_BITS) + (grey >> GREY_SHIFT) + base[i]
        colour[i] = shaded[np.uint32(at)]


@compiled(**INNER)
def add_crumbs(
    floor: FloorSurfaces, x: np.float32, y: np.float32, t: np.float32, share: int, row: StripRow
) -> None:
    """Mix ``share`` / 256 of the crumbs that lie in a row into its colours."""
    way_x, way_y, place, block = row.way_x, row.way_y, row.place, row.block
    for i in range(STRIP):
        line = np.int32(np.floor((way_y[i] * t + y) * TEXELS)) & CRUMB_MASK
        column = np.int32(np.floor((way_x[i] * t + x) * TEXELS)) & CRUMB_MASK
        place[i] = (line << CRUMB_BITS) + column
        block[i] = ((line >> CRUMB_BLOCK) << BLOCK_BITS) + (column >> CRUMB_BLOCK)
    for i in range(STRIP):
        # Most floor is free of crumbs: looking into the small table spares the large one.
        if floor.fewest[np.uint32(block[i])] <= row.level[i]:
            crumb = np.int64(floor.crumbs[np.uint32(place[i])])
            if (crumb & 255) <= row.level[i]:
                other = floor.shaded[np.uint64((crumb >> 8) * SHADES + row.shade[i])]
                row.colour[i] = mixed(row.colour[i], other, np.int32(share))


@compiled(**INLINE)
def cover_with_dust(row: StripRow) -> None:
    """Mix the dust into the colours."""
    colour, veil, dust = row.colour, row.veil, row.dust
    for i in range(STRIP):
        colour[i] = mixed(colour[i], veil[i], dust[i])


@compiled(**INLINE)
def put_before(
    upright: NDArray[np.uint32],
    depths: NDArray[np.float32],
    t: np.float32,
    colour: NDArray[np.uint32],
) -> None:
    """Replace the floor's colour where an upright thing is nearer."""
    for i in range(STRIP):
        colour[i] = colour[i] if depths[i] >= t else upright[i]
