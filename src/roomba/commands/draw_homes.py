"""Draws the maps of the homes whose layer names their walls: map.yaml and its picture.

Run it after a change of a ``home.yaml``: ``./roomba exec python -m roomba.commands.draw_homes
[--homes FOLDER]``. A map shows what a robot that had mapped the home would know: walls with open
doors, and mapped furniture at its body's height. What is no wall and in no room is unknown.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import cv2
import numpy as np
import shapely

from roomba.configuration.body import BodyConfig
from roomba.files.home_layer import LAYER_NAME, MAP_NAME, WallEntry, read_layer
from roomba.files.occupancy_map import save_map
from roomba.files.shipped import HOMES
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.world.catalogue.things import LOW_KINDS
from roomba.world.home.free_wall import touched_cells
from roomba.world.home.home import Rectangle
from roomba.world.home.raster import covered_cells, outline
from roomba.world.layers.assembly import standing_cells
from roomba.world.layers.parts import parts_of

DRAWN = {
    "flat": 0.05,
    "studio": 0.05,
    "family": 0.05,
    "bay": 0.05,
    "loft": 0.05,
    "cottage": 0.05,
    "hall": 0.2,
}
"""Homes with the cell size of their map, m; the hall's is coarse since it is 200 m wide."""
MARGIN = {"hall": 0}
"""Cells of unknown around the outer walls, if not :data:`_USUAL_MARGIN`."""
_USUAL_MARGIN = 2
PICTURES = {"hall"}
"""Homes whose map is a PNG, which keeps a million equal pixels small."""


def drawn_map(name: str, homes: Path) -> OccupancyMap:
    """Return the map of a home of :data:`DRAWN` as its layer describes it."""
    layer, file = read_layer(homes / name / LAYER_NAME)
    assert layer.walls is not None, f"{file.path} names no walls"
    bounds = [_bounds(wall, DRAWN[name]) for wall in layer.walls]
    frame = _frame_around(bounds, DRAWN[name], MARGIN.get(name, _USUAL_MARGIN))
    parts = parts_of(layer, file, frame)
    assert parts.walls is not None, "the layer names walls"
    walls = parts.walls.areas
    free = [wall for wall in parts.walls.free if wall.on_map]
    values = np.full(frame.shape, UNKNOWN, np.int8)
    values[covered_cells(frame, (shapely.Polygon(room.outline) for room in parts.rooms))] = FREE
    values[covered_cells(frame, (outline(wall) for wall in walls))] = OCCUPIED
    values[covered_cells(frame, (outline(door.opening) for door in parts.doors))] = FREE
    values[touched_cells(frame, free)] = OCCUPIED
    pieces = (*parts.furniture, *parts.moved)
    mapped = (piece for piece in pieces if piece.on_map and piece.kind not in LOW_KINDS)
    values[standing_cells(frame, mapped, BodyConfig().height)] = OCCUPIED
    return OccupancyMap(frame, values)


def _bounds(wall: WallEntry, resolution: float) -> Rectangle:
    """Return the bounds of a wall; a wall that is off the grid is grown to whole cells."""
    if wall.area is not None:
        return Rectangle(*wall.area)
    reach = 0.5 * (wall.thickness or 0.0)
    points = np.array(wall.line if wall.arc is None else [wall.arc.centre], np.float64)
    reach += 0.0 if wall.arc is None else wall.arc.radius
    low = np.floor((points.min(axis=0) - reach) / resolution + 1e-6) * resolution
    high = np.ceil((points.max(axis=0) + reach) / resolution - 1e-6) * resolution
    return Rectangle(*low.tolist(), *high.tolist())


def _frame_around(walls: list[Rectangle], resolution: float, margin: int) -> GridFrame:
    x_min = min(wall.x_min for wall in walls)
    y_min = min(wall.y_min for wall in walls)
    columns = round((max(wall.x_max for wall in walls) - x_min) / resolution) + 2 * margin
    rows = round((max(wall.y_max for wall in walls) - y_min) / resolution) + 2 * margin
    # Multiples of 0.05 have rounding errors as floats; the file shall show tidy numbers.
    decimals = 1 - math.floor(math.log10(resolution))
    return GridFrame(
        resolution,
        round(x_min - margin * resolution, decimals),
        round(y_min - margin * resolution, decimals),
        rows,
        columns,
    )


def draw(name: str, homes: Path) -> None:
    """Write the map of one home."""
    path = homes / name / MAP_NAME
    save_map(drawn_map(name, homes), path)
    if name in PICTURES:
        drawing = path.with_suffix(".pgm")
        pixels = cv2.imread(str(drawing), cv2.IMREAD_UNCHANGED)
        cv2.imwrite(str(path.with_suffix(".png")), pixels, [cv2.IMWRITE_PNG_COMPRESSION, 9])
        drawing.unlink()
        text = path.read_text(encoding="utf-8").replace(drawing.name, path.with_suffix(".png").name)
        path.write_text(text, encoding="utf-8")


def main() -> None:
    """Draw them all."""
    parser = argparse.ArgumentParser(description="Draw the maps of the shipped homes.")
    parser.add_argument("--homes", type=Path, default=HOMES)
    homes = parser.parse_args().homes
    for name in DRAWN:
        draw(name, homes)
        print(f"{homes / name / MAP_NAME}: drawn")


if __name__ == "__main__":
    main()
