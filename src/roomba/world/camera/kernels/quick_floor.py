"""Compiled painting of the floor, of one sample per pixel: row by row of a strip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE, INNER
from roomba.world.camera.kernels.film import write_pixels
from roomba.world.camera.kernels.floor_row import (
    add_crumbs,
    cover_with_dust,
    feel_dirt,
    feel_light_and_dust,
    find_texels,
    find_ways,
    look_up_colours,
    put_before,
)
from roomba.world.camera.kernels.ray import column_ray
from roomba.world.camera.scene.arrays import (
    GREYS,
    SHADES,
    STRIP,
    TILE,
    FloorSurfaces,
    Ray,
    SceneArrays,
    StripRow,
    Surfaces,
    ViewTables,
    Workspace,
)

LEAST_LEVEL = 4.0
"""No crumb is seen at less dirt than this; see :func:`roomba.world.home.crumbs.crumbs`."""
NEARLY_HALF = np.float32(0.4)
"""Added to the ideal number of halvings before that is cut off: a rest of 0.6 is one more."""
SEVERAL = -1
"""In place of a surface's number where a tile has several surfaces."""


@compiled(**INLINE)
def place_in(
    at: np.float32 | float, origin: np.float32 | float, cell: np.float32 | float, count: int
) -> int:
    """Return the cell, 0..count - 1, that a place, m, lies in, or the nearest one."""
    return min(max(int(np.int32((at - origin) / cell)), 0), count - 1)


@compiled(**INLINE)
def surface_within(floor: FloorSurfaces, x: np.float32, y: np.float32) -> int:
    """Return the floor's surface at a place, m, in 32 bits; outside the map the nearest one."""
    cell = np.float32(floor.cell)
    row = place_in(y, np.float32(floor.origin_y), cell, floor.surfaces.shape[0])
    column = place_in(x, np.float32(floor.origin_x), cell, floor.surfaces.shape[1])
    return int(floor.surfaces[np.uint64(row), np.uint64(column)])


@compiled(**INLINE)
def surface_below(floor: FloorSurfaces, ray: Ray, t: float) -> int:
    """Return the floor's surface below a ray at a depth ``t``; outside the map the nearest."""
    x, y = ray.x + t * ray.dx, ray.y + t * ray.dy
    row = place_in(y, floor.origin_y, floor.cell, floor.surfaces.shape[0])
    column = place_in(x, floor.origin_x, floor.cell, floor.surfaces.shape[1])
    return int(floor.surfaces[np.uint64(row), np.uint64(column)])


@compiled(**INLINE)
def tile_surface(
    floor: FloorSurfaces,
    view: ViewTables,
    axis: Ray,
    begin: int,
    near: float,
    far: float,
) -> int:
    """Return the surface at the corners of a tile's floor between two depths, or ``SEVERAL``."""
    left = column_ray(view, axis, begin + 0.5)
    right = column_ray(view, axis, begin + TILE - 0.5)
    one = surface_below(floor, left, near)
    if (
        one == surface_below(floor, right, near)
        and one == surface_below(floor, left, far)
        and one == surface_below(floor, right, far)
    ):
        return int(one)
    return SEVERAL


@compiled(**INLINE)
def look_of(
    surfaces: Surfaces, surface: int, octave: np.float32
) -> tuple[np.float32, int, int, int]:
    """Return how a surface looks in pixels of a size whose base 2 logarithm is given.

    The look is four numbers: texels per metre, first texel and width of the halved texture that
    suits, and the first of the surface's colours.
    """
    texture = np.uint64(surfaces.texture[np.uint64(surface)])
    bits = int(surfaces.bits[texture])
    size = surfaces.octave[texture] + np.float32(octave + NEARLY_HALF)
    halved = min(max(int(np.int32(size)), 0), bits)
    scale = np.float32(surfaces.scale[texture] / np.float32(1 << halved))
    start = int(surfaces.offsets[int(texture), halved])
    return scale, start, 1 << (bits - halved), surface * (SHADES * GREYS)


