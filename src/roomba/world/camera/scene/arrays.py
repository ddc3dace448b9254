"""What the camera's kernels read: a home as flat arrays, and a picture's geometry as tables."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

SHADES = 128
GREYS = 64
"""How many lights and greys a surface's toned colours are kept in."""
GREY_BITS = GREYS.bit_length() - 1
GREY_SHIFT = 8 - GREY_BITS
"""Bits by which a texture's grey, a byte, is shifted right to be one of GREYS."""
TILE = 16
"""Columns of a picture between two places where light and dirt are sampled."""
STRIP = 64
"""Columns of a picture that are painted together: a whole number of tiles."""


class Surfaces(NamedTuple):
    """What faces and floors look like, by surface number; textures have their own numbers."""

    texture: NDArray[np.int32]
    """[surfaces]: which texture."""
    palettes: NDArray[np.uint32]
    """[surfaces, 256]: colour of each grey of the texture, 0x00BBGGRR."""
    shaded: NDArray[np.uint32]
    """[surfaces * SHADES * GREYS]: the palettes, with fewer greys, in every light, and toned."""
    glows: NDArray[np.bool_]
    """[surfaces]: shines by itself, so that no shadow falls on it."""
    texels: NDArray[np.uint8]
    """All textures: see :class:`roomba.world.camera.scene.texture_atlas.Atlas`, also for the
    following."""
    offsets: NDArray[np.int32]
    bits: NDArray[np.int32]
    scale: NDArray[np.float32]
    octave: NDArray[np.float32]
    """[textures]: base 2 logarithm of ``scale``."""


class Lighting(NamedTuple):
    """Light in cells of ``cell`` m from the map's lower left corner, 255 full light."""

    origin_x: float
    origin_y: float
    cell: float
    floor: NDArray[np.uint8]
    """On the floor, with sun and shadows."""
    air: NDArray[np.uint8]
    """On what stands there."""


class WallGrid(NamedTuple):
    """The map's cells with a border of one cell of wall all around."""

    origin_x: float
    """Lower left corner of the map, without the border, m in the map frame."""
    origin_y: float
    resolution: float
    """m."""
    height: float
    """From floor to ceiling, m."""
    skip: NDArray[np.uint8]
    """[rows + 2, columns + 2]: 0 for a wall, else no wall is nearer than so many cells."""
    rooms: NDArray[np.uint8]
    """[rows + 2, columns + 2]: the room of a cell, 0 for none."""
    surfaces: NDArray[np.int32]
    """[rooms, 2]: paint of a room's walls, and the tiles below it or -1."""
    skirting: int
    """Surface of the skirting boards."""
    ceiling: int


class FloorSurfaces(NamedTuple):
    """The floor's surfaces, and the pattern of crumbs on it."""

    origin_x: float
    origin_y: float
    cell: float
    """m."""
    surfaces: NDArray[np.uint8]
    crumbs: NDArray[np.uint16]
    """[1024 * 1024]: see :func:`roomba.world.home.crumbs.crumbs`."""
    fewest: NDArray[np.uint8]
    """[128 * 128]: the lowest level at which a crumb is seen in 8 x 8 texels of ``crumbs``."""
    colours: NDArray[np.uint32]
    """[16], of crumbs."""
    cover: NDArray[np.float32]
    """[256]: share of the floor that crumbs cover at a level of dirt."""
    shaded: NDArray[np.uint32]
    """[17 * SHADES]: crumbs, then dust, in every light, toned."""


class Boxes(NamedTuple):
    """Furniture, what moves, and other robots' bodies."""

    shapes: NDArray[np.float32]
    """[boxes, 8]: x, y, cosine, sine, half length, half width, bottom, top; m.

    A half length of 0 or less is a box that is not there; a half width of 0 makes the box a
    cylinder, whose radius is the half length.
    """
    surfaces: NDArray[np.int32]
    """[boxes]."""


class SceneArrays(NamedTuple):
    """A home, compiled; made by :class:`roomba.world.camera.scene.scene.Scene`.

    In parts: a kernel's arguments are passed one by one, and each kernel gets only what it reads.
    """

    surfaces: Surfaces
    lighting: Lighting
    walls: WallGrid
    floor: FloorSurfaces
    boxes: Boxes


