"""Compiled pictures of one sample per pixel, made for speed.

A picture is painted in tiles of some columns, so that what is worked on stays in the nearest
caches: upright things column by column, the floor row by row.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE, INNER, KERNEL
from roomba.world.camera.kernels.dirt import feel_knots
from roomba.world.camera.kernels.face import row_of
from roomba.world.camera.kernels.film import put_pixel
from roomba.world.camera.kernels.quick_floor import paint_floor
from roomba.world.camera.kernels.quick_upright import LIGHT, paint_columns
from roomba.world.camera.kernels.ray import cast_walls, find_boxes
from roomba.world.camera.scene.arrays import TILE, SceneArrays, ViewTables, Workspace


@compiled(**INNER)
def turn_upright(
    work: Workspace,
    view: ViewTables,
    begin: int,
    lowest: int,
    picture: NDArray[np.uint8],
    depths: NDArray[np.float32],
) -> None:
    """Turn a tile's columns into rows of the picture and of depths.

    From ``lowest`` down is only floor.
    """
    for row in range(lowest):
        line_depths, line_pixels = depths[row], picture[row]
        for i in range(TILE):
            place = np.uint64(begin + i)
            line_depths[place] = work.depths[np.uint64(i), np.uint64(row)]
            colour = np.int64(work.colours[np.uint64(i), np.uint64(row)])
            put_pixel(line_pixels, place, colour)
    for row in range(lowest, view.rows):
        depths[row, begin : begin + TILE] = view.floor_depth[row]


@compiled(**INLINE)
def first_floor_row(hits: NDArray[np.float64], view: ViewTables, begin: int, end: int) -> int:
    """Return the first row of floor that can be in sight in columns begin..end-1."""
    farthest = 0.0
    for c in range(begin, min(end, view.columns)):
        farthest = max(farthest, hits[c, 0])
    return int(row_of(-view.eye / farthest, 0.5 * view.rows, view.focal, view.rows))


@compiled(**KERNEL)
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
    picture: NDArray[np.uint8],
    depths: NDArray[np.float32],
) -> None:
    """Paint ``picture`` [rows, columns, 3], red, green, blue, and ``depths`` [rows, columns].

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
        first_row = first_floor_row(work.hits, view, begin, end)
        lowest = paint_columns(scene, view, x, y, cosine, sine, begin, boxes, work)
        turn_upright(work, view, begin, lowest, picture, depths)
        paint_floor(
            scene, view, x, y, cosine, sine, begin, first_row,
            work.knots[(begin // TILE) & 1], work.knots[(begin // TILE + 1) & 1],
            work.ways, picture, depths,
        )  # fmt: skip
