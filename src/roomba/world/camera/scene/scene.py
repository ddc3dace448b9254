"""A home as the camera sees it: everything compiled into flat arrays, once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from roomba.geometry import Pose
from roomba.grid import UNKNOWN
from roomba.raster.distance import distance_to_nearest
from roomba.world.camera.scene.arrays import (
    GREYS,
    SHADES,
    Boxes,
    FloorSurfaces,
    Lighting,
    SceneArrays,
    Surfaces,
    WallGrid,
)
from roomba.world.camera.scene.doors import door_boxes
from roomba.world.camera.scene.free_walls import free_wall_boxes
from roomba.world.camera.scene.light import WINDOW_KIND, lit
from roomba.world.camera.scene.moving import (
    DISC_MATERIAL,
    MovingBoxes,
    box_shapes,
    no_discs,
)
from roomba.world.camera.scene.texture_atlas import atlas, in_every_light, palette
from roomba.world.engine.state.arrays import MOST_DISCS
from roomba.world.home.crumbs import CRUMB_COLOURS, DUST, crumbs
from roomba.world.home.home import Box, Home, MovingThing, Rectangle
from roomba.world.home.materials import MATERIALS, Material

FLOOR_TEXTURES = {"wood": "planks", "tile": "tiles", "fabric": "pile"}
FACE_TEXTURES = {"tile": "wall_tiles", "fabric": "weave"}
"""Textures of floors, and of faces, for materials whose texture is drawn by another name."""
GLOWING = frozenset({"station_light"})
UNKNOWN_MATERIAL = Material(170, 168, 165, "plain")
"""For a material that is in no catalogue, such as that of a home made in a test."""
WALL_TINTS = (
    (236, 230, 218),
    (238, 226, 204),
    (214, 224, 212),
    (212, 222, 232),
    (240, 222, 214),
    (226, 222, 234),
)
"""Paint of walls outside rooms, then of one room after the other."""
WALL_TILES = (228, 232, 232)
FINEST_FLOOR = 0.01
"""m; cells in which the floor's look is kept in a home of the usual size."""
MOST_FLOOR_CELLS = 4_000_000
CARPET_BORDER = 0.06


