"""Textures as the camera reads them: palettes of materials, and all patterns in one array."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from roomba.world.camera.scene.textures import GROUT, PATTERNS, Bytes


def palette(rgb: tuple[int, int, int], name: str) -> NDArray[np.uint32]:
    """Return the colours of the 256 greys of a pattern, uint32 [256] as 0x00BBGGRR."""
    grey = np.arange(256, dtype=np.float32)[:, None]
    colour = np.array(rgb, np.float32)[None, :]
    light = (grey - 128.0) / 128.0
    ramp = colour * (1.0 + light * 0.95)
    if name in ("planks", "wood"):
        # Late wood is not only darker but warmer than early wood.
        ramp *= 1.0 + light * np.array([-0.10, 0.04, 0.16], np.float32)
    if name in ("tiles", "wall_tiles"):
        joint = 0.62 * colour.mean() + 0.10 * colour + np.array([4.0, 3.0, 0.0], np.float32)
        part = np.clip((grey - GROUT) / 40.0, 0.0, 1.0)
        ramp = joint * (1.0 - part) + ramp * part
    if name == "view":
        stops = [0.0, 70.0, 110.0, 160.0, 255.0]
        mix = ([52, 96, 140, 236, 196], [80, 122, 160, 244, 222], [44, 66, 110, 246, 250])
        ramp = np.stack([np.interp(grey[:, 0], stops, channel) for channel in mix], axis=1)
    red, green, blue = np.clip(ramp + 0.5, 0.0, 255.0).astype(np.uint32).T
    packed: NDArray[np.uint32] = red | (green << np.uint32(8)) | (blue << np.uint32(16))
    return packed


def tone() -> NDArray[np.uint8]:
    """Return a gentle film curve [256]: brighter middles, more contrast at the ends."""
    light = np.arange(256) / 255.0
    lifted = light**0.76
    curve = lifted + 0.10 * lifted * (1.0 - lifted) * (2.0 * lifted - 1.0) * 2.0
    return np.asarray(np.clip(curve * 255.0 + 0.5, 0.0, 255.0), np.uint8)


def in_every_light(colours: NDArray[np.uint32], shades: int) -> NDArray[np.uint32]:
    """Return colours [n, m] in ``shades`` lights, dark to full, toned, as [n, shades, m]."""
    lights = np.linspace(0.0, 1.0, shades, dtype=np.float32)[None, :, None]
    curve = tone().astype(np.uint32)
    toned = np.zeros((colours.shape[0], shades, colours.shape[1]), np.uint32)
    for shift in (0, 8, 16):
        channel = ((colours >> np.uint32(shift)) & np.uint32(255)).astype(np.float32)
        toned |= curve[(channel[:, None, :] * lights).astype(np.uint8)] << np.uint32(shift)
    return toned


@dataclass(frozen=True, slots=True, eq=False)
class Atlas:
    """Patterns with all their smaller versions in one array.

    ``texels`` uint8 [..]: level ``l`` of pattern ``p`` begins at ``offsets[p, l]`` (int32) and is
    2**(``bits[p]`` - l) texels wide (``bits`` int32); ``scale[p]`` (float32) is texels per metre
    of level 0. Levels past the smallest repeat it.
    """

    texels: Bytes
    offsets: NDArray[np.int32]
    bits: NDArray[np.int32]
    scale: NDArray[np.float32]


LEVELS = 12


@cache
def atlas(names: tuple[str, ...]) -> Atlas:
    """Return the patterns of these names, in this order, with halved versions down to 1 texel."""
    parts: list[Bytes] = []
    offsets = np.zeros((len(names), LEVELS), np.int32)
    bits = np.zeros(len(names), np.int32)
    scale = np.zeros(len(names), np.float32)
    end = 0
    for index, name in enumerate(names):
        made = PATTERNS[name]()
        texels = made.texels
        bits[index] = texels.shape[0].bit_length() - 1
        scale[index] = texels.shape[0] / made.size
        for level in range(LEVELS):
            if level <= bits[index]:
                offsets[index, level] = end
                parts.append(texels.ravel())
                end += texels.size
                texels = np.asarray(Image.fromarray(texels).reduce(2))
            else:
                offsets[index, level] = offsets[index, level - 1]
    return Atlas(np.concatenate(parts), offsets, bits, scale)
