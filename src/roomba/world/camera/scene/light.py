"""The light in a home, worked out once: daylight from windows, sun on the floor, soft shadows.

No light is traced. Corners, and the floor beside and below furniture, are darkened by distance: the
eye misses this first in a picture without it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats32
from roomba.grid import GridFrame
from roomba.raster.distance import distance_to_nearest
from roomba.world.home.home import Home
from roomba.world.home.raster import covered_cells, footprint

FINEST = 0.025
"""m; cells of the light's grids in a home of the usual size."""
MOST_CELLS = 1_000_000
EVENING = 0.94
"""Light in a room without windows; 1 is full light."""
DARKEST_CORNER = 0.82
"""Daylight in the farthest corner of a room with windows."""
SUN = (0.56, 0.83)
"""Direction in which the sun shines, in the plane of the map."""
SUN_SLOPE = 0.85
"""By how many metres a ray of the sun sinks per metre of way in the plane."""
INDIRECT = 0.82
"""Share of the light on the floor that is there without the sun."""
WINDOW_KIND = "window"


@dataclass(frozen=True, slots=True)
class Pane:
    """A window's glass: middle, half width, inward normal, m, and its heights."""

    x: float
    y: float
    half: float
    normal_x: float
    normal_y: float
    bottom: float
    top: float


@dataclass(frozen=True, slots=True, eq=False)
class Light:
    """Light on the floor and on what stands on it, uint8 grids of ``cell`` m, 255 full light."""

    floor: NDArray[np.uint8]
    air: NDArray[np.uint8]
    cell: float


def panes_of(home: Home) -> list[Pane]:
    """Return the glass of the home's windows; a window's front looks into its room."""
    panes = []
    for piece in home.furniture:
        if piece.kind != WINDOW_KIND:
            continue
        for box in piece.boxes:
            if box.material == "glass":
                normal = (math.cos(piece.pose.theta), math.sin(piece.pose.theta))
                along = abs(math.sin(box.theta - piece.pose.theta))
                half = 0.5 * (box.length * along + box.width * (1.0 - along))
                front = 0.5 * (box.length * (1.0 - along) + box.width * along)
                x, y = box.x + front * normal[0], box.y + front * normal[1]
                panes.append(Pane(x, y, half, *normal, box.bottom, box.top))
    return panes


def lit(home: Home, walls: NDArray[np.bool_], rooms: NDArray[np.uint8]) -> Light:
    """Return the light in a home; ``walls`` and ``rooms`` are grids over the map."""
    frame = _light_frame(home.frame)
    cells = np.ix_(
        np.arange(frame.rows) * walls.shape[0] // frame.rows,
        np.arange(frame.columns) * walls.shape[1] // frame.columns,
    )
    room = rooms[cells]
    cell = frame.resolution
    daylight = _daylight(home, frame, room)
    to_wall = distance_to_nearest(walls[cells]) * cell
    corners = 1.0 - 0.26 * np.exp(-to_wall / 0.10) - 0.14 * np.exp(-to_wall / 0.45)
    shadow = _shadows(home, frame)
    # What stands below or behind other things gets a little less light too, all of it evenly.
    around = _blurred(shadow, 0.25 / cell)
    air = daylight * (0.6 + 0.4 * np.clip(corners / 0.80, 0.0, 1.0)) * (0.82 + 0.18 * around)
    sun = _sunlight(home, frame, room) * shadow**2
    floor = (INDIRECT * daylight + (1.0 - INDIRECT) * sun) * corners * shadow
    return Light(_bytes(floor), _bytes(air), cell)


def _bytes(light: Floats32) -> NDArray[np.uint8]:
    return np.clip(light * 255.0 + 0.5, 0.0, 255.0).astype(np.uint8)


def _light_frame(frame: GridFrame) -> GridFrame:
    """Return a grid over the whole map, as fine as there is memory for."""
    width = frame.columns * frame.resolution
    height = frame.rows * frame.resolution
    cell = max(FINEST, math.sqrt(width * height / MOST_CELLS))
    columns, rows = max(1, round(width / cell)), max(1, round(height / cell))
    return GridFrame(cell, frame.origin_x, frame.origin_y, rows, columns)


