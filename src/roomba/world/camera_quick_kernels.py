"""Compiled pictures of one sample per pixel, made for speed.

A picture is painted in tiles of ``TILE`` columns that stay in the nearest cache: upright things
column by column, the floor row by row. Loops over a tile's columns have no branches and a fixed
length, so that they compile to a few wide instructions.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.world.camera_colour_kernels import blended, level_of
from roomba.world.camera_compilation import INLINE, INNER, KERNEL
from roomba.world.camera_dirt_kernels import CRUMB_BLOCK, CRUMB_MASK, CRUMB_TEXELS, feel_knots
from roomba.world.camera_ray_kernels import cast_walls, find_boxes
from roomba.world.camera_span_kernels import column_spans, row_of
from roomba.world.scene_arrays import (
    GREYS,
    PLANE,
    SHADES,
    TURNED_FACE,
    Floor,
    Lanes,
    SceneArrays,
    Surfaces,
    ViewTables,
    Workspace,
)

TILE = 16
"""Columns; the rows of so many pixels fill whole cache lines."""
PLANE_ROWS = 16
"""Rows of a level plane that share one halving of its texture, and one light."""
LIGHT = SHADES - 1.0
GREY_BITS = 6
GREY_SHIFT = 2
AHEAD_X, AHEAD_Y, STEP, SCALE = range(0, 4 * TILE, TILE)
"""Where the values for a tile's columns are in ``Lanes.real``.

