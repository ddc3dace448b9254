"""Compiled sampling of the floor: how much light falls on it, and how much dirt lies there."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE, INNER
from roomba.world.camera.kernels.light import between_bytes
from roomba.world.camera.scene.arrays import FloorDirt, Lighting, Ray, ViewTables

CRUMB_TEXELS = 2000.0
"""Texels per metre of the crumbs' pattern."""
CRUMB_MASK = 1023
DIRT_LEVEL = 40.0
"""A level of dirt is this times the square root of g/m2: 4 at 0.01, 40 at 1, 253 at 40 g/m2."""
FILM = 14.0
"""g/m2; with so much dirt the fine dust hides half of the most that it can hide."""
CRUMB_BLOCK = 3
"""An entry of ``fewest`` stands for 2 to the power of this many texels, each way."""


@compiled(**INLINE)
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


@compiled(**INLINE)
def veil(cover: NDArray[np.float32], level: float, crispness: float) -> float:
    """Return the share of the floor hidden by dust and by crumbs that are far away, 0..256."""
    grams = (level / DIRT_LEVEL) ** 2
    film = 0.8 * grams / (grams + FILM)
    hidden = cover[int(level)] * (1.0 - crispness)
    return float(256.0 * (film + hidden - film * hidden))


@compiled(**INNER)
def feel_knots(
    lighting: Lighting,
    view: ViewTables,
    ray: Ray,
    first_row: int,
    dirt: FloorDirt,
    cover: NDArray[np.float32],
    full_light: float,
    knots: NDArray[np.float32],
) -> None:
    """Fill in the knots below a ray from ``first_row`` down.

    ``knots`` [knots, 3] gets light, 0..``full_light``, level of dirt, and how much dust hides,
    0..256.
    """
    rows, reach, grid, crispness = view.knots, view.reach, lighting.floor, view.crispness
    per_unit = DIRT_LEVEL * DIRT_LEVEL / (1e6 * dirt.place[0] * dirt.place[0])
    per_cell = 1.0 / lighting.cell
    per_dirt_cell = 1.0 / dirt.place[0]
    count = rows.shape[0]
    for k in range(count):
        if k + 1 < count and rows[k + 1] <= first_row:
            continue
        row = min(rows[k], view.rows - 1)
        t = view.eye * reach[row]
        at_x = ray.x + t * ray.dx
        at_y = ray.y + t * ray.dy
        light = between_bytes(
            grid, (at_y - lighting.origin_y) * per_cell, (at_x - lighting.origin_x) * per_cell
        )
        level = dirt_level(
            dirt.micrograms,
            (at_y - dirt.place[2]) * per_dirt_cell,
            (at_x - dirt.place[1]) * per_dirt_cell,
            per_unit,
        )
        knots[k, 0] = light * (full_light / 255.0) * (1.0 - 0.18 * t / (t + 5.0))
        knots[k, 1] = level
        knots[k, 2] = veil(cover, level, crispness[row]) if level > 0.0 else 0.0


@compiled(**INLINE)
def floor_surface(surfaces: NDArray[np.uint8], row: float, column: float) -> int:
    """Return the surface of the floor at a place in cells; the nearest one outside the map."""
    line = min(max(int(row), 0), surfaces.shape[0] - 1)
    return int(surfaces[line, min(max(int(column), 0), surfaces.shape[1] - 1)])
