"""Compiled painting of one picture column: upright faces and level planes.

A picture column is two rows of memory: ``colours`` uint32 [rows] as 0x00BBGGRR and ``depths``
float32 [rows], m along the optical axis. Row 0 is the top; row r looks up at the slope
``(half - r - 0.5) / focal``. Nothing is painted over what is nearer. A ray's parameter ``t`` is
its depth, so that ``position = camera + t * direction`` with a direction of depth 1.
Textures and surfaces: see :class:`roomba.world.surfaces.SceneArrays`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.world.camera_compilation import KERNEL
from roomba.world.scene_arrays import Surfaces

Colours = NDArray[np.uint32]
Depths = NDArray[np.float32]

CONTACT_HEIGHT = 0.22
"""m; below this, faces that stand on the floor grow darker towards it."""
CONTACT_SHADE = 0.70
"""How bright such a face is at the floor, against its upper part."""


@njit(**KERNEL)
def scaled(colour: int, shade: int) -> int:
    """Return a packed colour times ``shade`` / 256, shade 0..256."""
    red_blue = ((colour & 0xFF00FF) * shade >> 8) & 0xFF00FF
    green = ((colour & 0x00FF00) * shade >> 8) & 0x00FF00
    return red_blue | green


@njit(**KERNEL)
def blended(colour: int, other: int, share: int) -> int:
    """Return a packed colour mixed with ``share`` / 256 of another, share 0..256."""
    return int(scaled(colour, 256 - share) + scaled(other, share))


@njit(**KERNEL)
def row_of(slope: float, half: float, focal: float, rows: int) -> int:
    """Return the first row that looks at or below a slope, 0..rows."""
    row = math.ceil(half - 0.5 - focal * slope)
    return int(min(max(row, 0.0), float(rows)))


@njit(**KERNEL)
def level_of(size: float, bits: int) -> int:
    """Return which halving of a texture has texels about as big as a sample of ``size`` texels."""
    level = 0
    while size > 1.5 and level < bits:
        size *= 0.5
        level += 1
    return level


@njit(**KERNEL)
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


@njit(**KERNEL)
def paint_rows(
    colours: Colours,
    depths: Depths,
    first: int,
    last: int,
    t: float,
    surfaces: Surfaces,
    surface: int,
    footprint: float,
    u: float,
    v: float,
    step: float,
    upright: bool,
    shade: float,
    shade_step: float,
    smooth: bool,
) -> None:
    """Paint rows first..last-1 of one depth with a surface.

    ``u``, ``v`` are m on the face in the first row, ``step`` is what v gains per row; ``upright``
    turns the texture by a right angle. ``footprint`` is the m that a sample covers, ``shade``
    0..1 the light in the first row and ``shade_step`` its gain per row.
    """
    texels, palettes = surfaces.texels, surfaces.palettes
    texture = surfaces.texture[surface]
    scale = float(surfaces.scale[texture])
    level = level_of(footprint * scale, surfaces.bits[texture])
    bits = surfaces.bits[texture] - level
    start = surfaces.offsets[texture, level]
    scale /= 1 << level
    light = shade * 256.0
    light_step = shade_step * 256.0
    near = np.float32(t)
    if smooth and footprint * scale < 0.75:
        colour = 0
        for row in range(first, last):
            if near < depths[row]:
                depths[row] = near
                # Samples are so much smaller than texels that two may share a colour.
                if not row & 1 or colour == 0:
                    at = (v + step * (row - first)) * scale
                    if upright:
                        grey = smooth_texel(texels, start, bits, at, u * scale)
                    else:
                        grey = smooth_texel(texels, start, bits, u * scale, at)
                    colour = scaled(
                        palettes[surface, grey], int(light + light_step * (row - first))
                    )
                colours[row] = colour
            else:
                colour = 0
        return
    mask = (1 << bits) - 1
    fixed = math.floor(u * scale) & mask
    across = bits
    if upright:
        start += fixed << bits
        across = 0
    else:
        start += fixed
    # Fixed point with 16 bits behind the point: wraps around the texture by itself.
    place = np.int64(math.floor(v * scale * 65536.0))
    advance = np.int64(math.floor(step * scale * 65536.0))
    for row in range(first, last):
        if near < depths[row]:
            depths[row] = near
            grey = texels[start + (((place >> 16) & mask) << across)]
            shade_now = int(light + light_step * (row - first))
            colours[row] = scaled(palettes[surface, grey], shade_now)
        place += advance


@njit(**KERNEL)
def paint_face(
    colours: Colours,
    depths: Depths,
    t: float,
    bottom: float,
    top: float,
    eye: float,
    half: float,
    focal: float,
    surfaces: Surfaces,
    surface: int,
    slant: float,
    u: float,
    upright: bool,
    shade: float,
    smooth: bool,
) -> None:
    """Paint an upright face of depth ``t`` between two heights above the floor, m.

    ``eye`` is the camera's height, ``slant`` how much wider than high a sample is on the face,
    ``u`` the place along the face, m. The face darkens towards the floor.
    """
    rows = depths.shape[0]
    step = -t / focal
    footprint = -step * min(math.sqrt(slant), 4.0)
    above = max(bottom, CONTACT_HEIGHT)
    first = row_of((top - eye) / t, half, focal, rows)
    last = row_of((bottom - eye) / t, half, focal, rows)
    middle = min(max(row_of((above - eye) / t, half, focal, rows), first), last)
    if surfaces.glows[surface]:
        middle = last
    if first < middle:
        height = eye + (half - first - 0.5) * t / focal
        paint_rows(
            colours, depths, first, middle, t, surfaces, surface, footprint,
            u, height, step, upright, shade, 0.0, smooth,
        )  # fmt: skip
    if middle < last:
        height = eye + (half - middle - 0.5) * t / focal
        gain = shade * (1.0 - CONTACT_SHADE) / CONTACT_HEIGHT
        low = shade * CONTACT_SHADE + gain * max(min(height, CONTACT_HEIGHT), 0.0)
        paint_rows(
            colours, depths, middle, last, t, surfaces, surface, footprint,
            u, height, step, upright, low, gain * step, smooth,
        )  # fmt: skip


@njit(**KERNEL)
def paint_plane(
    colours: Colours,
    depths: Depths,
    first: int,
    last: int,
    reach: Depths,
    gap: float,
    focal: float,
    surfaces: Surfaces,
    surface: int,
    u: float,
    v: float,
    u_step: float,
    v_step: float,
    shade_first: float,
    shade_last: float,
) -> None:
    """Paint rows first..last-1 with a level plane, ``gap`` m above or below the camera.

    ``reach`` [rows] is the depth at which a row meets a plane 1 m away. ``u``, ``v`` are the
    plane's coordinates under the camera, m, and ``u_step``, ``v_step`` what they gain per depth.
    """
    if last <= first:
        return
    texels, palettes, offsets = surfaces.texels, surfaces.palettes, surfaces.offsets
    texture = surfaces.texture[surface]
    all_scale = float(surfaces.scale[texture])
    all_bits = surfaces.bits[texture]
    light = shade_first * 256.0
    light_step = (shade_last - shade_first) * 256.0 / (last - first)
    row = first
    while row < last:
        until = min(row + 16, last)
        t = gap * reach[(row + until) // 2]
        along = t * t / (gap * focal)
        scale = all_scale
        level = level_of(math.sqrt(along * t / focal) * scale, all_bits)
        bits = all_bits - level
        start = offsets[texture, level]
        scale /= 1 << level
        mask = (1 << bits) - 1
        for at in range(row, until):
            t = gap * reach[at]
            if t < depths[at]:
                depths[at] = t
                column = math.floor((u + t * u_step) * scale) & mask
                line = math.floor((v + t * v_step) * scale) & mask
                grey = texels[start + (line << bits) + column]
                shade = int(light + light_step * (at - first))
                colours[at] = scaled(palettes[surface, grey], shade)
        row = until