Directions of depth 1 in the plane, places in the tile, and texels per metre.
"""
SIZE, START, BASE, TEXEL, PALETTE, SHADE, COLOUR, CRUMB, BLOCK, LEVEL, FOUND = range(
    0, 11 * TILE, TILE
)
"""And in ``Lanes.whole``."""
PER_LANE = np.float32(1.0 / TILE)
ONE, EIGHT, FULL = np.uint32(1), np.uint32(8), np.uint32(256)
RED_BLUE, GREEN = np.uint32(0xFF00FF), np.uint32(0x00FF00)
SHADE_SIZE = np.uint32(GREYS)
CRUMB_SCALE = np.float32(CRUMB_TEXELS)
CRUMB_REST = np.uint32(CRUMB_MASK)
CRUMB_SHIFT = np.uint32(CRUMB_BLOCK)
CRUMB_SIZE, BLOCK_SIZE = np.uint32(1024), np.uint32(128)
FIRST, AFTER_LAST = np.int64(0), np.int64(TILE)
"""Columns of a tile; not literals, for which numba would compile a kernel once more."""
LEVELS = 16
"""More than a texture has halvings."""
DUST_ROW = 16 * SHADES
LEAST_LEVEL = 4.0
"""No crumb is seen at less dirt than this; see :func:`roomba.world.crumbs.crumbs`."""


@njit(**INLINE)
def paint_face(
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    surfaces: Surfaces,
    place: NDArray[np.int64],
    value: NDArray[np.float64],
) -> None:
    """Paint a span of an upright face where nothing nearer is painted."""
    surface = place[2]
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
    # Fixed point with 16 bits behind the point: wraps around the texture by itself.
    at = np.int64(math.floor(value[2] * scale * 65536.0))
    advance = np.int64(math.floor(value[3] * scale * 65536.0))
    light = np.int64(value[5] * LIGHT * 65536.0)
    gain = np.int64(value[6] * LIGHT * 65536.0)
    base = surface * (SHADES * GREYS)
    near = np.float32(value[0])
    for row in range(place[0], place[1]):
        pixel = np.uint64(row)
        if near < depths[pixel]:
            depths[pixel] = near
            grey = np.int64(
                surfaces.texels[np.uint64(start + (((at >> 16) & mask) << across))] >> GREY_SHIFT
            )
            colours[pixel] = surfaces.shaded[np.uint64(base + ((light >> 16) << GREY_BITS) + grey)]
        at += advance
        light += gain


@njit(**INLINE)
def paint_plane(
    colours: NDArray[np.uint32],
    depths: NDArray[np.float32],
    surfaces: Surfaces,
    view: ViewTables,
    place: NDArray[np.int64],
    value: NDArray[np.float64],
) -> None:
    """Paint a span of a level plane where nothing nearer is painted."""
    surface = place[2]
    texture = surfaces.texture[surface]
    all_bits = surfaces.bits[texture]
    gap = np.float32(value[0])
    first, last = place[0], place[1]
    base = surface * (SHADES * GREYS)
    row = first
    while row < last:
        until = min(row + PLANE_ROWS, last)
        scale = surfaces.scale[texture]
        level = level_of(gap * view.spread[(row + until) // 2] * scale, all_bits)
        bits = np.int64(all_bits - level)
        start = np.int64(surfaces.offsets[texture, level])
        mask = (1 << bits) - 1
        scale /= np.float32(1 << level)
        u, v = np.float32(value[1]) * scale, np.float32(value[2]) * scale
        du, dv = np.float32(value[3]) * scale, np.float32(value[4]) * scale
        shade = np.int64((value[5] + value[6] * (row - first)) * LIGHT) << GREY_BITS
        for at in range(row, until):
            pixel = np.uint64(at)
            near = gap * view.reach[pixel]
            if near < depths[pixel]:
                depths[pixel] = near
                column = np.int64(np.int32(np.floor(u + near * du))) & mask
                line = np.int64(np.int32(np.floor(v + near * dv))) & mask
                grey = np.int64(
                    surfaces.texels[np.uint64(start + (line << bits) + column)] >> GREY_SHIFT
                )
                colours[pixel] = surfaces.shaded[np.uint64(base + shade + grey)]
        row = until


@njit(**INNER)
def paint_columns(
    scene: SceneArrays,
    view: ViewTables,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    begin: int,
    boxes: int,
    work: Workspace,
) -> int:
    """Paint what stands in a tile's columns; returns the row below which nothing stands."""
    lowest = 0
    for c in range(begin, begin + TILE):
        k = (view.middle - c - 0.5) / view.focal
        spans = column_spans(
            work.spans, scene, view, x, y, cosine - k * sine, sine + k * cosine, c,
            work.hits[c], work.seen, boxes,
        )  # fmt: skip
        colours, depths = work.colours[c - begin], work.depths[c - begin]
        for row in range(depths.shape[0]):
            depths[row] = view.floor_depth[row]
        for s in range(spans):
            place, value = work.spans.places[s], work.spans.values[s]
            lowest = max(lowest, place[1])
            if place[3] == PLANE:
                paint_plane(colours, depths, scene.surfaces, view, place, value)
            else:
                paint_face(colours, depths, scene.surfaces, place, value)
    return int(lowest)


@njit(**INLINE)
def surface_at(floor: Floor, x: float, y: float) -> int:
    """Return the surface of the floor at a place, m; the nearest one outside the map."""
    row = min(max(int((y - floor.origin_y) / floor.cell), 0), floor.surfaces.shape[0] - 1)
    column = min(max(int((x - floor.origin_x) / floor.cell), 0), floor.surfaces.shape[1] - 1)
    return int(floor.surfaces[np.uint64(row), np.uint64(column)])


@njit(**INLINE)
def end_surfaces(
    floor: Floor, view: ViewTables, row: int, x: float, y: float, real: NDArray[np.float32]
) -> tuple[int, int]:
    """Return the surfaces at both ends of a tile's row of floor."""
    t = view.floor_depth[min(row, view.rows - 1)]
    right = TILE - 1
    return (
        surface_at(floor, x + t * real[AHEAD_X], y + t * real[AHEAD_Y]),
        surface_at(floor, x + t * real[AHEAD_X + right], y + t * real[AHEAD_Y + right]),
    )


