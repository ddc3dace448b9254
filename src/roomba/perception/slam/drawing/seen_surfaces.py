"""The part of a drawn map that was really seen: connected floor, and the cells beside it.

A range that is measured too long draws a cell behind the wall that its beam met, and floor before
that cell. No correct beam ends there or passes through.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.grid import FREE, UNKNOWN, OccupancyMap
from roomba.raster.regions import dilated, large_regions

_AROUND: Final = np.ones((3, 3), np.bool_)
"""A cell, and those that meet it at a side or a corner."""


def only_seen(map: OccupancyMap, least_floor: float) -> OccupancyMap:
    """Return a map in which all that lies behind surfaces is unknown.

    Kept are free cells that are connected, over sides or corners, to ``least_floor`` m2 or more,
    and occupied cells beside such floor. (The cells of one beam are connected in this way.) If
    there is no such floor, the map is returned as it is.
    """
    floor = large_regions(map.values == FREE, map.frame.resolution, least_floor, by_corners=True)
    if not floor.any():
        return map
    is_seen = dilated(floor, _AROUND)
    return OccupancyMap(map.frame, np.where(is_seen, map.values, np.int8(UNKNOWN)))
