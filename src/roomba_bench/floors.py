"""The floors that are measured on: solid cells as bool [rows, columns], True is wall.

The same arrays, saved as files, are what peers get.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import HOMES
from roomba.grid import GridFrame

Cell = tuple[int, int]

_ROOM = 100
"""Cells from one wall of a building to the next: 5 m of 5 cm cells."""
_DOOR = 18
_WALL = 2
_DOOR_SHARE = 0.8
_BLOCKS_PER_ROOM = 4


@dataclass(frozen=True, eq=False)
class Floor:
    """A named floor, ``solid`` in ``frame``."""

    name: str
    solid: Mask
    frame: GridFrame


def apartment() -> Floor:
    """Return the reference: 10 x 10 m, five rooms with furniture, 5 cm cells."""
    return floor_of_map(HOMES / "apartment" / "map.yaml", "apartment")


def floor_of_map(path: Path, name: str | None = None) -> Floor:
    """Return the floor of a map_server map."""
    occupancy = load_map(path)
    return Floor(name or path.stem, occupancy.solid, occupancy.frame)


def floors_of_folder(folder: Path) -> Iterable[Floor]:
    """Return the floor of each map_server map in a folder, sorted by name."""
    return (floor_of_map(path, f"map {path.stem}") for path in sorted(folder.glob("*.yaml")))


def building(size: int, seed: int = 0) -> Mask:
    """Return a building of ``size`` x ``size`` cells: a lattice of rooms with doors and clutter."""
    random = np.random.default_rng(seed)
    solid = np.zeros((size, size), np.bool_)
    solid[[0, -1]] = solid[:, [0, -1]] = True
    for wall in range(_ROOM, size, _ROOM):
        solid[wall : wall + _WALL] = solid[:, wall : wall + _WALL] = True
    for room in range(0, size, _ROOM):
        for wall in range(_ROOM, size, _ROOM):
            for grid in (solid, solid.T):
                if random.random() < _DOOR_SHARE:
                    door = room + int(random.integers(10, _ROOM - _DOOR - 12))
                    grid[door : door + _DOOR, wall : wall + _WALL] = False
    for _ in range((size // _ROOM) ** 2 * _BLOCKS_PER_ROOM):
        row, column = random.integers(0, size - 30, 2)
        height, width = random.integers(4, 30, 2)
        solid[row : row + height, column : column + width] = True
    return solid


def room_for(floor: Floor, radius: float) -> Mask:
    """Return the cells whose centre is ``radius`` m or more away from everything solid."""
    free = (~floor.solid).astype(np.uint8)
    distance = cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    room: Mask = distance * floor.frame.resolution >= radius
    return room


def far_corners(fits: Mask) -> tuple[Cell, Cell]:
    """Return the two cells of the largest connected floor that are nearest to opposite corners."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(
        fits.astype(np.uint8), connectivity=4
    )
    if count < 2:
        raise ValueError("expected a map with free floor")
    largest = 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))
    rows, columns = np.nonzero(labels == largest)
    ends = [int(np.argmin(rows + columns)), int(np.argmax(rows + columns))]
    first, last = ((int(rows[end]), int(columns[end])) for end in ends)
    return first, last


def free_poses(floor: Floor, count: int, room: float = 0.25, seed: int = 1) -> NDArray[np.float64]:
    """Return poses (x, y, theta) on the floor, float64 [count, 3], ``room`` m from all walls.

    They lie well inside cells, since a ray along a line of the grid has more than one right range.
    """
    random = np.random.default_rng(seed)
    rows, columns = np.nonzero(room_for(floor, room))
    chosen = random.integers(0, len(rows), count)
    beside = random.uniform(0.2, 0.8, (2, count))
    frame = floor.frame
    return np.column_stack(
        [
            frame.origin_x + (columns[chosen] + beside[0]) * frame.resolution,
            frame.origin_y + (rows[chosen] + beside[1]) * frame.resolution,
            random.uniform(-np.pi, np.pi, count),
        ]
    )
