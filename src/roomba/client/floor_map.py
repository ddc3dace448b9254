"""The robot's floor at one moment, and as Valetudo's map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from roomba.client.view import GridLayer, HomeView, RoomView
from roomba.files.valetudo.home import ValetudoHome
from roomba.files.valetudo.writing import compose
from roomba.geometry import Point, Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap

_VALUES = np.array([UNKNOWN, FREE, OCCUPIED, OCCUPIED], np.int8)
"""Occupancy by the value of a cell in the layer of the map."""


@dataclass(frozen=True, slots=True, eq=False)
class FloorMap:
    """What a floor is drawn from, m.

    ``cells`` is the layer of the map, ``coverage`` that of the coverage if its grid lies alike,
    ``home`` what seldom changes, ``pose`` the robot's, and ``way`` the places that it came by.
    """

    cells: GridLayer
    coverage: GridLayer | None
    home: HomeView
    pose: tuple[float, float, float]
    way: Sequence[Point]


def valetudo_of(floor: FloorMap) -> dict[str, Any]:
    """Return Valetudo's map as plain values; raises ValetudoError for cells of half a cm."""
    cells, home = floor.cells, floor.home
    rows, columns = cells.cells.shape
    frame = GridFrame(cells.resolution, cells.origin_x, cells.origin_y, rows, columns)
    values = _VALUES[np.minimum(cells.cells, len(_VALUES) - 1)]
    zones = [(zone.kind, zone.points) for zone in home.zones]
    return compose(
        ValetudoHome(
            OccupancyMap(frame, values),
            tuple((room.name, _mask(room, cells)) for room in home.rooms),
            Pose(*home.station),
            tuple(points for kind, points in zones if kind == "no-go"),
            tuple(points for kind, points in zones if kind == "wall"),
            robot=Pose(*floor.pose),
            way=tuple(floor.way),
        )
    )


def _mask(room: RoomView, layer: GridLayer) -> NDArray[np.bool_]:
    """Return the cells of a room; its rings overlap where there are holes."""
    rows, columns = layer.cells.shape
    inside = np.zeros((rows, columns), np.bool_)
    for ring in room.rings:
        if len(ring) < 3:
            continue
        corners = (np.array(ring) - (layer.origin_x, layer.origin_y)) / layer.resolution - 0.5
        left, bottom = np.clip(np.floor(corners.min(axis=0)), 0, None).astype(int).tolist()
        right, top = np.minimum(np.ceil(corners.max(axis=0)) + 1, (columns, rows)).astype(int)
        if left < right and bottom < top:
            # Only the bounds of the room are drawn: a large map has many rooms.
            drawn = Image.new("1", (right - left, top - bottom))
            ImageDraw.Draw(drawn).polygon((corners - (left, bottom)).ravel().tolist(), fill=1)
            inside[bottom:top, left:right] ^= np.asarray(drawn)
    return inside
