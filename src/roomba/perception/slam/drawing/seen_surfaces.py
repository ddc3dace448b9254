"""What of a drawn map was seen: floor that hangs together, and what borders on it.

A range that is told too long draws a cell behind the wall that it met, and floor before that cell.
No beam that is right ends there, and none passes through.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.grid import FREE, UNKNOWN, OccupancyMap
from roomba.raster.regions import dilated, large_regions

_AROUND: Final = np.ones((3, 3), np.bool_)
"""A cell, and those that meet it at a side or a corner."""


def only_seen(map: OccupancyMap, least_floor: float) -> OccupancyMap:
    """Return a map without what lies behind surfaces: it is unknown there.

    Free cells stay that hang together, over sides or corners, with ``least_floor`` m2 or more, as
    the cells of a beam do, and occupied ones beside such floor. Without any of it all stays.
    """
    floor = large_regions(map.values == FREE, map.frame.resolution, least_floor, by_corners=True)
    if not floor.any():
        return map
    is_seen = dilated(floor, _AROUND)
    return OccupancyMap(map.frame, np.where(is_seen, map.values, np.int8(UNKNOWN)))