@dataclass(slots=True)
class _Looks:
    """Numbers the looks of surfaces, a texture in a palette each, as they are first asked for."""

    textures: list[str] = field(default_factory=list)
    palettes: list[NDArray[np.uint32]] = field(default_factory=list)
    glows: list[bool] = field(default_factory=list)
    numbers: dict[tuple[str, tuple[int, int, int], bool], int] = field(default_factory=dict)

    def number(self, texture: str, rgb: tuple[int, int, int], glow: bool = False) -> int:
        key = (texture, rgb, glow)
        if key not in self.numbers:
            self.numbers[key] = len(self.textures)
            self.textures.append(texture)
            self.palettes.append(palette(rgb, texture))
            self.glows.append(glow)
        return self.numbers[key]

    def face(self, name: str) -> int:
        material = MATERIALS.get(name, UNKNOWN_MATERIAL)
        texture = FACE_TEXTURES.get(material.texture, material.texture)
        return self.number(texture, material.rgb, name in GLOWING)

    def floor(self, name: str, brightness: float = 1.0) -> int:
        material = MATERIALS.get(name, UNKNOWN_MATERIAL)
        red, green, blue = (round(channel * brightness) for channel in material.rgb)
        texture = FLOOR_TEXTURES.get(material.texture, material.texture)
        return self.number(texture, (red, green, blue))


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A compiled home; make it with :meth:`of`."""

    arrays: SceneArrays
    moving: MovingBoxes
    axes: Pose | None = None
    """Where the axes of ``arrays`` lie in the frame in which poses are told, if they are turned."""

    def boxes(self) -> Boxes:
        """Return the boxes as they stand at first, with shapes of their own that may be changed."""
        return self.arrays.boxes._replace(shapes=self.arrays.boxes.shapes.copy())

    @staticmethod
    def of(home: Home) -> Scene:
        """Compile a home: under half a second for a flat."""
        if home.turned is not None:
            return replace(Scene.of(home.exact), axes=home.axes)
        frame = home.frame
        # The floor's surfaces come first: its grid keeps their numbers in bytes.
        looks = _Looks()
        floor, floor_cell = _floor(home, looks)
        walls = _walls(home)
        rooms = _rooms(home)
        light = lit(home, walls, rooms)
        fixed = [
            *_furniture_boxes(home),
            *((box, False) for box in door_boxes(home, walls)),
            *((box, False) for box in free_wall_boxes(home)),
        ]
        moving = MovingBoxes.of(home.moving, len(fixed))
        boxes = [*fixed, *((box, False) for thing in home.moving for box in thing.boxes)]
        numbers = [
            looks.number("view", (255, 255, 255), True) if is_pane else looks.face(box.material)
            for box, is_pane in boxes
        ]
        numbers += [looks.face(DISC_MATERIAL)] * MOST_DISCS
        shapes = np.concatenate([box_shapes(box for box, _ in boxes), no_discs()])
        moving.place_things(shapes, _first_poses(home.moving))
        wall_surfaces = _wall_surfaces(home, looks)
        skirting, ceiling = looks.face("skirting"), looks.face("ceiling")
        names = tuple(dict.fromkeys(looks.textures))
        drawn = atlas(names)
        pattern = crumbs()
        levels = pattern.astype(np.uint8)
        palettes = np.stack(looks.palettes)
        crumb_colours = _crumb_colours()
        cover = np.searchsorted(np.sort(levels, axis=None), np.arange(256), "right") / levels.size
        return Scene(
            SceneArrays(
                Surfaces(
                    texture=np.array([names.index(n) for n in looks.textures], np.int32),
                    palettes=palettes,
                    shaded=in_every_light(palettes[:, 2 :: 256 // GREYS], SHADES).ravel(),
                    glows=np.array(looks.glows, np.bool_),
                    texels=drawn.texels,
                    offsets=drawn.offsets,
                    bits=drawn.bits,
                    scale=drawn.scale,
                    octave=np.log2(drawn.scale),
                ),
                Lighting(frame.origin_x, frame.origin_y, light.cell, light.floor, light.air),
                WallGrid(
                    frame.origin_x,
                    frame.origin_y,
                    frame.resolution,
                    home.wall_height,
                    skip=_skips(walls),
                    rooms=np.pad(rooms, 1),
                    surfaces=wall_surfaces,
                    skirting=skirting,
                    ceiling=ceiling,
                ),
                FloorSurfaces(
                    frame.origin_x,
                    frame.origin_y,
                    floor_cell,
                    surfaces=floor,
                    crumbs=pattern.ravel(),
                    fewest=levels.reshape(128, 8, 128, 8).min(axis=(1, 3)).ravel(),
                    colours=crumb_colours,
                    cover=cover.astype(np.float32),
                    shaded=in_every_light(
                        np.append(crumb_colours, np.uint32(DUST))[:, None], SHADES
                    ).ravel(),
                ),
                Boxes(shapes, np.array(numbers, np.int32)),
            ),
            moving,
        )


def _walls(home: Home) -> NDArray[np.bool_]:
    """Return what stands up to the ceiling; unknown cells count as walls."""
    walls: NDArray[np.bool_] = home.walls | (home.map.values == UNKNOWN)
    for door in home.doors:
        walls[_cells(home, door.opening)] = False
    return walls


def _cells(home: Home, area: Rectangle) -> tuple[slice, slice]:
    """Return the cells whose centres are within a rectangle."""
    frame = home.frame
    low_row, low_column = frame.cell_of(
        area.x_min + 0.5 * frame.resolution - 1e-6, area.y_min + 0.5 * frame.resolution - 1e-6
    )
    high_row, high_column = frame.cell_of(
        area.x_max + 0.5 * frame.resolution - 1e-6, area.y_max + 0.5 * frame.resolution - 1e-6
    )
    return (
        slice(max(0, low_row), max(0, high_row)),
        slice(max(0, low_column), max(0, high_column)),
    )


def _skips(walls: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return for each cell, with a border of wall, a distance in cells to all walls, up to 255.

    No wall is nearer than that along either axis. It is up to a third less than it could be where
    the nearest wall is straight ahead.
    """
    away = distance_to_nearest(np.pad(walls, 1, constant_values=True))
    # A little less than sqrt(0.5): rounding must not add a cell.
    return np.asarray(np.minimum(np.ceil(0.7071 * away), 255.0), np.uint8)


