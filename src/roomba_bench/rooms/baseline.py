"""The simple way to find rooms: floor far from all walls, grown back to the walls."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.rooms import RoomsConfig
from roomba.grid import OccupancyMap
from roomba.perception.rooms.floor_kernels import clear_small_things, grow
from roomba.raster.distance import distance_to_nearest
from roomba.raster.regions import numbered_regions


def distance_split(occupancy: OccupancyMap) -> NDArray[np.int32]:
    """Return rooms, int32 [rows, columns], 0 for none: connected floor out of reach of doors.

    In a door, the distance from the walls is at most half the door's width. The baseline gets the
    same floor without small furniture and the same sizes as our segmentation.
    """
    config, resolution = RoomsConfig(), occupancy.frame.resolution
    solid = occupancy.solid
    clear_small_things(solid, round(config.furniture_size / resolution))
    solid[[0, -1]] = solid[:, [0, -1]] = True
    seeds = distance_to_nearest(solid) * resolution > config.widest_door / 2.0
    labels = numbered_regions(seeds)
    grow(labels, ~solid, labels.size)
    labels[occupancy.solid] = 0
    return labels
