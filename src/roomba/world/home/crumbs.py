"""The pattern of dirt that the camera shows: the crumbs, and the amount of dirt that shows each."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

CRUMB_COLOURS = (
    (70, 56, 44),
    (96, 76, 58),
    (104, 92, 80),
    (58, 50, 46),
    (146, 112, 70),
    (176, 140, 92),
    (206, 186, 150),
    (120, 118, 116),
)
"""Soil, crust, dust, grit, crumb, toast, bread, lint."""
DUST = 0x7A848A
"""Dust, and what many crumbs look like from afar, packed as 0x00BBGGRR."""


@cache
def crumbs() -> NDArray[np.uint16]:
    """Return the dirt's pattern, uint16 [1024, 1024] over 0.512 m, seamless.

    The low byte is the level of dirt (see the kernels) from which on a speck is seen there, 255
    for never; the high byte is its colour, 0..15.
    """
    n = 1024
    random = np.random.default_rng(101)
    levels = np.full((n, n), 255, np.uint16)
    tones = np.zeros((n, n), np.uint16)
    count = 7000
    # Few specks show at a little dirt, most of them only at a lot: g/m2 ~ rank, level ~ sqrt(g/m2).
    wanted = 4.0 + 244.0 * (np.arange(count) / count) ** 0.59
    shapes = [_speck(1.1 + 5.4 * (step / 32.0) ** 2, random) for step in range(33)]
    kinds = random.choice(8, count, p=(0.25, 0.2, 0.15, 0.1, 0.1, 0.1, 0.05, 0.05))
    sizes = np.minimum(32, random.exponential(9.0, count)).astype(int)
    places = random.integers(0, n, (count, 2))
    for rank in random.permutation(count):
        v, u, lit = shapes[sizes[rank]]
        at = ((places[rank, 0] + v) % n, (places[rank, 1] + u) % n)
        levels[at] = np.minimum(levels[at], int(wanted[rank]))
        tones[at] = 2 * kinds[rank] + lit
    return levels | (tones << np.uint16(8))


def _speck(
    radius: float, random: np.random.Generator
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.bool_]]:
    """Return the texels (v, u) of one crumb and which of them the light falls on."""
    reach = int(radius * 1.6 + 1.0)
    u, v = np.meshgrid(np.arange(-reach, reach + 1), np.arange(-reach, reach + 1))
    angle = random.uniform(0.0, np.pi)
    stretch = random.uniform(0.65, 1.0)
    along = u * np.cos(angle) + v * np.sin(angle)
    across = v * np.cos(angle) - u * np.sin(angle)
    ragged = radius * random.uniform(0.75, 1.1, u.shape)
    inside = (along * stretch) ** 2 + (across / stretch) ** 2 < ragged**2
    return v[inside], u[inside], (v - 0.6 * u < -0.35 * radius)[inside]
