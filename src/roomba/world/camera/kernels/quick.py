"""Compiled pictures of one sample per pixel, made for speed.

A picture is painted in strips of some columns, which stay in the nearest caches: upright things
column by column, the floor row by row. Light and dirt on the floor are sampled at the edges of
tiles, of which a strip has several.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE, INNER, KERNEL
from roomba.world.camera.kernels.dirt import feel_knots
from roomba.world.camera.kernels.face import row_of
from roomba.world.camera.kernels.film import turn, write_pixels
from roomba.world.camera.kernels.quick_floor import paint_floor
from roomba.world.camera.kernels.quick_upright import LIGHT, paint_columns
from roomba.world.camera.kernels.ray import cast_walls, column_ray, find_boxes
from roomba.world.camera.scene.arrays import (
    STRIP,
    TILE,
    FloorDirt,
    Ray,
    SceneArrays,
    ViewTables,
    Workspace,
)


@compiled(**INNER)
def turn_upright(
    work: Workspace,
    view: ViewTables,
    begin: int,
    first_row: int,
    lowest: int,
    picture: NDArray[np.uint8],
    depths: NDArray[np.float32],
) -> None:
    """Turn a strip's columns into rows: all depths, and the picture above ``first_row``.

    Below that row, colours are left in ``work.tile``; from ``lowest`` down there is only floor.
    """
    turn(work.colours, lowest, work.tile, 0)
    turn(work.depths, lowest, depths, begin)
    for row in range(lowest, view.rows):
        depths[row, begin : begin + STRIP] = view.floor_depth[row]
    for row in range(first_row):
        write_pixels(work.tile[row], picture[row, 3 * begin :])


@compiled(**INLINE)
def first_floor_row(hits: NDArray[np.float64], view: ViewTables, begin: int, end: int) -> int:
    """Return the first row of floor that can be in sight in columns begin..end-1."""
    farthest = 0.0
    for c in range(max(begin, 0), min(end, view.columns)):
        farthest = max(farthest, hits[c, 0])
    return int(row_of(-view.eye / farthest, 0.5 * view.rows, view.focal, view.rows))


@compiled(**INLINE)
def feel_edges(
    scene: SceneArrays, view: ViewTables, axis: Ray, dirt: FloorDirt, work: Workspace
) -> None:
    """Sample light and dirt along each edge of a tile, from the first row that may show floor."""
    for edge in range(work.knots.shape[0]):
        column = edge * TILE
        left, right = (column - 1) // STRIP * STRIP, (column // STRIP + 1) * STRIP
        feel_knots(
            scene.lighting, view, column_ray(view, axis, column),
            first_floor_row(work.hits, view, left, right),
            dirt, scene.floor.cover, LIGHT, work.knots[edge],
        )  # fmt: skip


@compiled(**KERNEL)
def render_quick(
    scene: SceneArrays,
    view: ViewTables,
    axis: Ray,
    dirt: FloorDirt,
    work: Workspace,
    picture: NDArray[np.uint8],
    depths: NDArray[np.float32],
) -> None:
    """Paint ``picture`` [rows, 3 * columns], red, green, blue, and ``depths`` [rows, columns].

    ``axis`` is the optical axis.
    """
    farthest = cast_walls(scene.walls, view, axis, work.hits)
    boxes = find_boxes(scene.boxes.shapes, view, axis, farthest, work.seen)
    feel_edges(scene, view, axis, dirt, work)
    for begin in range(0, view.columns, STRIP):
        first_row = first_floor_row(work.hits, view, begin, begin + STRIP)
        lowest = paint_columns(scene, view, axis, begin, boxes, work)
        turn_upright(work, view, begin, first_row, lowest, picture, depths)
        paint_floor(scene, view, axis, begin, first_row, lowest, work, picture, depths)
