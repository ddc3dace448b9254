"""Finds a place for the charging station in a home that names none."""

from __future__ import annotations

import math

import numpy as np

from roomba.errors import HomeError
from roomba.geometry import Pose
from roomba.grid import OCCUPIED, OccupancyMap
from roomba.world.catalogue.furniture import STATION_GAP, STATION_WIDTH
from roomba.world.home.raster import Mask, largest_component, where_body_fits

CLEARANCE = 0.03
"""m; wanted around the docked body."""
PLATE_DEPTH = 0.03
"""m; the thinnest station that there is room for between nose and wall."""
APPROACH = 1.0
"""m; of straight way to the station that is wanted."""

_STEPS = ((0, 1), (1, 0), (0, -1), (-1, 0))
"""One cell (rows, columns) to the east, north, west and south."""


def automatic_station(occupancy: OccupancyMap, solid: Mask, body_radius: float) -> Pose:
    """Return a docked pose in the largest floor on which the body fits, m and rad in the map frame.

    Wanted is a straight wall before the nose and a metre of free way behind; failing that a wall,
    failing that any place. Among equals the nearest to the map's zero is taken, since that is where
    mapping robots start, and they start from their station. Raises :class:`HomeError` if the body
    fits nowhere.
    """
    frame = occupancy.frame
    floor = largest_component(where_body_fits(frame, solid, body_radius + CLEARANCE))
    if not floor.any():
        raise HomeError(
            f"expected floor on which a body of {body_radius:.3f} m radius fits, got none; "
            "check the map's resolution and thresholds"
        )
    reach = body_radius + STATION_GAP + PLATE_DEPTH
    ahead = math.ceil(reach / frame.resolution + 0.5)
    wall = occupancy.values == OCCUPIED
    walled = [floor & _wall_ahead(wall, step, ahead, frame.resolution) for step in _STEPS]
    back = range(1, math.ceil(APPROACH / frame.resolution) + 1)
    spacious = [
        places & np.logical_and.reduce([_shifted(floor, _times(step, -n)) for n in back])
        for places, step in zip(walled, _STEPS, strict=True)
    ]
    for choices in (spacious, walled, [floor]):
        pose = _nearest_to_zero(occupancy, choices)
        if pose is not None:
            return pose
    raise AssertionError("the floor has a cell, so a place was found")


def _wall_ahead(wall: Mask, step: tuple[int, int], ahead: int, resolution: float) -> Mask:
    """Return the cells that have, ``ahead`` cells before them, wall as wide as the station."""
    half = math.ceil(STATION_WIDTH / 2.0 / resolution - 0.5)
    across = (step[1], -step[0])
    ahead_is_wall = np.logical_and.reduce(
        [
            _shifted(wall, (ahead * step[0] + j * across[0], ahead * step[1] + j * across[1]))
            for j in range(-half, half + 1)
        ]
    )
    return np.asarray(ahead_is_wall)


def _times(step: tuple[int, int], factor: int) -> tuple[int, int]:
    return step[0] * factor, step[1] * factor


def _shifted(mask: Mask, offset: tuple[int, int]) -> Mask:
    """Return for every cell what the mask says ``offset`` (rows, columns) away; outside, no."""
    result = np.zeros_like(mask)
    rows, columns = mask.shape
    down, right = offset
    if abs(down) >= rows or abs(right) >= columns:
        return result
    target = (
        slice(max(-down, 0), rows - max(down, 0)),
        slice(max(-right, 0), columns - max(right, 0)),
    )
    source = (
        slice(max(down, 0), rows - max(-down, 0)),
        slice(max(right, 0), columns - max(-right, 0)),
    )
    result[target] = mask[source]
    return result


def _nearest_to_zero(occupancy: OccupancyMap, choices: list[Mask]) -> Pose | None:
    """Return the pose of the chosen cell nearest to (0, 0), heading as its list's place says."""
    frame = occupancy.frame
    best: tuple[float, Pose] | None = None
    for direction, mask in enumerate(choices):
        rows, columns = np.nonzero(mask)
        if rows.size == 0:
            continue
        x, y = frame.centres(rows, columns)
        distances = np.hypot(x, y)
        index = int(np.argmin(distances))
        theta = (0.0, math.pi / 2.0, math.pi, -math.pi / 2.0)[direction]
        if best is None or distances[index] < best[0] - 1e-9:
            best = float(distances[index]), Pose(float(x[index]), float(y[index]), theta)
    return None if best is None else best[1]