@njit(**INLINE)
def halvings(surfaces: Surfaces, surface: int, octave: float) -> int:
    """Return which halving of a texture suits pixels of a size whose base 2 logarithm is given."""
    texture = surfaces.texture[surface]
    wanted = int(octave + surfaces.octave[texture] + 0.4)
    return int(min(max(wanted, 0), surfaces.bits[texture]))


@njit(**INLINE)
def veiled(colour: np.uint32, veil: np.uint32, share: np.uint32) -> np.uint32:
    """Return a packed colour mixed with ``share`` / 256 of another; all in 32 bits, for speed."""
    left = np.uint32(FULL - share)
    red_blue = np.uint32(np.uint32(colour & RED_BLUE) * left)
    red_blue = np.uint32(red_blue + np.uint32(np.uint32(veil & RED_BLUE) * share))
    green = np.uint32(np.uint32(colour & GREEN) * left)
    green = np.uint32(green + np.uint32(np.uint32(veil & GREEN) * share))
    red_blue = np.uint32(np.uint32(red_blue >> EIGHT) & RED_BLUE)
    return np.uint32(red_blue | np.uint32(np.uint32(green >> EIGHT) & GREEN))


@njit(**INLINE)
def choose_surface(
    surfaces: Surfaces, surface: int, halved: int, first: int, last: int, lanes: Lanes
) -> None:
    """Write down that pixels first..last-1 of a tile's row of floor are made of a surface."""
    real, whole = lanes.real, lanes.whole
    texture = surfaces.texture[surface]
    bits = surfaces.bits[texture]
    scale = np.float32(surfaces.scale[texture] / (1 << halved))
    size = np.uint32(1 << (bits - halved))
    start = np.uint32(surfaces.offsets[texture, halved])
    base = np.uint32(surface * (SHADES * GREYS))
    for i in range(first, last):
        lane = np.uint64(i)
        real[np.uint64(SCALE) + lane] = scale
        whole[np.uint64(SIZE) + lane] = size
        whole[np.uint64(START) + lane] = start
        whole[np.uint64(BASE) + lane] = base


@njit(**INLINE)
def strew_crumbs(
    scene: SceneArrays,
    x: np.float32,
    y: np.float32,
    t: np.float32,
    level: np.float32,
    level_gain: np.float32,
    share: int,
    lanes: Lanes,
) -> None:
    """Lay the crumbs of a tile's row of floor onto its colours."""
    floor = scene.floor
    real, whole = lanes.real, lanes.whole
    for i in range(TILE):
        line = np.uint32(np.int32(np.floor((y + t * real[AHEAD_Y + i]) * CRUMB_SCALE)))
        column = np.uint32(np.int32(np.floor((x + t * real[AHEAD_X + i]) * CRUMB_SCALE)))
        line = np.uint32(line & CRUMB_REST)
        column = np.uint32(column & CRUMB_REST)
        whole[CRUMB + i] = line * CRUMB_SIZE + column
        whole[BLOCK + i] = (line >> CRUMB_SHIFT) * BLOCK_SIZE + (column >> CRUMB_SHIFT)
        whole[LEVEL + i] = np.int32(level + level_gain * real[STEP + i])
    count = np.uint64(FOUND)
    # Most floor is free of crumbs: a look at a small table spares one at a large one.
    for i in range(TILE):
        whole[count] = i
        count += np.uint64(floor.fewest[whole[BLOCK + i]] <= whole[LEVEL + i])
    for n in range(FOUND, count):
        i = int(whole[n])
        crumb = np.int64(floor.crumbs[whole[CRUMB + i]])
        if (crumb & 255) <= whole[LEVEL + i]:
            tone = (crumb >> 8) * SHADES + np.int64(whole[SHADE + i])
            whole[COLOUR + i] = blended(
                np.int64(whole[COLOUR + i]), np.int64(floor.shaded[np.uint64(tone)]), share
            )