def _rooms(home: Home) -> NDArray[np.uint8]:
    """Return each cell's room, counted from 1."""
    numbers = range(1, 1 + len(home.rooms[:254]))
    return _by_room(home, home.frame.shape, home.frame.resolution, numbers, 0)


def _by_room(
    home: Home, shape: tuple[int, int], cell: float, values: Sequence[int], elsewhere: int
) -> NDArray[np.uint8]:
    """Return a grid over the map in cells of ``cell`` m with a value for each room."""
    picture = Image.new("L", shape[::-1], elsewhere)
    draw = ImageDraw.Draw(picture)
    for room, value in zip(home.rooms, values, strict=False):
        corners = np.array(room.outline) - (home.frame.origin_x, home.frame.origin_y)
        draw.polygon(np.round(corners / cell - 0.5).ravel().tolist(), fill=value)
    return np.array(picture)


def _wall_surfaces(home: Home, looks: _Looks) -> NDArray[np.int32]:
    found = [(looks.number("plain", WALL_TINTS[0]), -1)]
    for number, room in enumerate(home.rooms[:254]):
        tint = WALL_TINTS[1 + number % (len(WALL_TINTS) - 1)]
        tiled = MATERIALS.get(room.floor, UNKNOWN_MATERIAL).texture == "tile"
        tiles = looks.number("wall_tiles", WALL_TILES) if tiled else -1
        found.append((looks.number("plain", tint), tiles))
    return np.array(found, np.int32)


def _floor(home: Home, looks: _Looks) -> tuple[NDArray[np.uint8], float]:
    """Return the surface of every floor cell, and the cell's size, m."""
    frame = home.frame
    width, height = frame.columns * frame.resolution, frame.rows * frame.resolution
    cell = max(FINEST_FLOOR, math.sqrt(width * height / MOST_FLOOR_CELLS))
    shape = max(1, math.ceil(height / cell)), max(1, math.ceil(width / cell))
    elsewhere = looks.floor("oak" if home.rooms else "concrete")
    surfaces = [looks.floor(room.floor) for room in home.rooms]
    floor = _by_room(home, shape, cell, surfaces, elsewhere)

    def lay(area: Rectangle, inset: float, surface: int) -> None:
        low = [area.x_min - frame.origin_x + inset, area.y_min - frame.origin_y + inset]
        high = [area.x_max - frame.origin_x - inset, area.y_max - frame.origin_y - inset]
        left, bottom = (max(0, round(place / cell)) for place in low)
        right, top = (max(0, round(place / cell)) for place in high)
        floor[bottom:top, left:right] = surface

    for carpet in home.carpets:
        lay(carpet.area, 0.0, looks.floor(carpet.material, 0.72))
        lay(carpet.area, CARPET_BORDER, looks.floor(carpet.material))
        lay(carpet.area, 1.5 * CARPET_BORDER, looks.floor(carpet.material, 0.84))
        lay(carpet.area, 1.8 * CARPET_BORDER, looks.floor(carpet.material))
    for stairs in home.stairs:
        lay(stairs, 0.0, looks.floor("stairs", 0.25))
    return floor, cell


def _furniture_boxes(home: Home) -> list[tuple[Box, bool]]:
    """Return all boxes, and for each whether it is a window's pane."""
    return [
        (box, piece.kind == WINDOW_KIND and box.material == "glass")
        for piece in home.furniture
        for box in piece.boxes
    ]


def _first_poses(things: Iterable[MovingThing]) -> NDArray[np.float64]:
    rows = [
        (thing.pose.x, thing.pose.y, thing.pose.theta, float(thing.is_present)) for thing in things
    ]
    return np.array(rows, np.float64).reshape(-1, 4)


def _crumb_colours() -> NDArray[np.uint32]:
    """Return each crumb colour in shade and in light, as 0x00BBGGRR."""
    shades = np.repeat(np.array(CRUMB_COLOURS, np.float32), 2, axis=0)
    shades[0::2] *= 0.62
    red, green, blue = np.clip(shades, 0.0, 255.0).astype(np.uint32).T
    packed: NDArray[np.uint32] = red | (green << np.uint32(8)) | (blue << np.uint32(16))
    return packed
