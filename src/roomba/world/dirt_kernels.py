"""Compiled brushes: what they pick up, and how much dirt lies under a disc.

``dirt`` is int32 [rows, columns], micrograms in each cell; ``place`` is float64 [3]: resolution,
origin x, origin y, m.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@njit(cache=True, nogil=True)
def sweep(
    dirt: NDArray[np.int32],
    place: Floats,
    brush: Floats,
    x: float,
    y: float,
    theta: float,
    linear: float,
    angular: float,
    dt: float,
    room_in_bin: int,
) -> int:
    """Pick up dirt under the brush during one step; returns the micrograms taken from the floor.

    ``brush`` is float64 [3]: width, depth, m, and efficiency 0..1 of one pass. Every cell whose
    middle lies under the brush loses the share 1 - (1 - efficiency)**(way / depth), where ``way``
    is what the bristles travel over it, so that a pass takes the same share in one step or in many.
    """
    if room_in_bin <= 0:
        return 0
    resolution = place[0]
    half_width = 0.5 * brush[0]
    half_depth = 0.5 * brush[1]
    keep_of_pass = 1.0 - brush[2]
    cosine = math.cos(theta)
    sine = math.sin(theta)
    reach = math.hypot(half_width, half_depth)
    rows, columns = dirt.shape
    first_row = max(0, math.floor((y - reach - place[2]) / resolution))
    last_row = min(rows - 1, math.floor((y + reach - place[2]) / resolution))
    first_column = max(0, math.floor((x - reach - place[1]) / resolution))
    last_column = min(columns - 1, math.floor((x + reach - place[1]) / resolution))
    taken = 0
    for row in range(first_row, last_row + 1):
        dy = place[2] + (row + 0.5) * resolution - y
        for column in range(first_column, last_column + 1):
            amount = dirt[row, column]
            if amount == 0:
                continue
            dx = place[1] + (column + 0.5) * resolution - x
            ahead = cosine * dx + sine * dy
            aside = cosine * dy - sine * dx
            if abs(ahead) > half_depth or abs(aside) > half_width:
                continue
            way = math.hypot(linear - angular * aside, angular * ahead) * dt
            share = 1.0 - keep_of_pass ** (way / brush[1])
            picked = min(int(amount * share), room_in_bin - taken)
            dirt[row, column] = amount - picked
            taken += picked
    return taken


@njit(cache=True, nogil=True)
def amount_under_disc(
    dirt: NDArray[np.int32], place: Floats, x: float, y: float, radius: float
) -> int:
    """Return the micrograms in all cells whose middles lie under a disc."""
    resolution = place[0]
    u = (x - place[1]) / resolution - 0.5
    v = (y - place[2]) / resolution - 0.5
    reach = radius / resolution
    rows, columns = dirt.shape
    total = 0
    for row in range(max(0, math.ceil(v - reach)), min(rows - 1, math.floor(v + reach)) + 1):
        half = math.sqrt(max(0.0, reach * reach - (row - v) ** 2))
        first = max(0, math.ceil(u - half))
        last = min(columns - 1, math.floor(u + half))
        for column in range(first, last + 1):
            total += dirt[row, column]
    return total
