"""Procedural textures for the camera: seamless grey patterns.

A texture is uint8 [n, n], n a power of two, first axis v, second u, seamless in both directions;
128 is a material's mean colour. Palettes (:mod:`roomba.world.camera.scene.texture_atlas`) turn the
greys into colours, so that grout, grain and weave need one byte per texel in every material.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats32

Bytes = NDArray[np.uint8]

GROUT = 40
"""Greys below this are joints between tiles: palettes of tiles give them the grout's colour."""


@dataclass(frozen=True, slots=True, eq=False)
class Pattern:
    """One texture: ``texels`` uint8 [n, n] that cover ``size`` x ``size`` m."""

    texels: Bytes
    size: float


def _noise(n: int, cells_v: int, cells_u: int, seed: int) -> Floats32:
    """Return smooth seamless noise of -1..1, float32 [n, n], with so many cells each way."""
    coarse = np.random.default_rng(seed).uniform(-1.0, 1.0, (cells_v, cells_u)).astype(np.float32)
    rows = _stretched(coarse, n)
    return np.ascontiguousarray(_stretched(np.ascontiguousarray(rows.T), n).T)


def _stretched(values: Floats32, n: int) -> Floats32:
    """Return ``values`` [cells, m] interpolated along the first axis, seamless, as [n, m]."""
    cells = values.shape[0]
    place = (np.arange(n, dtype=np.float32) + 0.5) * (cells / n) - 0.5
    low = np.floor(place).astype(np.intp)
    part = (place - low).astype(np.float32)[:, None]
    stretched: Floats32 = values[low % cells] * (1.0 - part)
    stretched += values[(low + 1) % cells] * part
    return stretched


def _grey(values: Floats32) -> Bytes:
    """Return 128 + ``values`` as uint8."""
    return np.clip(values + 128.5, 0.0, 255.0).astype(np.uint8)


