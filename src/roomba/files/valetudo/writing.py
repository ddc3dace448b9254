"""Homes are written as maps of Valetudo."""

from __future__ import annotations

import json
import math
import uuid
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.files.valetudo.home import CM, VERSION, ValetudoError, ValetudoHome
from roomba.geometry import Point
from roomba.grid import FREE, OCCUPIED

_NAMES: Final = uuid.UUID("6f1c1a3e-2f0a-4f57-9d52-6a1f5d0b7c11")


def compose(home: ValetudoHome) -> dict[str, Any]:
    """Return a home as plain values of the format; raises ValetudoError for cells not of whole cm.

    Places are rounded to whole cm, the station's heading to whole degrees.
    """
    frame, values = home.occupancy.frame, home.occupancy.values
    pixel = round(frame.resolution / CM)
    if pixel < 1 or abs(pixel * CM - frame.resolution) > 1e-9:
        raise ValetudoError(
            f"expected a map with cells of whole cm, got {frame.resolution} m; map it again with "
            "cells of 0.05 m"
        )
    left = values == FREE
    layers = []
    for number, (name, mask) in enumerate(home.rooms, start=1):
        mask = mask & left
        left &= ~mask
        meta = {"segmentId": str(number), "name": name, "active": False}
        layers.append(_layer("segment", mask, pixel, meta))
    layers.insert(0, _layer("floor", left, pixel, {}))
    layers.append(_layer("wall", values == OCCUPIED, pixel, {}))
    told = [layer for layer in layers if layer["dimensions"]["pixelCount"]]
    entities = _entities(home)
    content = json.dumps([told, entities], sort_keys=True)
    return {
        "__class": "ValetudoMap",
        "metaData": {
            "version": VERSION,
            "nonce": str(uuid.uuid5(_NAMES, content)),
            "origin": [frame.origin_x, frame.origin_y],
        },
        "size": {"x": frame.columns * pixel, "y": frame.rows * pixel},
        "pixelSize": pixel,
        "layers": told,
        "entities": entities,
    }


def _layer(kind: str, mask: Mask, pixel: int, meta: dict[str, Any]) -> dict[str, Any]:
    # Of its bounds alone: a large map has many rooms.
    top, bottom = _bounds(mask.any(axis=1)[::-1])
    left, right = _bounds(mask.any(axis=0))
    above = mask[::-1][top:bottom, left:right]
    edges = np.diff(np.pad(above, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    y, x = np.nonzero(edges == 1)
    count = np.nonzero(edges == -1)[1] - x
    rows, columns = np.nonzero(above)
    x, y, rows, columns = x + left, y + top, rows + top, columns + left
    return {
        "__class": "MapLayer",
        "metaData": {**meta, "area": len(rows) * pixel * pixel},
        "type": kind,
        "pixels": [],
        "compressedPixels": np.column_stack((x, y, count)).ravel().tolist(),
        "dimensions": {
            "x": _dimension(columns),
            "y": _dimension(rows),
            "pixelCount": len(rows),
        },
    }


def _bounds(told: NDArray[np.bool_]) -> tuple[int, int]:
    """Return the index of the first True and the one after the last; (0, 0) if there is none."""
    found = np.flatnonzero(told)
    return (int(found[0]), int(found[-1]) + 1) if found.size else (0, 0)


def _dimension(cells: NDArray[np.int64]) -> dict[str, int]:
    if not cells.size:
        return {"min": 0, "max": 0, "mid": 0, "avg": 0}
    least, most = int(cells.min()), int(cells.max())
    middle, mean = math.floor((least + most) / 2.0 + 0.5), math.floor(float(cells.mean()) + 0.5)
    return {"min": least, "max": most, "mid": middle, "avg": mean}


def _entities(home: ValetudoHome) -> list[dict[str, Any]]:
    entities = []
    robot = home.station if home.robot is None else home.robot
    for pose, name in ((robot, "robot_position"), (home.station, "charger_location")):
        if pose is not None:
            degrees = round(90.0 - math.degrees(pose.theta)) % 360
            place = _points(home, ((pose.x, pose.y),))
            entities.append(_entity("PointMapEntity", name, place, {"angle": degrees}))
    for kind, name, shapes in (
        ("PathMapEntity", "path", (home.way,) if len(home.way) > 1 else ()),
        ("PolygonMapEntity", "no_go_area", home.no_go),
        ("LineMapEntity", "virtual_wall", home.walls),
    ):
        entities += [_entity(kind, name, _points(home, shape), {}) for shape in shapes]
    return entities


def _entity(kind: str, name: str, points: list[int], meta: dict[str, Any]) -> dict[str, Any]:
    return {"__class": kind, "metaData": meta, "points": points, "type": name}


def _points(home: ValetudoHome, points: tuple[Point, ...]) -> list[int]:
    frame = home.occupancy.frame
    top = frame.origin_y + frame.rows * frame.resolution
    return [round(value / CM) for x, y in points for value in (x - frame.origin_x, top - y)]
