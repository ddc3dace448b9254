"""Cuts the floor of a map into rooms, as a person would: at doorways."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.configuration.rooms import RoomsConfig
from roomba.grid import UNKNOWN, OccupancyMap
from roomba.perception.rooms.doorways import clearance_of, doorways
from roomba.perception.rooms.floor_kernels import (
    border_counts,
    clear_small_things,
    connected_parts,
    contacts,
    draw_line,
    grow,
)
from roomba.raster.regions import numbered_regions

Labels = NDArray[np.int32]
Counts = NDArray[np.int64] | np.int64


def room_labels(occupancy: OccupancyMap, config: RoomsConfig) -> NDArray[np.int16]:
    """Return the rooms of a map, int16 [rows, columns]: 0 for no room, 1 is the largest."""
    resolution = occupancy.frame.resolution
    solid = _walls(occupancy, config)
    labels = _parted(solid, resolution, config)
    labels = _without_small(labels, resolution, config)
    labels = _without_outdoors(labels, occupancy, config)
    labels[occupancy.solid] = 0
    return _connected_by_size(labels, resolution, config)


def _walls(occupancy: OccupancyMap, config: RoomsConfig) -> Mask:
    """Return the solid cells, without small things that stand free, and with a solid border."""
    solid = occupancy.solid
    clear_small_things(solid, round(config.furniture_size / occupancy.frame.resolution))
    solid[[0, -1]] = solid[:, [0, -1]] = True
    return solid


def _parted(solid: Mask, resolution: float, config: RoomsConfig) -> Labels:
    """Return the pieces of the floor between walls and doorways, numbered from 1."""
    wide = clearance_of(solid) * resolution >= config.tightest_passage / 2.0
    closed = np.zeros(solid.shape, np.bool_)
    for door in doorways(solid, resolution, config):
        draw_line(closed, door.row, door.column, door.to_row, door.to_column)
    labels = numbered_regions(wide & ~closed)
    grow(labels, ~solid, round(config.reach / resolution))
    return labels


def _without_small(labels: Labels, resolution: float, config: RoomsConfig) -> Labels:
    """Give each small piece, the smallest first, to the neighbour with the widest opening."""
    areas = np.bincount(labels.ravel()).astype(np.float64) * resolution**2
    widths: dict[tuple[int, int], int] = {}
    touching = contacts(labels)
    for first, second in touching[:, :2].tolist():
        widths[first, second] = widths.get((first, second), 0) + 1
    owner = np.arange(areas.size)
    small = {label for pair in widths for label in pair if areas[label] < config.smallest_room}
    while small:
        label = min(small, key=lambda piece: (areas[piece], piece))
        small.discard(label)
        sides = {pair: width for pair, width in widths.items() if label in pair}
        if not sides:
            continue
        _, widest = max((width, pair) for pair, width in sides.items())
        into = sum(widest) - label
        owner[owner == label] = into
        areas[into] += areas[label]
        for (first, second), width in sides.items():
            del widths[first, second]
            other = first + second - label
            if other != into:
                pair = min(into, other), max(into, other)
                widths[pair] = widths.get(pair, 0) + width
        if areas[into] >= config.smallest_room:
            small.discard(into)
    return owner[labels].astype(np.int32)


def _without_outdoors(labels: Labels, occupancy: OccupancyMap, config: RoomsConfig) -> Labels:
    """Drop pieces that end at unknown cells and not at walls, unless the map is mostly so."""
    to_unknown, to_known = border_counts(
        labels, occupancy.values == UNKNOWN, int(labels.max(initial=0))
    )
    if _is_mostly(to_unknown.sum(), to_known.sum(), config):
        return labels
    is_outdoors = _is_mostly(to_unknown, to_known, config)
    is_outdoors[0] = False
    return np.where(is_outdoors[labels], 0, labels).astype(np.int32)


def _is_mostly(unknown: Counts, known: Counts, config: RoomsConfig) -> Mask:
    """Return whether borders are mostly towards unknown cells, from counts of sides of cells."""
    return np.asarray(unknown > config.most_unknown * (unknown + known))


def _connected_by_size(labels: Labels, resolution: float, config: RoomsConfig) -> NDArray[np.int16]:
    """Return the largest connected part of each label, if it is a room, numbered by its area."""
    parts = connected_parts(labels)
    sizes = np.bincount(parts.ravel())
    label_of = np.zeros(sizes.size, np.int32)
    label_of[parts.ravel()] = labels.ravel()
    numbers = np.zeros(sizes.size, np.int16)
    taken = {0}
    for part in np.argsort(-sizes, kind="stable").tolist():
        label = int(label_of[part])
        if label not in taken and sizes[part] * resolution**2 >= config.smallest_room:
            numbers[part] = len(taken)
            taken.add(label)
    return numbers[parts]