def _grain(n: int, seed: int) -> Floats32:
    """Wood grain along u: long fibres, pores, and the waves of the year rings; about -1..1."""
    v = np.arange(n, dtype=np.float32)[:, None] / n
    bend = _noise(n, 8, 3, seed) * 0.035 + _noise(n, 16, 6, seed + 1) * 0.01
    rings = np.sin((v + bend) * (2.0 * np.pi * 34.0)).astype(np.float32)
    fibres = _noise(n, n // 2, max(4, n // 128), seed + 2)
    pores = np.minimum(_noise(n, n // 2, n // 24, seed + 3) + 0.45, 0.0)
    patches = _noise(n, 10, 3, seed + 4)
    grain: Floats32 = 0.30 * rings + 0.35 * fibres + 1.1 * pores + 0.45 * patches
    return grain


def planks() -> Pattern:
    """A floor of boards along x, 0.128 m wide and 0.77 m long, with dark joints."""
    n, rows = 2048, 12
    random = np.random.default_rng(3)
    grain = _grain(1024, 11)
    grey = np.empty((n, n), np.uint8)
    edges = np.round(np.linspace(0, n, rows + 1)).astype(int)
    for top, bottom in pairwise(edges):
        middle = n // 2 + int(random.integers(-n // 6, n // 6))
        for begin, end in ((0, middle), (middle, n)):
            row = int(random.integers(1024 - bottom + top))
            column = int(random.integers(2 * 1024 - end + begin))
            along = np.arange(column, column + end - begin) % 1024
            strip = 21.0 * grain[row : row + bottom - top, along]
            strip += np.float32(random.uniform(-19.0, 19.0))
            strip[:, :1] -= 30.0
            strip[:, -2:] -= 62.0
            strip[:1] -= 24.0
            strip[-2:] -= 58.0
            grey[top:bottom, begin:end] = _grey(strip)
        grey[top:bottom] = np.roll(grey[top:bottom], int(random.integers(n)), 1)
    return Pattern(grey, 1.536)


def wood() -> Pattern:
    """Furniture's wood: grain along u, no joints."""
    return Pattern(_grey(26.0 * _grain(512, 21)), 0.9)


def _tiles(n: int, count: int, size: float, grout: int, marbling: float, seed: int) -> Pattern:
    random = np.random.default_rng(seed)
    clouds = _noise(n, 12, 12, seed) + 0.6 * _noise(n, 40, 40, seed + 1)
    grey = marbling * clouds + 1.5 * _noise(n, n // 2, n // 2, seed + 2)
    side = n // count
    shades = random.uniform(-1.0, 1.0, (count, count)).astype(np.float32) * marbling
    grey += np.kron(shades, np.ones((side, side), np.float32))
    place = np.arange(n) % side
    gap = np.minimum(place, side - 1 - place)
    nearest = np.minimum(gap[:, None], gap[None, :])
    bevel = np.clip(nearest - grout, 0, 5) / 5.0
    grey = np.where(nearest < grout, 24.0 - 128.0, grey - 22.0 * (1.0 - bevel))
    return Pattern(_grey(grey.astype(np.float32)), size)


def tiles() -> Pattern:
    """A floor of tiles, 0.3 m square, 5 mm of grout."""
    return _tiles(1024, 4, 1.2, 2, 7.0, 31)


def wall_tiles() -> Pattern:
    """Wall tiles, 0.15 m square."""
    return _tiles(512, 4, 0.6, 1, 3.0, 37)


def weave() -> Pattern:
    """Woven cloth of sofas and beds."""
    n = 256
    v, u = np.mgrid[0:n, 0:n].astype(np.float32) * (2.0 * np.pi * 32 / n)
    threads = np.sin(u) * np.cos(v) + 0.5 * np.sin(u + v)
    worn = _noise(n, 5, 5, 41) * 0.9 + _noise(n, 128, 128, 42) * 0.8
    return Pattern(_grey((10.0 * threads + 9.0 * worn).astype(np.float32)), 0.256)


def pile() -> Pattern:
    """A carpet's pile: tufts of several shades in soft patches."""
    tufts = 0.8 * _noise(1024, 512, 512, 51) + 0.8 * _noise(1024, 200, 200, 52)
    patches = 0.5 * _noise(1024, 24, 24, 53) + 0.35 * _noise(1024, 7, 7, 54)
    return Pattern(_grey(26.0 * (tufts + patches)), 0.9)


def stone() -> Pattern:
    """Polished stone or screed: clouds and small chips."""
    clouds = _noise(1024, 6, 6, 61) + 0.6 * _noise(1024, 18, 18, 62)
    chips = _noise(1024, 340, 340, 63)
    speckle = np.where(chips > 0.72, 26.0, np.where(chips < -0.72, -30.0, 0.0))
    return Pattern(_grey((9.0 * clouds + speckle + 3.0 * chips).astype(np.float32)), 1.0)


def metal() -> Pattern:
    """Brushed metal: fine streaks along u under broad reflections."""
    streaks = _noise(256, 256, 4, 71)
    broad = _noise(256, 2, 2, 72)
    return Pattern(_grey(9.0 * streaks + 16.0 * broad), 0.5)


def leaf() -> Pattern:
    """Leaves: bright blades over dark gaps."""
    n = 512
    random = np.random.default_rng(81)
    tile = np.full((n, n), 48.0, np.float32)
    for shade in np.sort(random.integers(80, 210, 420)):
        u, v = random.integers(0, n, 2)
        angle = float(random.uniform(0.0, 2.0 * np.pi))
        length, width = random.integers(14, 34), random.integers(5, 10)
        reach = np.arange(-length - 3, length + 4)
        along = reach * np.cos(angle) + reach[:, None] * np.sin(angle)
        across = reach[:, None] * np.cos(angle) - reach * np.sin(angle)
        # One texel of soft edge, about.
        blade = np.clip(width * (1.0 - np.hypot(along / length, across / width)) + 1.0, 0.0, 1.0)
        at = np.ix_((v + reach) % n, (u + reach) % n)
        tile[at] += (shade - tile[at]) * blade
    return Pattern(tile.astype(np.uint8), 0.6)


def glass() -> Pattern:
    """Panes and screens: one broad slanting reflection."""
    n = 128
    v, u = np.mgrid[0:n, 0:n].astype(np.float32) / n
    sheen = 20.0 * np.sin(2.0 * np.pi * (u + v)) + 10.0 * np.sin(2.0 * np.pi * (2.0 * u + 2.0 * v))
    return Pattern(_grey(sheen.astype(np.float32)), 1.2)


def plain() -> Pattern:
    """Paint and plastic: an orange-peel surface, hardly seen."""
    return Pattern(_grey(3.0 * _noise(512, 256, 256, 91) + 1.2 * _noise(512, 6, 6, 92)), 1.0)


def view() -> Pattern:
    """What is seen through a window: trees below a bright sky; v is the height, 0..2.56 m."""
    n = 256
    height = np.arange(n, dtype=np.float32)[:, None] / n * 2.56
    line = 1.22 + 0.16 * _noise(n, 1, 9, 95)[:1] + 0.05 * _noise(n, 1, 40, 96)[:1]
    trees = 40.0 + 30.0 * _noise(n, 30, 24, 97) + 20.0 * (height - 0.9)
    sky = 150.0 + 80.0 * np.clip((height - 0.9) / 1.3, 0.0, 1.0)
    cover = np.clip((line - height) / 0.06, 0.0, 1.0)
    grey = cover * trees + (1.0 - cover) * (sky + 10.0 * _noise(n, 10, 5, 98))
    return Pattern(np.clip(grey, 0.0, 255.0).astype(np.uint8), 2.56)


PATTERNS: dict[str, Callable[[], Pattern]] = {
    "planks": planks,
    "wood": wood,
    "tiles": tiles,
    "wall_tiles": wall_tiles,
    "weave": weave,
    "pile": pile,
    "stone": stone,
    "metal": metal,
    "leaf": leaf,
    "glass": glass,
    "plain": plain,
    "view": view,
}
"""Every pattern by its name."""