@njit(**INNER)
def paint_floor(
    scene: SceneArrays,
    view: ViewTables,
    place_x: float,
    place_y: float,
    begin: int,
    first_row: int,
    lowest: int,
    work: Workspace,
    depths: NDArray[np.float32],
) -> None:
    """Paint the floor of a tile where nothing stands before it; all of it below ``lowest``."""
    lanes, texels, shaded = work.lanes, scene.surfaces.texels, scene.surfaces.shaded
    real, whole = lanes.real, lanes.whole
    left, right = work.knots[(begin // TILE) & 1], work.knots[(begin // TILE + 1) & 1]
    x, y = np.float32(place_x), np.float32(place_y)
    chosen = -1
    above = (-1, -1)
    for k in range(view.knots.shape[0] - 1):
        top, until = view.knots[k], view.knots[k + 1]
        if until <= first_row:
            continue
        if above[0] < 0:
            above = end_surfaces(scene.floor, view, top, x, y, real)
        below = end_surfaces(scene.floor, view, until, x, y, real)
        is_even = above[0] == above[1] and above == below
        above = below
        if is_even:
            surface = above[0]
            halved = halvings(scene.surfaces, surface, view.octave[top])
            if chosen != surface * LEVELS + halved:
                chosen = surface * LEVELS + halved
                choose_surface(scene.surfaces, surface, halved, FIRST, AFTER_LAST, lanes)
        crumb_share = int(view.crispness[top] * 256.0)
        gain = np.float32(1.0 / (until - top))
        for row in range(max(top, first_row), until):
            t = view.floor_depth[row]
            colours = work.tile[row]
            nearest = depths[row, begin : begin + TILE]
            if row < lowest:
                seen = False
                for i in range(TILE):
                    seen |= nearest[i] >= t
                if not seen:
                    continue
            if not is_even:
                chosen = -1
                for i in range(TILE):
                    surface = surface_at(
                        scene.floor, x + t * real[AHEAD_X + i], y + t * real[AHEAD_Y + i]
                    )
                    halved = halvings(scene.surfaces, surface, view.octave[row])
                    choose_surface(scene.surfaces, surface, halved, i, i + 1, lanes)
            part = np.float32(row - top) * gain
            light = left[k, 0] + (left[k + 1, 0] - left[k, 0]) * part
            light_gain = (right[k, 0] + (right[k + 1, 0] - right[k, 0]) * part - light) * PER_LANE
            for i in range(TILE):
                scale = real[SCALE + i]
                size = whole[SIZE + i]
                mask = np.uint32(size - ONE)
                column = np.uint32(np.int32(np.floor((x + t * real[AHEAD_X + i]) * scale)))
                line = np.uint32(np.int32(np.floor((y + t * real[AHEAD_Y + i]) * scale)))
                whole[TEXEL + i] = whole[START + i] + (line & mask) * size + (column & mask)
                shade = np.uint32(np.int32(light + light_gain * real[STEP + i]))
                whole[SHADE + i] = shade
                whole[PALETTE + i] = whole[BASE + i] + shade * SHADE_SIZE
            for i in range(TILE):
                grey = np.uint64(texels[whole[TEXEL + i]]) >> np.uint64(GREY_SHIFT)
                whole[COLOUR + i] = shaded[whole[PALETTE + i] + grey]
            level = left[k, 1] + (left[k + 1, 1] - left[k, 1]) * part
            level_right = right[k, 1] + (right[k + 1, 1] - right[k, 1]) * part
            if crumb_share > 0 and max(level, level_right) >= LEAST_LEVEL:
                level_gain = (level_right - level) * PER_LANE
                strew_crumbs(scene, x, y, t, level, level_gain, crumb_share, lanes)
            dust = left[k, 2] + (left[k + 1, 2] - left[k, 2]) * part
            dust_gain = (right[k, 2] + (right[k + 1, 2] - right[k, 2]) * part - dust) * PER_LANE
            veil = scene.floor.shaded[np.uint64(DUST_ROW + np.int64(light))]
            for i in range(TILE):
                share = np.uint32(np.int32(dust + dust_gain * real[STEP + i]))
                colour = veiled(whole[COLOUR + i], veil, share)
                colours[i] = colour if nearest[i] >= t else colours[i]


@njit(**INNER)
def turn(
    work: Workspace,
    floor_depth: NDArray[np.float32],
    begin: int,
    lowest: int,
    depths: NDArray[np.float32],
) -> None:
    """Turn a tile's columns into rows; below ``lowest`` is only floor."""
    for row in range(lowest):
        line, depth = work.tile[row], depths[row, begin : begin + TILE]
        for i in range(TILE):
            line[i] = work.colours[i, row]
        for i in range(TILE):
            depth[i] = work.depths[i, row]
    for row in range(lowest, depths.shape[0]):
        depth = depths[row, begin : begin + TILE]
        for i in range(depth.shape[0]):
            depth[i] = floor_depth[row]


@njit(**INNER)
def pack(work: Workspace, begin: int, words: NDArray[np.uint32]) -> None:
    """Copy a finished tile into the picture, as bytes red, green, blue.

    By little-endian words, because that is twice as fast as by bytes.
    """
    first = begin * 3 // 4
    for row in range(words.shape[0]):
        colours, packed = work.tile[row], words[row, first : first + TILE * 3 // 4]
        for group in range(TILE // 4):
            one = colours[4 * group]
            two = colours[4 * group + 1]
            three = colours[4 * group + 2]
            four = colours[4 * group + 3]
            packed[3 * group] = one | (two << np.uint32(24))
            packed[3 * group + 1] = (two >> EIGHT) | (three << np.uint32(16))
            packed[3 * group + 2] = (three >> np.uint32(16)) | (four << EIGHT)


@njit(**INLINE)
def first_floor_row(hits: NDArray[np.float64], view: ViewTables, begin: int, end: int) -> int:
    """Return the first row of floor that is in sight in columns begin..end-1, whatever stands."""
    farthest = 0.0
    for c in range(begin, min(end, view.columns)):
        farthest = max(farthest, hits[c, 0])
    return int(row_of(-view.eye / farthest, 0.5 * view.rows, view.focal, view.rows))


@njit(**KERNEL)
def render_quick(
    scene: SceneArrays,
    view: ViewTables,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    dirt: NDArray[np.int32],
    dirt_place: NDArray[np.float64],
    work: Workspace,
    words: NDArray[np.uint32],
    depths: NDArray[np.float32],
) -> None:
    """Paint ``words`` [rows, columns * 3 / 4], bytes red, green, blue, and ``depths``.

    The camera is at (x, y) and looks along (cosine, sine). ``dirt_place`` is cell, origin x and
    origin y of ``dirt``.
    """
    farthest = cast_walls(scene.walls, view, x, y, cosine, sine, work.hits)
    boxes = find_boxes(scene.boxes.shapes, view, x, y, cosine, sine, farthest, work.seen)
    for begin in range(-TILE, view.columns, TILE):
        end = begin + TILE
        # Its right edge is the next tile's left one.
        k = (view.middle - end) / view.focal
        feel_knots(
            scene.lighting, view, x, y, cosine - k * sine, sine + k * cosine,
            first_floor_row(work.hits, view, max(begin, 0), end + TILE),
            dirt, dirt_place, scene.floor.cover, LIGHT, work.knots[(end // TILE) & 1],
        )  # fmt: skip
        if begin < 0:
            continue
        lowest = paint_columns(scene, view, x, y, cosine, sine, begin, boxes, work)
        turn(work, view.floor_depth, begin, lowest, depths)
        for i in range(TILE):
            k = (view.middle - begin - i - 0.5) / view.focal
            work.lanes.real[AHEAD_X + i] = cosine - k * sine
            work.lanes.real[AHEAD_Y + i] = sine + k * cosine
            work.lanes.real[STEP + i] = i + 0.5
        first_row = first_floor_row(work.hits, view, begin, end)
        paint_floor(scene, view, x, y, begin, first_row, lowest, work, depths)
        pack(work, begin, words)
