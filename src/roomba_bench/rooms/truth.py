"""Floors whose rooms are known, and how well a segmentation agrees with them.

Scored as in Bormann et al., "Room Segmentation: Survey, Implementation, and Analysis" (2016). Both
means forgive rooms that were not parted (a segment that swallows another room costs that segment's
precision alone), so it is also counted how many rooms were told apart.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.files.home_layer import list_homes
from roomba.files.image import read_image
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import HOMES
from roomba.grid import OccupancyMap
from roomba.raster.regions import numbered_regions
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home

RoomLabels = NDArray[np.signedinteger[Any]]

_SUFFIX = "_rooms.png"
_WHITE = 250.0
"""Grey value; darker lines divide rooms."""
_SMALLEST = 1.0
"""m²; smaller white areas are specks of the scan."""
_SAME = 0.8
"""Share of their union that a room and its segment must have in common to count as told apart."""


@dataclass(frozen=True, eq=False)
class KnownRooms:
    """A map and its true rooms: int [rows, columns], 0 for none, 1 .. ``count``."""

    name: str
    map: OccupancyMap
    labels: RoomLabels

    @property
    def count(self) -> int:
        """How many true rooms there are."""
        return int(self.labels.max(initial=0))

    @property
    def area(self) -> float:
        """Free floor of the map, m²."""
        return float(np.count_nonzero(~self.map.solid)) * self.map.frame.resolution**2


@dataclass(frozen=True)
class Score:
    """Mean recall and precision, 0..1; how many segments there are, and rooms told apart."""

    recall: float
    precision: float
    segments: int
    told_apart: int


def known_homes() -> Iterable[KnownRooms]:
    """Return the shipped homes that have rooms in their layer."""
    homes = (load_home(name, HOMES) for name in list_homes(HOMES))
    return (KnownRooms(home.name, home.map, rooms_of(home)) for home in homes if home.rooms)


def known_maps(folder: Path) -> Iterable[KnownRooms]:
    """Return the maps of a folder beside which there is ``<map>_rooms.png``, sorted by name.

    The picture has the map's size. Rooms are white areas that people divided by dark lines. In a
    picture without white, each grey value is a room, as in a robot vacuum's app, and black is no
    room.
    """
    for path in sorted(folder.glob(f"*{_SUFFIX}")):
        name = path.name.removesuffix(_SUFFIX)
        map = load_map(folder / f"{name}.yaml")
        grey = np.ascontiguousarray(read_image(path).grey[::-1])
        if grey.shape != map.frame.shape:
            raise ValueError(f"{path}: expected a picture of {map.frame.shape}, got {grey.shape}")
        white = grey > _WHITE
        drawn = without_specks(white, map.frame.resolution) if white.any() else _numbered(grey)
        yield KnownRooms(name, map, drawn)


def _numbered(grey: NDArray[Any]) -> RoomLabels:
    """Return the rooms of a picture with a grey value for each room; 0 is no room."""
    values, numbers = np.unique(grey, return_inverse=True)
    labels: RoomLabels = (numbers.reshape(grey.shape) + int(values[0] > 0)).astype(np.int32)
    return labels


def rooms_of(home: Home) -> RoomLabels:
    """Return the rooms of a home's layer, by the middles of cells."""
    frame = home.frame
    x = frame.origin_x + (np.arange(frame.columns) + 0.5) * frame.resolution
    y = frame.origin_y + (np.arange(frame.rows) + 0.5) * frame.resolution
    labels = np.zeros(frame.shape, np.int32)
    for label, room in enumerate(home.rooms, 1):
        labels[shapely.contains_xy(shapely.Polygon(room.outline), x[None, :], y[:, None])] = label
    return labels


def without_specks(white: NDArray[np.bool_], resolution: float) -> RoomLabels:
    """Return the connected areas of a mask that are as large as a room."""
    regions = numbered_regions(white)
    sizes = np.bincount(regions.ravel()) * resolution**2
    is_room = sizes >= _SMALLEST
    is_room[0] = False
    labels: RoomLabels = np.where(is_room, np.cumsum(is_room), 0)[regions]
    return labels


def overlaps(known: KnownRooms, labels: RoomLabels) -> NDArray[np.int64]:
    """Return the cells that rooms (rows) and segments (columns) have in common; 0 is no segment.

    Only cells count that are free in the map and lie in a true room, so the first row is 0.
    """
    counted = (known.labels > 0) & ~known.map.solid
    shape = (known.count + 1, int(labels.max(initial=0)) + 1)
    common = np.zeros(shape, np.int64)
    np.add.at(common, (known.labels[counted], labels[counted]), 1)
    return common


def score(known: KnownRooms, labels: RoomLabels) -> Score:
    """Return how well labels, int [rows, columns], 0 for no room, agree with the true rooms."""
    common = overlaps(known, labels)
    rooms, segments = common.sum(axis=1), common.sum(axis=0)
    inner = common[1:, 1:]
    union = rooms[1:, None] + segments[None, 1:] - inner
    seen = segments[1:] > 0
    recall = inner.max(axis=1, initial=0) / np.maximum(rooms[1:], 1)
    precision = inner.max(axis=0, initial=0)[seen] / segments[1:][seen]
    told_apart = (inner >= _SAME * np.maximum(union, 1)).any(axis=1)
    return Score(
        float(recall[rooms[1:] > 0].mean()) if rooms.any() else 0.0,
        float(precision.mean()) if precision.size else 0.0,
        int(np.count_nonzero(seen)),
        int(np.count_nonzero(told_apart)),
    )
