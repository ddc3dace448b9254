"""Fitting a map's rooms, with a person's edits, to the map after furniture was moved."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.grid import FREE, OccupancyMap
from roomba.perception.rooms.floor_kernels import connected_parts, grow
from roomba.perception.rooms.rooms import Rooms

_REACH: Final = 1.5
"""m; floor that became free up to so far from a room joins it: more than furniture is deep."""


def refitted(rooms: Rooms, before: OccupancyMap, after: OccupancyMap) -> Rooms:
    """Return the rooms of the map ``before`` on the map ``after``, of the same frame.

    Floor that became free goes to the room beside it. Of a room that is in parts now only the
    largest part is kept, and a room without floor is dropped.
    """
    free = after.values == FREE
    labels = np.where(free, rooms.labels, 0).astype(np.int32)
    grow(labels, free & (before.values != FREE), round(_REACH / after.frame.resolution))
    whole = _largest_parts(labels)
    kept = np.unique(whole[whole > 0])
    numbers = np.zeros(len(rooms.names) + 1, np.int16)
    numbers[kept] = np.arange(1, len(kept) + 1)
    names = tuple(rooms.names[label - 1] for label in kept.tolist())
    return Rooms(after.frame, numbers[whole], names)


def _largest_parts(labels: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return labels with only the largest connected part of each."""
    parts = connected_parts(labels)
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    largest = [
        int(np.argmax(np.where(np.isin(np.arange(sizes.size), parts[labels == label]), sizes, 0)))
        for label in np.unique(labels[labels > 0]).tolist()
    ]
    return np.where(np.isin(parts, largest), labels, 0).astype(np.int32)
