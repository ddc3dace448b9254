"""Finds a place for the charging station in a home that names none."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from roomba.arrays import Mask
from roomba.errors import HomeError
from roomba.geometry import Pose
from roomba.grid import OCCUPIED, OccupancyMap
from roomba.world.catalogue.furniture import STATION_GAP, STATION_WIDTH
from roomba.world.home.raster import where_body_fits, with_neighbours
from roomba.world.layers.paper import off_paper

CLEARANCE = 0.03
"""m; wanted around the docked body."""
PLATE_DEPTH = 0.03
"""m; the thinnest station that there is room for between nose and wall."""
APPROACHES = (1.0, 0.7, 0.45)
"""m; of straight way to the station, the best first; with the last it can just leave it."""

Place = tuple[float, Mask]
"""A heading, rad, and the cells on which the robot may be docked so."""

_ALONG_AXES: Final = 4
_ALL_AROUND: Final = 16
"""Headings from east on that are tried: those along the map's axes first."""


def automatic_station(
    occupancy: OccupancyMap, solid: Mask, body_radius: float, paper: Mask | None = None
) -> Pose:
    """Return a docked pose in the largest floor on which the body fits, m and rad in the map frame.

    The best place has a straight wall before the nose and a metre of free way behind, along the
    map's axes; the next best have less way, then no wall; then any place will do. Of equal places
    the nearest to the map's zero is taken: mapping robots start there, and they start from their
    station. Floor that reaches the end of the ``paper``, if any, is taken only if there is no other
    (:mod:`roomba.world.layers.paper`). Raises :class:`HomeError` if the body fits nowhere.
    """
    frame = occupancy.frame
    end = np.zeros(frame.shape, np.bool_) if paper is None else paper
    for clearance in (CLEARANCE, 0.0):
        around = body_radius + clearance
        fits = where_body_fits(frame, solid, around)
        floor = off_paper(fits, end, around + 2.0 * frame.resolution, frame.resolution)
        if floor.any():
            break
    if not floor.any():
        raise HomeError(
            f"expected floor on which a body of {body_radius:.3f} m radius fits, got none; "
            "check the map's resolution, thresholds, negate and mode"
        )
    reach = body_radius + STATION_GAP + PLATE_DEPTH
    for choices in _choices(occupancy, floor, reach):
        pose = _nearest_to_zero(occupancy, choices)
        if pose is not None:
            return pose
    raise AssertionError("the floor has a cell, so a place was found")


def _choices(occupancy: OccupancyMap, floor: Mask, reach: float) -> Iterator[list[Place]]:
    """Yield places to choose from, the best ones first; a wall is ``reach``, m, before the nose."""
    resolution, wall = occupancy.frame.resolution, occupancy.values == OCCUPIED
    axes, around = _headings(_ALONG_AXES), _headings(_ALL_AROUND)
    # Walls aslant are steps, and some have a seam of unknown cells.
    thick = with_neighbours(wall)
    walled = [(theta, floor & _wall_ahead(wall, theta, reach, resolution)) for theta in axes]
    aslant = [(theta, floor & _wall_ahead(thick, theta, reach, resolution)) for theta in around]
    anywhere = [(theta, floor) for theta in around]
    for approach in APPROACHES:
        for places in (walled, aslant):
            yield _with_way_behind(places, floor, approach, resolution)
    for approach in APPROACHES:
        yield _with_way_behind(anywhere, floor, approach, resolution)
    yield walled
    yield [(0.0, floor)]


def _headings(count: int) -> list[float]:
    return [math.remainder(math.tau * number / count, math.tau) for number in range(count)]


def _wall_ahead(wall: Mask, theta: float, reach: float, resolution: float) -> Mask:
    """Return the cells that have, ``reach``, m, before them, wall as wide as the station."""
    ahead = math.ceil(reach / resolution + 0.5)
    half = math.ceil(STATION_WIDTH / 2.0 / resolution - 0.5)
    places = [_shifted(wall, _cells(theta, ahead, aside)) for aside in range(-half, half + 1)]
    return np.asarray(np.logical_and.reduce(places))


def _with_way_behind(
    places: list[Place], floor: Mask, approach: float, resolution: float
) -> list[Place]:
    """Return those of the places that have ``approach``, m, of floor behind them."""
    return [
        (theta, cells & _way_behind(floor, theta, approach, resolution)) for theta, cells in places
    ]


def _way_behind(floor: Mask, theta: float, approach: float, resolution: float) -> Mask:
    """Return the cells that have ``approach``, m, of floor behind them."""
    back = range(1, math.ceil(approach / resolution) + 1)
    return np.asarray(np.logical_and.reduce([_shifted(floor, _cells(theta, -n, 0)) for n in back]))


def _cells(theta: float, ahead: int, aside: int) -> tuple[int, int]:
    """Return (rows, columns) to what lies ``ahead`` and ``aside`` cells off, for a heading, rad."""
    cosine, sine = math.cos(theta), math.sin(theta)
    return round(ahead * sine + aside * cosine), round(ahead * cosine - aside * sine)


def _shifted(mask: Mask, offset: tuple[int, int]) -> Mask:
    """Return for every cell what the mask says ``offset`` (rows, columns) away; False outside."""
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


def _nearest_to_zero(occupancy: OccupancyMap, choices: list[Place]) -> Pose | None:
    """Return the pose of the chosen cell nearest to (0, 0), with its heading."""
    frame = occupancy.frame
    best: tuple[float, Pose] | None = None
    for theta, mask in choices:
        rows, columns = np.nonzero(mask)
        if rows.size == 0:
            continue
        x, y = frame.centres(rows, columns)
        distances = np.hypot(x, y)
        index = int(np.argmin(distances))
        if best is None or distances[index] < best[0] - 1e-9:
            best = float(distances[index]), Pose(float(x[index]), float(y[index]), theta)
    return None if best is None else best[1]
