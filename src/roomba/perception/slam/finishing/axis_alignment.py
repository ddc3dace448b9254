"""Axis alignment: the turn and shift that lay a home's walls along the map's axes and cells."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Floats

_ALONG: Final = 0.995
"""Cosine; a wall that faces along an axis so well has one coordinate on that axis."""
_LEAST_POINTS: Final = 200
_LEAST_AGREEMENT: Final = 0.4
"""Length of the mean of directions; below it walls have no common direction."""


def turn_of_walls(cloud: Floats, oblique: float) -> float:
    """Return by how much the walls are turned from the axes, rad; 0 if too few lie near the axes.

    ``cloud`` is float64 [n, 4], points with normals. Walls at a larger angle to the axes than
    ``oblique``, rad, are taken to be built so.
    """
    # For strided columns numpy's last bit depends on their place in memory.
    angles = np.arctan2(np.ascontiguousarray(cloud[:, 3]), np.ascontiguousarray(cloud[:, 2]))
    quarter = math.pi / 2.0
    off = np.remainder(angles + quarter / 2.0, quarter) - quarter / 2.0
    near = off[np.abs(off) < oblique]
    if len(near) < max(_LEAST_POINTS, len(off) // 3):
        return 0.0
    for _ in range(5):
        middle = float(np.median(near))
        # Choose from all points anew: a fixed choice would cut noise off on one side, and pull.
        near = off[np.abs(off - middle) < 0.5 * oblique]
    return float(near.mean())


def phase_of_walls(cloud: Floats, resolution: float) -> tuple[float, float]:
    """Return where, from 0 to ``resolution``, m, walls lie between the cells of a grid, x and y.

    A grid whose cells begin there shows walls without steps. It is 0 if walls agree on no place.
    """
    phases = []
    for axis in (0, 1):
        facing = np.abs(cloud[:, 2 + axis]) > _ALONG
        places = cloud[facing, axis]
        if len(places) < _LEAST_POINTS:
            phases.append(0.0)
            continue
        mean = np.exp(2.0j * np.pi * places / resolution).mean()
        share = float(np.angle(mean)) / (2.0 * math.pi) % 1.0
        phases.append(share * resolution if abs(mean) >= _LEAST_AGREEMENT else 0.0)
    return phases[0], phases[1]