class Ray(NamedTuple):
    """Where a camera, or a column of its picture, looks along the floor.

    At the depth t along the optical axis it is at ``(x + t dx, y + t dy)``, m in the map frame. The
    optical axis itself has a direction of length 1.
    """

    x: float
    y: float
    dx: float
    dy: float


class FloorDirt(NamedTuple):
    """The dirt on the floor."""

    micrograms: NDArray[np.int32]
    """[rows, columns]: in each cell."""
    place: NDArray[np.float64]
    """[3]: side of a cell, and x and y of the lower left corner, m in the map frame."""


class Spans(NamedTuple):
    """Room for what one picture column shows, in no order: runs of rows of one look each."""

    places: NDArray[np.int64]
    """[spans, 4]: first row, row after the last, surface, and one of the kinds below."""
    values: NDArray[np.float64]
    """[spans, 7], by kind.

    A face: depth; u and v in the first row, m; v's gain per row; m that a sample covers; light in
    the first row, 0..1, and its gain per row. A level plane: how far above or below the camera;
    u and v under the camera; their gain per depth; light in the first row, and its gain per row.
    """


FACE, TURNED_FACE, PLANE = np.int64(0), np.int64(1), np.int64(2)
"""Kinds of spans; on a turned face, the texture is turned by a right angle."""


class StripRow(NamedTuple):
    """Room for what is known of the floor in a row of a strip, [STRIP] each."""

    way_x: NDArray[np.float32]
    """Where a column looks, m in the map frame per metre of depth."""
    way_y: NDArray[np.float32]
    scale: NDArray[np.float32]
    """Texels per metre, of the halving of the texture that suits."""
    start: NDArray[np.int32]
    """First texel of that halving."""
    width: NDArray[np.int32]
    """Width of that halving, texels: a power of two."""
    base: NDArray[np.int32]
    """First of the surface's ``shaded`` colours."""
    shade: NDArray[np.int32]
    """Light, 0..SHADES - 1."""
    level: NDArray[np.int32]
    """Level of dirt."""
    dust: NDArray[np.int32]
    """Share of the floor that dust hides, 0..256."""
    veil: NDArray[np.uint32]
    """Colour of the dust."""
    place: NDArray[np.int32]
    """A texel of the floor, or of the pattern of crumbs."""
    block: NDArray[np.int32]
    """An entry of the table of the fewest crumbs."""
    colour: NDArray[np.uint32]
    """What is seen."""


class Workspace(NamedTuple):
    """Room to work in; nothing in it lasts from picture to picture."""

    hits: NDArray[np.float64]
    """[columns, 3]: depth of the wall, axis that it crosses, its room."""
    seen: NDArray[np.float64]
    """[boxes, 4]: distance, index, first and last column of a box in view."""
    spans: Spans
    colours: NDArray[np.uint32]
    """[STRIP, rows]."""
    depths: NDArray[np.float32]
    """[STRIP, rows], m."""
    tile: NDArray[np.uint32]
    """[rows, STRIP]: ``colours`` turned."""
    knots: NDArray[np.float32]
    """[edges of tiles, knots, 3]: light, level of dirt and veil of dust."""
    surfaces: NDArray[np.int64]
    """[tiles of a strip]: what the floor is made of."""
    row: StripRow


class ViewTables(NamedTuple):
    """The geometry of a picture of ``rows`` x ``columns`` samples; see the camera's module."""

    columns: int
    """Columns that are painted: a whole number of tiles, some of them past the right edge."""
    middle: float
    """Half the columns of the picture."""
    rows: int
    focal: float
    """Samples per unit of slope."""
    eye: float
    """Height of the camera above the floor, m."""
    reach: NDArray[np.float32]
    """[rows]: depth at which a row meets a level plane 1 m above or below the camera, m."""
    spread: NDArray[np.float32]
    """[rows]: size, m, of what a sample stands for on that plane."""
    floor_depth: NDArray[np.float32]
    """[rows]: depth of the floor and of nothing else; infinite above the horizon."""
    knots: NDArray[np.int32]
    """Rows of the floor between which light and dirt change evenly; the last one is ``rows``."""
    octave: NDArray[np.float32]
    """[rows]: base 2 logarithm of the size, m, of the floor that a sample stands for."""
    taps: NDArray[np.int32]
    """[rows]: samples along the ray that are averaged."""
    crispness: NDArray[np.float32]
    """[rows]: how much of a single crumb is still seen, 0..1."""
