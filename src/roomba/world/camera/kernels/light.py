"""Compiled light on upright faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE
from roomba.world.camera.scene.arrays import SceneArrays


@compiled(**INLINE)
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


@compiled(**INLINE)
def upright_shade(
    scene: SceneArrays, x: float, y: float, normal_x: float, normal_y: float, t: float
) -> float:
    """Return the light, 0..1, on an upright face at a place, m, with an outward normal."""
    lighting = scene.lighting
    light = between_bytes(
        lighting.air,
        (y + 0.1 * normal_y - lighting.origin_y) / lighting.cell,
        (x + 0.1 * normal_x - lighting.origin_x) / lighting.cell,
    )
    # As if most of the light came from one side: neighbouring faces must differ to be told apart.
    facing = 0.93 + 0.09 * (0.78 * normal_x + 0.62 * normal_y)
    return float(light / 255.0 * facing * (1.0 - 0.20 * t / (t + 5.0)))