def _centres(frame: GridFrame) -> tuple[Floats32, Floats32]:
    x, y = frame.centres()
    return x[None, :].astype(np.float32), y[:, None].astype(np.float32)


def _room_at(frame: GridFrame, room: NDArray[np.uint8], pane: Pane) -> int:
    row, column = frame.cell_of(pane.x + 0.2 * pane.normal_x, pane.y + 0.2 * pane.normal_y)
    row, column = min(max(row, 0), frame.rows - 1), min(max(column, 0), frame.columns - 1)
    return int(room[row, column])


def _daylight(home: Home, frame: GridFrame, room: NDArray[np.uint8]) -> Floats32:
    """Return the soft light: each room's windows, less with distance, spilling through doors."""
    panes = panes_of(home)
    x, y = _centres(frame)
    received = np.zeros(frame.shape, np.float32)
    for pane in panes:
        ahead = (x - pane.x) * pane.normal_x + (y - pane.y) * pane.normal_y
        squared = (x - pane.x) ** 2 + (y - pane.y) ** 2 + 0.6
        share = np.maximum(ahead, 0.0) * pane.half * 2.2 / squared
        received += np.where(room == _room_at(frame, room, pane), share, 0.0)
    light = np.full(frame.shape, EVENING, np.float32)
    for number in {_room_at(frame, room, pane) for pane in panes}:
        day = DARKEST_CORNER + (1.0 - DARKEST_CORNER) * (1.0 - np.exp(-1.1 * received))
        light = np.where(room == number, day, light)
    return _blurred(light, 0.25 / frame.resolution)


def _sunlight(home: Home, frame: GridFrame, room: NDArray[np.uint8]) -> Floats32:
    """Return where the sun falls through windows on the floor, 0..1."""
    x, y = _centres(frame)
    sun = np.zeros(frame.shape, np.float32)
    for pane in panes_of(home):
        inward = SUN[0] * pane.normal_x + SUN[1] * pane.normal_y
        if inward < 0.2:
            continue
        ahead = (x - pane.x) * pane.normal_x + (y - pane.y) * pane.normal_y
        way = np.maximum(ahead, 0.0) / inward
        height = way * SUN_SLOPE
        along = (y - pane.y - way * SUN[1]) * pane.normal_x
        along = along - (x - pane.x - way * SUN[0]) * pane.normal_y
        inside = (height > pane.bottom) & (height < pane.top)
        inside &= (np.abs(along) < pane.half) & (np.abs(along) > 0.035)
        inside &= room == _room_at(frame, room, pane)
        sun[inside] = 1.0
    return _blurred(sun, 0.03 / frame.resolution)


def _shadows(home: Home, frame: GridFrame) -> Floats32:
    """Return how much light furniture leaves on the floor: less below it and beside it."""
    light = np.ones(frame.shape, np.float32)
    boxes = [box for piece in home.furniture if piece.kind != WINDOW_KIND for box in piece.boxes]
    standing = covered_cells(frame, (footprint(box) for box in boxes if box.bottom < 0.05))
    gap = distance_to_nearest(standing) * frame.resolution
    light *= 1.0 - 0.34 * np.exp(-gap / 0.05) - 0.12 * np.exp(-gap / 0.22)
    for low, high, blur, depth in (
        (0.05, 0.20, 0.03, 0.56),
        (0.20, 0.50, 0.08, 0.46),
        (0.50, 0.90, 0.16, 0.26),
    ):
        over = covered_cells(frame, (footprint(box) for box in boxes if low <= box.bottom < high))
        if over.any():
            light *= 1.0 - depth * _blurred(over.astype(np.float32), blur / frame.resolution)
    return light


def _blurred(values: Floats32, sigma: float) -> Floats32:
    """Return a grid smoothed by a Gaussian of ``sigma`` cells."""
    reach = math.ceil(3.0 * sigma)
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1, dtype=np.float32) / sigma) ** 2)
    weights /= weights.sum()
    for _ in range(2):
        rows = values.shape[0]
        padded = np.pad(values, ((reach, reach), (0, 0)), mode="edge")
        values = np.zeros_like(values)
        for first, weight in enumerate(weights):
            values += weight * padded[first : first + rows]
        values = np.ascontiguousarray(values.T)
    return values
