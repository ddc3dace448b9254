"""Floors with additional furniture at random places, but not in doorways."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.grid import OCCUPIED, OccupancyMap
from roomba.raster.distance import distance_to_nearest
from roomba_bench.rooms.truth import KnownRooms

_AREA = 8.0
"""m² of floor for each piece."""
_DEPTHS, _LENGTHS = (0.3, 1.0), (0.4, 2.0)
"""m; from chairs and shelves to tables and beds."""
_DOORSTEP = 0.8
"""m; nearer to another room no furniture is put."""
_TRIES = 4
"""Attempts for each piece of furniture; some do not fit."""


def furnished(known: KnownRooms, seed: int) -> KnownRooms:
    """Return the floor with boxes on it, each inside of one room, turned by 0 or 90 degrees."""
    random = np.random.default_rng(seed)
    resolution = known.map.frame.resolution
    values = known.map.values.copy()
    doorstep = _near_other_rooms(known)
    rows, columns = np.nonzero((known.labels > 0) & ~known.map.solid)
    wanted = int(rows.size * resolution**2 / _AREA)
    for _ in range(wanted * _TRIES):
        if wanted == 0:
            break
        place = random.integers(rows.size)
        sizes = [int(random.uniform(*sides) / resolution) for sides in (_DEPTHS, _LENGTHS)]
        height, width = sizes if random.random() < 0.5 else sizes[::-1]
        box = np.s_[rows[place] : rows[place] + height, columns[place] : columns[place] + width]
        rooms = set(known.labels[box].ravel().tolist()) - {0}
        if len(rooms) == 1 and not doorstep[box].any():
            values[box] = np.where(known.map.solid[box], values[box], OCCUPIED)
            wanted -= 1
    return KnownRooms(known.name, OccupancyMap(known.map.frame, values), known.labels)


def _near_other_rooms(known: KnownRooms) -> NDArray[np.bool_]:
    """Return the cells near free floor that lies on the border of its room."""
    free = ~known.map.solid
    border = np.zeros(free.shape, np.bool_)
    for axis in (0, 1):
        other = np.roll(known.labels, 1, axis) != known.labels
        border |= other & free & np.roll(free, 1, axis)
    near: NDArray[np.bool_] = distance_to_nearest(border) * known.map.frame.resolution < _DOORSTEP
    return near
