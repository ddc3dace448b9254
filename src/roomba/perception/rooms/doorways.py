"""Finds doorways: narrow places of the floor where a wall ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.configuration.rooms import RoomsConfig
from roomba.perception.rooms.doorway_kernels import flood_basins, gaps, opening_at, wall_thicknesses
from roomba.perception.rooms.floor_kernels import contacts, draw_line
from roomba.raster.distance import distance_to_nearest


@dataclass(frozen=True, slots=True)
class Opening:
    """A narrow place: the solid cells at its ends, and the clear ``width`` between them, m."""

    row: int
    column: int
    to_row: int
    to_column: int
    width: float


def clearance_of(solid: Mask) -> NDArray[np.float32]:
    """Return how far each cell's middle is from the nearest solid cell's side, in cells."""
    return distance_to_nearest(solid) - np.float32(0.5)


def doorways(solid: Mask, resolution: float, config: RoomsConfig) -> list[Opening]:
    """Return the doorways of a floor, ``solid`` bool [rows, columns] with a solid border.

    First come gaps between the ends of two walls that are as wide as a door. With these closed,
    openings that narrow the floor follow.
    """
    doors = _doors(solid, resolution, config)
    closed = solid.copy()
    for door in doors:
        draw_line(closed, door.row, door.column, door.to_row, door.to_column)
    return doors + _narrow_places(closed, resolution, config)


def _doors(solid: Mask, resolution: float, config: RoomsConfig) -> list[Opening]:
    """Return gaps between the ends of two walls.

    Of gaps that cross each other or lie side by side, the one whose walls are thinnest is kept: it
    runs along the walls, and not from one of them to furniture near the door.
    """
    thickest = _cells_through(config.thickest_wall, resolution)
    found = gaps(
        solid,
        config.narrowest_door / resolution - 0.5,
        config.widest_door / resolution + 0.5,
        thickest,
        config.jamb / resolution,
    )
    widths = np.hypot(found[:, 2] - found[:, 0], found[:, 3] - found[:, 1]) - 1.0
    order = np.lexsort((widths, found[:, 4]))
    middles = (found[:, 0:2] + found[:, 2:4]) / 2.0
    doors = []
    while order.size:
        first = order[0]
        row, column, to_row, to_column = found[first, :4].tolist()
        doors.append(Opening(row, column, to_row, to_column, float(widths[first]) * resolution))
        away = np.hypot(*(middles[order] - middles[first]).T)
        order = order[away > max(widths[first] / 2.0, thickest)]
    return doors


def _narrow_places(solid: Mask, resolution: float, config: RoomsConfig) -> list[Opening]:
    """Return openings that narrow the floor and are doorways.

    The floor is flooded from its widest places outwards. Where two basins meet is a narrow place: a
    saddle of the distance to the walls (a watershed).
    """
    clearance = clearance_of(solid)
    cells = np.flatnonzero(clearance * resolution >= config.tightest_passage / 2.0)
    order = cells[np.argsort(-clearance.ravel()[cells], kind="stable")]
    basins = np.zeros(solid.shape, np.int32)
    peaks = flood_basins(order, clearance, config.roughness / resolution, basins)
    found = []
    for first, second, row, column in _saddles(contacts(basins), clearance):
        ends = opening_at(solid, row, column, float(clearance[row, column]))
        if ends[0] < 0:
            continue
        width = (math.hypot(ends[2] - ends[0], ends[3] - ends[1]) - 1.0) * resolution
        share = width / (2.0 * resolution * float(min(peaks[first], peaks[second])))
        if _is_doorway(solid, ends, width, share, resolution, config):
            found.append(Opening(*ends, width))
    return found


def _is_doorway(
    solid: Mask,
    ends: tuple[int, int, int, int],
    width: float,
    share: float,
    resolution: float,
    config: RoomsConfig,
) -> bool:
    """Return whether a narrow place is a doorway: it lies between walls, beside one, or is deep.

    ``ends`` are the rows and columns of the solid cells at its sides, ``width`` is in m; ``share``
    is the width relative to that of the floor on the narrower side.
    """
    if width < config.narrowest_door:
        return False
    look = _cells_through(config.deepest_passage, resolution)
    thickest = _cells_through(config.thickest_wall, resolution)
    walls = wall_thicknesses(solid, *ends, look, config.jamb / resolution)
    is_door = width <= config.widest_door
    if max(walls) <= thickest:
        is_double_door = width <= config.widest_double_door
        return share <= (config.door_to_corridor if is_double_door else config.narrowing)
    if min(walls) <= thickest and is_door:
        return share <= config.door_to_corridor
    return min(walls) <= look and is_door and share <= config.deep_narrowing


def _saddles(
    touching: NDArray[np.int32], clearance: NDArray[np.float32]
) -> list[tuple[int, int, int, int]]:
    """Return the two regions of each opening, and the row and column of its widest place."""
    widest = -clearance[touching[:, 2], touching[:, 3]]
    order = np.lexsort((np.arange(len(touching)), widest, touching[:, 4]))
    _, first = np.unique(touching[order, 4], return_index=True)
    return [tuple(touching[order[index], :4].tolist()) for index in first]


def _cells_through(thickness: float, resolution: float) -> int:
    """Return a thickness, m, in cells, and one more: it is measured in steps of whole cells."""
    return round(thickness / resolution) + 1