@compiled(**INLINE)
def fill_looks(tile: int, look: tuple[np.float32, int, int, int], row: StripRow) -> None:
    """Note the same look for all columns of a tile."""
    scale, start, width, base = look
    for i in range(tile, tile + TILE):
        row.scale[i], row.start[i], row.width[i], row.base[i] = scale, start, width, base


@compiled(**INNER)
def find_looks(
    surfaces: Surfaces,
    floor: FloorSurfaces,
    x: np.float32,
    y: np.float32,
    t: np.float32,
    octave: np.float32,
    tile: int,
    row: StripRow,
) -> None:
    """Note how each column of a tile of several surfaces looks at the depth ``t``."""
    for i in range(tile, tile + TILE):
        surface = surface_within(floor, row.way_x[i] * t + x, row.way_y[i] * t + y)
        scale, start, width, base = look_of(surfaces, surface, octave)
        row.scale[i], row.start[i], row.width[i], row.base[i] = scale, start, width, base


@compiled(**INLINE)
def find_even_looks(
    scene: SceneArrays,
    view: ViewTables,
    axis: Ray,
    begin: int,
    top: int,
    until: int,
    work: Workspace,
) -> bool:
    """Note how tiles of one surface look in rows top..until-1; return whether all are such."""
    even = True
    near, far = view.floor_depth[top], view.floor_depth[min(until, view.rows - 1)]
    for tile in range(0, STRIP, TILE):
        surface = tile_surface(scene.floor, view, axis, begin + tile, near, far)
        work.surfaces[tile // TILE] = surface
        if surface == SEVERAL:
            even = False
        else:
            fill_looks(tile, look_of(scene.surfaces, surface, view.octave[top]), work.row)
    return even


@compiled(**INLINE)
def find_uneven_looks(
    scene: SceneArrays,
    x: np.float32,
    y: np.float32,
    t: np.float32,
    octave: np.float32,
    work: Workspace,
) -> None:
    """Note how each column of the other tiles looks, in a row at the depth ``t``."""
    for tile in range(0, STRIP, TILE):
        if work.surfaces[tile // TILE] == SEVERAL:
            find_looks(scene.surfaces, scene.floor, x, y, t, octave, tile, work.row)


@compiled(**INNER)
def paint_floor(
    scene: SceneArrays,
    view: ViewTables,
    axis: Ray,
    begin: int,
    first_row: int,
    lowest: int,
    work: Workspace,
    picture: NDArray[np.uint8],
    depths: NDArray[np.float32],
) -> None:
    """Finish the picture of a strip from ``first_row`` down: floor where nothing stands before it.

    From ``lowest`` down there is nothing but floor.
    """
    surfaces, floor, strip = scene.surfaces, scene.floor, work.row
    x, y = np.float32(axis.x), np.float32(axis.y)
    knots = work.knots[begin // TILE :]
    find_ways(view, axis, begin, strip)
    for k in range(view.knots.shape[0] - 1):
        top, until = view.knots[k], view.knots[k + 1]
        if until <= first_row:
            continue
        even = find_even_looks(scene, view, axis, begin, top, until, work)
        crumb_share = int(view.crispness[top] * 256.0)
        gain = np.float32(1.0 / (until - top))
        for row in range(max(top, first_row), until):
            t = view.floor_depth[row]
            part = np.float32(row - top) * gain
            if not even:
                find_uneven_looks(scene, x, y, t, view.octave[row], work)
            most_dirt = feel_light_and_dust(knots, k, part, floor.shaded, strip)
            find_texels(x, y, t, strip)
            look_up_colours(surfaces.texels, surfaces.shaded, strip)
            if crumb_share > 0 and most_dirt >= LEAST_LEVEL:
                feel_dirt(knots, k, part, strip.level)
                add_crumbs(floor, x, y, t, crumb_share, strip)
            cover_with_dust(strip)
            if row < lowest:
                put_before(work.tile[row], depths[row, begin : begin + STRIP], t, strip.colour)
            write_pixels(strip.colour, picture[row, 3 * begin :])
