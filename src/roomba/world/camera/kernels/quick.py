"""Compiled pictures of one sample per pixel, made for speed.

A picture is painted in tiles of as many columns as there are lanes, so that what is worked on stays
in the nearest caches: upright things column by column, the floor row by row.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.dirt import feel_knots
from roomba.world.camera.kernels.face import row_of
from roomba.world.camera.kernels.quick_floor import paint_floor
from roomba.world.camera.kernels.quick_upright import LIGHT, paint_columns
from roomba.world.camera.kernels.ray import cast_walls, find_boxes
from roomba.world.camera.lanes.compilation import INLINE, INNER, KERNEL
from roomba.world.camera.lanes.lane_memory import load, store, store_pixels, turn
from roomba.world.camera.lanes.lanes import LANES, all_real
from roomba.world.camera.scene.arrays import SceneArrays, ViewTables, Workspace


@compiled(**INNER)
def finish_upright(
    work: Workspace,
    view: ViewTables,
    begin: int,
    first_row: int,
    lowest: int,
    picture: NDArray[np.uint8],
    depths: NDArray[np.float32],
) -> None:
    """Turn a tile's columns into rows: all depths, and the picture above ``first_row``.

    Below that, colours are left in ``work.tile``; from ``lowest`` down is only floor.
    """
    height = work.colours.shape[1]
    for row in range(0, lowest, LANES):
        turn(work.colours, row, height, work.tile, row * LANES, LANES)
        turn(work.depths, row, height, depths, row * view.columns + begin, view.columns)
    for row in range(lowest, view.rows):
        store(depths, row * view.columns + begin, all_real(view.floor_depth[row]))
    for row in range(first_row):
        colours = load(work.tile, row * LANES)
        store_pixels(picture, 3 * (row * view.columns + begin), colours)


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
    origin y of ``dirt``. ``depths`` has rows to spare, for a whole number of lanes.
    """
    farthest = cast_walls(scene.walls, view, x, y, cosine, sine, work.hits)
    boxes = find_boxes(scene.boxes.shapes, view, x, y, cosine, sine, farthest, work.seen)
    for begin in range(-LANES, view.columns, LANES):
        end = begin + LANES
        # Its right edge is the next tile's left one.
        k = (view.middle - end) / view.focal
        feel_knots(
            scene.lighting, view, x, y, cosine - k * sine, sine + k * cosine,
            first_floor_row(work.hits, view, max(begin, 0), end + LANES),
            dirt, dirt_place, scene.floor.cover, LIGHT, work.knots[(end // LANES) & 1],
        )  # fmt: skip
        if begin < 0:
            continue
        first_row = first_floor_row(work.hits, view, begin, end)
        lowest = paint_columns(
            scene, view, x, y, cosine, sine, begin, boxes, first_row, work, depths
        )
        finish_upright(work, view, begin, first_row, lowest, picture, depths)
        paint_floor(
            scene, view, x, y, cosine, sine, begin, first_row, lowest, work, picture, depths
        )
