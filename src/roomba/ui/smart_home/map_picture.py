"""The map as a PNG picture for a smart home's cameras; Valetudo's map is stored inside as well."""

from __future__ import annotations

import io
import math
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Final

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont
from PIL.PngImagePlugin import PngInfo

from roomba.client.floor_map import FloorMap
from roomba.client.view import GridLayer
from roomba.geometry import Point
from roomba.history.report.picture import COVERAGE_COLOURS, MAP_COLOURS

_AROUND: Final = 0.2
"""m around what is known."""
_LONGEST: Final = 1000
"""Pixels of the longer side at most."""
_MOST_SCALE: Final = 5
"""Pixels of a cell at most."""
_FLOOR: Final = (226, 222, 213)
_WAY, _ROOM, _NO_GO = (38, 84, 124), (120, 112, 100), (196, 50, 40)
_ROBOT, _STATION, _TEXT = (20, 60, 100), (30, 130, 80), (60, 54, 46)
_KEYWORD: Final = "ValetudoMap"
"""The keyword under which Valetudo's map card finds the map in the PNG."""


def picture_of(floor: FloorMap, valetudo: str = "") -> bytes:
    """Return the map as PNG, the highest y on top; ``valetudo`` is written into it."""
    drawing = _Drawing(floor)
    drawing.draw()
    words = PngInfo()
    if valetudo:
        words.add_text(_KEYWORD, valetudo, zip=True)
    packed = io.BytesIO()
    drawing.image.quantize(64).save(packed, "PNG", pnginfo=words)
    return packed.getvalue()


class _Drawing:
    """One picture, with places in m drawn at pixels."""

    def __init__(self, floor: FloorMap) -> None:
        self._floor = floor
        rows, columns = _known(floor.cells)
        self._rows, self._columns = rows, columns
        shown = max(rows.stop - rows.start, columns.stop - columns.start)
        self._scale = max(1, min(_MOST_SCALE, _LONGEST // shown))
        self._pixel = floor.cells.resolution / self._scale
        self._left = floor.cells.origin_x + columns.start * floor.cells.resolution
        self._top = floor.cells.origin_y + rows.stop * floor.cells.resolution
        self.image = Image.new("RGB", (1, 1))

    def draw(self) -> None:
        """Draw all, from the floor up."""
        self._draw_cells()
        pen = ImageDraw.Draw(self.image)
        for room in self._floor.home.rooms:
            for ring in room.rings:
                self._line(pen, (*ring, ring[0]), _ROOM, 1)
        self._line(pen, self._floor.way, _WAY, 2)
        for carpet in self._floor.home.felt_carpets:
            self._line(pen, (*carpet, carpet[0]), _ROOM, 1)
        for zone in self._floor.home.zones:
            closed, is_carpet = zone.kind != "wall", zone.kind == "carpet"
            line = (_ROOM, 1) if is_carpet else (_NO_GO, 3)
            self._line(pen, (*zone.points, *zone.points[: int(closed)]), *line)
        for room in self._floor.home.rooms:
            place = self._pixels([room.anchor])[0]
            pen.text(place, room.name, _TEXT, font=_font(), anchor="mm")
        self._draw_station(pen)
        self._draw_robot(pen)

    def _draw_cells(self) -> None:
        image = Image.new("RGB", (1, 1), _FLOOR)
        for layer, colours in (
            (self._floor.cells, MAP_COLOURS),
            (self._floor.coverage, COVERAGE_COLOURS),
        ):
            if layer is None or layer.cells.shape != self._floor.cells.cells.shape:
                continue
            palette = np.array(colours, np.uint8)
            cells = layer.cells[self._rows, self._columns][::-1]
            pixels = palette[np.minimum(cells, len(palette) - 1)]
            drawn = Image.fromarray(np.ascontiguousarray(pixels), "RGBA")
            if image.size != drawn.size:
                image = Image.new("RGB", drawn.size, _FLOOR)
            image.paste(drawn, mask=drawn)
        width, height = image.size
        size = width * self._scale, height * self._scale
        self.image = image.resize(size, Image.Resampling.NEAREST)

    def _draw_station(self, pen: ImageDraw.ImageDraw) -> None:
        x, y, theta = self._floor.home.station
        place = (x + 0.15 * math.cos(theta), y + 0.15 * math.sin(theta))
        ((across, down),) = self._pixels([place])
        side = 0.1 / self._pixel
        pen.rectangle((across - side, down - side, across + side, down + side), _STATION)

    def _draw_robot(self, pen: ImageDraw.ImageDraw) -> None:
        x, y, theta = self._floor.pose
        radius = self._floor.home.radius
        ((across, down),) = self._pixels([(x, y)])
        size = radius / self._pixel
        pen.ellipse((across - size, down - size, across + size, down + size), "white", _ROBOT, 2)
        front = (x + radius * math.cos(theta), y + radius * math.sin(theta))
        self._line(pen, ((x, y), front), _ROBOT, 3)

    def _line(
        self,
        pen: ImageDraw.ImageDraw,
        points: Iterable[Point],
        colour: tuple[int, int, int],
        width: int,
    ) -> None:
        pixels = self._pixels(points)
        if len(pixels) > 1:
            pen.line(pixels, colour, width, joint="curve")

    def _pixels(self, points: Iterable[Point]) -> list[tuple[float, float]]:
        return [((x - self._left) / self._pixel, (self._top - y) / self._pixel) for x, y in points]


def _known(layer: GridLayer) -> tuple[slice, slice]:
    """Return the rows and columns of the known cells and a margin; all cells if none is known."""
    found = []
    for axis, size in ((1, layer.cells.shape[0]), (0, layer.cells.shape[1])):
        known = np.flatnonzero(layer.cells.any(axis=axis))
        around = round(_AROUND / layer.resolution)
        low, high = (int(known[0]), int(known[-1]) + 1) if known.size else (0, size)
        found.append(slice(max(low - around, 0), min(high + around, size)))
    return found[0], found[1]


@cache
def _font() -> ImageFont.FreeTypeFont:
    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    return ImageFont.truetype(str(folder / "DejaVuSans.ttf"), 14)
