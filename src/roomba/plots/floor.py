"""The floor of a plan: boards, tiles and carpets, and the dirt on them."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from roomba.grid import GridFrame
from roomba.plots.canvas import WHITE, Canvas, Picture, mixed
from roomba.world.home.home import Home
from roomba.world.home.materials import MATERIALS, Material

PALENESS = 0.42
"""0..1; share of white in a floor, so that furniture and names stand out from it."""
DIRT_COLOUR = (104, 76, 44)
DIRT_HALF = 1.5
"""g/m²; this much dirt hides half of what the most dirt hides on a plan."""

Field = NDArray[np.float64]


def draw_floor(canvas: Canvas, home: Home) -> None:
    """Fill free floor, and each room with its material's pattern."""
    base = MATERIALS["concrete"]
    free = upscaled(canvas, home.frame, home.map.values >= 0)
    canvas.blend(mixed(base.rgb, WHITE, 0.7), free)
    for room in home.rooms:
        mask = canvas.mask()
        canvas.fill_mask(mask, room.outline)
        canvas.blend(_pattern_of(canvas, MATERIALS[room.floor]), mask)


def draw_carpets(canvas: Canvas, home: Home) -> None:
    """Fill carpets, with a border woven into each."""
    for carpet in home.carpets:
        area = carpet.area
        material = MATERIALS[carpet.material]
        mask = canvas.mask()
        canvas.fill_mask(mask, _corners(area.x_min, area.y_min, area.x_max, area.y_max))
        canvas.blend(_pattern_of(canvas, material), mask)
        inset = min(0.08, (area.x_max - area.x_min) / 6.0, (area.y_max - area.y_min) / 6.0)
        dark = mixed(mixed(material.rgb, WHITE, PALENESS), (0, 0, 0), 0.14)
        for distance, width in ((0.0, 0.012), (inset, 0.02)):
            corners = _corners(
                area.x_min + distance,
                area.y_min + distance,
                area.x_max - distance,
                area.y_max - distance,
            )
            canvas.line(corners, dark, width, closed=True)


def draw_dirt(
    canvas: Canvas, frame: GridFrame, dirt: NDArray[np.float64] | NDArray[np.float32]
) -> None:
    """Lay a brown veil with specks over the floor; ``dirt`` is g/m² [rows, columns]."""
    amount = np.maximum(upscaled_field(canvas, frame, np.asarray(dirt, np.float32)), 0.0)
    hidden = 1.0 - np.exp2(-amount / DIRT_HALF)
    veil = 110.0 * hidden
    noise = np.random.default_rng(0).random(amount.shape, dtype=np.float32)
    specks = cv2.GaussianBlur((noise < 0.02 * hidden).astype(np.float32), (0, 0), 0.8) * 620.0
    mask = np.clip(veil + specks, 0.0, 215.0).astype(np.uint8)
    canvas.blend(DIRT_COLOUR, mask)


def upscaled(canvas: Canvas, frame: GridFrame, cells: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return a mask of the canvas, 255 where the cells are set."""
    return (upscaled_field(canvas, frame, cells.astype(np.float32), sharp=True) * 255.0).astype(
        np.uint8
    )


def upscaled_field(
    canvas: Canvas, frame: GridFrame, field: NDArray[np.float32], sharp: bool = False
) -> NDArray[np.float32]:
    """Return a field [rows, columns] at every pixel of the canvas; 0 outside of its grid."""
    x, y = canvas.metres()
    columns = ((x - frame.origin_x) / frame.resolution - 0.5).astype(np.float32)
    rows = ((y - frame.origin_y) / frame.resolution - 0.5).astype(np.float32)
    at_columns, at_rows = np.meshgrid(columns, rows)
    how = cv2.INTER_NEAREST if sharp else cv2.INTER_LINEAR
    border = cv2.BORDER_CONSTANT
    return np.asarray(
        cv2.remap(field, at_columns, at_rows, how, borderMode=border, borderValue=0.0), np.float32
    )


def _pattern_of(canvas: Canvas, material: Material) -> Callable[[Field, Field], Picture]:
    """Return what paints a material: its pale colour times the brightness of its pattern."""
    colour = np.array(mixed(material.rgb, WHITE, PALENESS), np.float32)
    pattern = _PATTERNS.get(material.texture, _plain)

    def paint(x: Field, y: Field) -> Picture:
        brightness = pattern(x[None, :], y[:, None], 1.0 / canvas.scale).astype(np.float32)
        shades = colour[None, None, :] * brightness[..., None]
        return np.clip(np.rint(shades), 0, 255).astype(np.uint8)

    return paint


def _plain(x: Field, y: Field, pixel: float) -> Field:
    return np.ones(np.broadcast(x, y).shape)


def _boards(x: Field, y: Field, pixel: float) -> Field:
    """Boards along x, 14 cm wide and 1.4 m long, each row shifted, each board of its own shade."""
    row = np.floor(y / 0.14)
    shift = 1.4 * _chance(row, 0.0 * row)
    board = np.floor((x + shift) / 1.4)
    shade = 0.965 + 0.06 * _chance(row + 0.0 * board, board)
    seam = _near_line(y, 0.14, pixel) | _near_line(x + shift, 1.4, pixel)
    return np.asarray(np.where(seam, shade * 0.93, shade))


def _tiles(size: float, joint: float) -> Callable[[Field, Field, float], Field]:
    def pattern(x: Field, y: Field, pixel: float) -> Field:
        column, row = np.floor(x / size), np.floor(y / size)
        shade = 0.98 + 0.03 * _chance(row + 0.0 * column, column + 0.0 * row)
        seam = _near_line(x, size, pixel) | _near_line(y, size, pixel)
        return np.asarray(np.where(seam, joint, shade))

    return pattern


def _weave(x: Field, y: Field, pixel: float) -> Field:
    return 0.97 + 0.05 * _chance(np.floor(y / 0.02), np.floor(x / 0.02))


_PATTERNS: dict[str, Callable[[Field, Field, float], Field]] = {
    "wood": _boards,
    "tile": _tiles(0.3, 0.92),
    "stone": _tiles(0.6, 0.94),
    "fabric": _weave,
}


def _near_line(value: Field, spacing: float, pixel: float) -> NDArray[np.bool_]:
    """Whether a coordinate is on a joint: 8 mm wide, but two drawn pixels at least."""
    width = max(0.008, 2.0 * pixel)
    return np.asarray((value % spacing < width) & (spacing > 12.0 * pixel))


def _chance(row: Field, column: Field) -> Field:
    """Return a fixed number 0..1 for every pair of whole numbers, as good as random to the eye."""
    wave = np.sin(row * 12.9898 + column * 78.233) * 43758.5453
    return np.asarray(wave - np.floor(wave))


def _corners(x_min: float, y_min: float, x_max: float, y_max: float) -> list[tuple[float, float]]:
    return [(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max)]
