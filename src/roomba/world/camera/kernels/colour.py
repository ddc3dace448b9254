"""Compiled small steps from a texture to a colour; colours are packed as 0x00BBGGRR."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE

RED_BLUE, GREEN, EIGHT = np.uint32(0xFF00FF), np.uint32(0x00FF00), np.uint32(8)


@compiled(**INLINE)
def scaled(colour: int, shade: int) -> int:
    """Return a packed colour times ``shade`` / 256, shade 0..256."""
    red_blue = ((colour & 0xFF00FF) * shade >> 8) & 0xFF00FF
    green = ((colour & 0x00FF00) * shade >> 8) & 0x00FF00
    return red_blue | green


@compiled(**INLINE)
def blended(colour: int, other: int, share: int) -> int:
    """Return a packed colour mixed with ``share`` / 256 of another, share 0..256."""
    return int(scaled(colour, 256 - share) + scaled(other, share))


@compiled(**INLINE)
def mixed(colour: np.uint32, other: np.uint32, share: np.int32) -> np.uint32:
    """Return what :func:`blended` does, rounded once instead of twice, by numbers of 32 bits."""
    one, two = np.uint32(256 - share), np.uint32(share)
    red_blue = np.uint32((colour & RED_BLUE) * one) + np.uint32((other & RED_BLUE) * two)
    green = np.uint32((colour & GREEN) * one) + np.uint32((other & GREEN) * two)
    return np.uint32(
        (np.uint32(red_blue) >> EIGHT & RED_BLUE) | (np.uint32(green) >> EIGHT & GREEN)
    )


@compiled(**INLINE)
def level_of(size: float, bits: int) -> int:
    """Return which halving of a texture has texels about as big as a sample of ``size`` texels."""
    size *= 1.0 / 1.5
    # Not from the number's exponent, which takes a call.
    level = np.int64(0)
    while size >= 1.0 and level < bits:
        size *= 0.5
        level += 1
    return int(level)


@compiled(**INLINE)
def smooth_texel(texels: NDArray[np.uint8], start: int, bits: int, u: float, v: float) -> int:
    """Return a texture's grey between four texels; ``u``, ``v`` in texels of this level."""
    mask = (1 << bits) - 1
    u -= 0.5
    v -= 0.5
    low_u = math.floor(u)
    low_v = math.floor(v)
    part_u = int((u - low_u) * 256.0)
    part_v = int((v - low_v) * 256.0)
    left = int(low_u) & mask
    right = (left + 1) & mask
    upper = start + ((int(low_v) & mask) << bits)
    lower = start + (((int(low_v) + 1) & mask) << bits)
    one = np.int32(texels[upper + left]) * (256 - part_u) + texels[upper + right] * part_u
    two = np.int32(texels[lower + left]) * (256 - part_u) + texels[lower + right] * part_u
    return int((one * (256 - part_v) + two * part_v) >> 16)
