"""Compiled painting of the floor, of one sample per pixel: row by row, lanes of columns."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.dirt import CRUMB_BLOCK, CRUMB_MASK, CRUMB_TEXELS
from roomba.world.camera.kernels.quick_upright import GREY_BITS, GREY_SHIFT
from roomba.world.camera.lanes.compilation import INLINE, INNER
from roomba.world.camera.lanes.lane_memory import fetch, load, look_up, store_pixels
from roomba.world.camera.lanes.lanes import (
    LANES,
    all_whole,
    any_of,
    as_real,
    cut,
    floored,
    steps,
    where,
    within,
)
from roomba.world.camera.scene.arrays import (
    GREYS,
    SHADES,
    FloorSurfaces,
    SceneArrays,
    Surfaces,
    ViewTables,
    Workspace,
)

PER_LANE = np.float32(1.0 / LANES)
RED_BLUE, GREEN = 0xFF00FF, 0x00FF00
CRUMB_BITS, BLOCK_BITS = 10, 7
"""Base 2 logarithms of the widths of the tables of crumbs and of the fewest of them."""
DUST_ROW = 16 * SHADES
LEAST_LEVEL = 4.0
"""No crumb is seen at less dirt than this; see :func:`roomba.world.home.crumbs.crumbs`."""


@compiled(**INLINE)
def surfaces_at(floor: FloorSurfaces, x: Any, y: Any) -> Any:
    """Return the surfaces of the floor at places, m; the nearest ones outside the map."""
    rows, columns = floor.surfaces.shape
    row = within(cut((y - floor.origin_y) / floor.cell), 0, rows - 1)
    column = within(cut((x - floor.origin_x) / floor.cell), 0, columns - 1)
    return look_up(floor.surfaces, row * columns + column)


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
def look_of(surfaces: Surfaces, surface: Any, octave: float) -> tuple[Any, Any, Any, Any, Any]:
    """Return how surfaces look in pixels of a size whose base 2 logarithm is given.

    Of the halving of its texture that suits: texels per metre, the first texel, the base 2
    logarithm of the width, and the width less 1; and the first of the surface's colours.
    """
    texture = look_up(surfaces.texture, surface)
    bits = look_up(surfaces.bits, texture)
    halved = within(cut(look_up(surfaces.octave, texture) + (octave + 0.4)), 0, bits)
    scale = look_up(surfaces.scale, texture) / as_real(1 << halved)
    start = look_up(surfaces.offsets, texture * surfaces.offsets.shape[1] + halved)
    bits = bits - halved
    return scale, start, bits, (1 << bits) - 1, surface * (SHADES * GREYS)


@compiled(**INLINE)
def mixed(colour: Any, other: Any, share: Any) -> Any:
    """Return packed colours mixed with ``share`` / 256 of others."""
    left = 256 - share
    red_blue = (((colour & RED_BLUE) * left + (other & RED_BLUE) * share) >> 8) & RED_BLUE
    green = (((colour & GREEN) * left + (other & GREEN) * share) >> 8) & GREEN
    return red_blue | green


@compiled(**INLINE)
def with_crumbs(
    floor: FloorSurfaces, colour: Any, shade: Any, x: Any, y: Any, level: Any, share: int
) -> Any:
    """Return colours with the crumbs that lie at places, m, where the dirt has these levels."""
    line = floored(y * CRUMB_TEXELS) & CRUMB_MASK
    column = floored(x * CRUMB_TEXELS) & CRUMB_MASK
    block = ((line >> CRUMB_BLOCK) << BLOCK_BITS) + (column >> CRUMB_BLOCK)
    # Most floor is free of crumbs: a look at a small table spares one at a large one.
    near_one = look_up(floor.fewest, block) <= level
    if any_of(near_one):
        crumb = look_up(floor.crumbs, where(near_one, (line << CRUMB_BITS) + column, 0))
        is_crumb = near_one & ((crumb & 255) <= level)
        crumb_colour = look_up(floor.shaded, (crumb >> 8) * SHADES + shade)
        colour = where(is_crumb, mixed(colour, crumb_colour, share), colour)
    return colour


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
    lowest: int,
    work: Workspace,
    picture: NDArray[np.uint8],
    depths: NDArray[np.float32],
) -> None:
    """Finish the picture of a tile from ``first_row`` down: floor where nothing stands before it.

    From ``lowest`` down there is nothing else. The next tile's depths are brought near meanwhile.
    """
    surfaces, floor = scene.surfaces, scene.floor
    left, right = work.knots[(begin // LANES) & 1], work.knots[(begin // LANES + 1) & 1]
    x, y = np.float32(place_x), np.float32(place_y)
    across = as_real(steps()) + 0.5
    aside = (view.middle - begin - across) / view.focal
    ahead_x, ahead_y = cosine - aside * sine, sine + aside * cosine
    first = (view.middle - begin - 0.5) / view.focal
    last = (view.middle - begin - LANES + 0.5) / view.focal
    ends = (
        cosine - first * sine, sine + first * cosine, cosine - last * sine, sine + last * cosine
    )  # fmt: skip
    above = (-1, -1)
    look = look_of(surfaces, all_whole(0), 0.0)
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
            look = look_of(surfaces, all_whole(above[0]), view.octave[top])
        crumb_share = int(view.crispness[top] * 256.0)
        gain = np.float32(1.0 / (until - top))
        for row in range(max(top, first_row), until):
            t = view.floor_depth[row]
            place = row * view.columns + begin
            fetch(depths, place + LANES)
            seen = load(depths, place) >= t
            if not any_of(seen):
                store_pixels(picture, 3 * place, load(work.tile, row * LANES))
                continue
            at_x, at_y = ahead_x * t + x, ahead_y * t + y
            if not is_even:
                look = look_of(surfaces, surfaces_at(floor, at_x, at_y), view.octave[row])
            scale, start, bits, mask, base = look
            part = np.float32(row - top) * gain
            light = left[k, 0] + (left[k + 1, 0] - left[k, 0]) * part
            light_gain = (right[k, 0] + (right[k + 1, 0] - right[k, 0]) * part - light) * PER_LANE
            shade = cut(across * light_gain + light)
            column, line = floored(at_x * scale) & mask, floored(at_y * scale) & mask
            grey = look_up(surfaces.texels, (line << bits) + column + start)
            colour = look_up(surfaces.shaded, (shade << GREY_BITS) + (grey >> GREY_SHIFT) + base)
            level = left[k, 1] + (left[k + 1, 1] - left[k, 1]) * part
            level_right = right[k, 1] + (right[k + 1, 1] - right[k, 1]) * part
            if crumb_share > 0 and max(level, level_right) >= LEAST_LEVEL:
                levels = cut(across * ((level_right - level) * PER_LANE) + level)
                colour = with_crumbs(floor, colour, shade, at_x, at_y, levels, crumb_share)
            dust = left[k, 2] + (left[k + 1, 2] - left[k, 2]) * part
            dust_gain = (right[k, 2] + (right[k + 1, 2] - right[k, 2]) * part - dust) * PER_LANE
            veil = floor.shaded[np.uint64(DUST_ROW + np.int64(light))]
            colour = mixed(colour, all_whole(veil), cut(across * dust_gain + dust))
            if row < lowest:
                colour = where(seen, colour, load(work.tile, row * LANES))
            store_pixels(picture, 3 * place, colour)
