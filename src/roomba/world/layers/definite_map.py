"""Makes the map of a file definite: each cell is floor or keeps the body out.

Maps of map_server tell how likely a cell is occupied, or how much of it is, leave specks unknown
that no beam went through, may end in the middle of free floor, and may be pictures many times as
large as what they show. A simulated world has none of this, and its robot is given the very map of
which the world is made.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.grid import FREE, MOST_CELLS, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.raster.regions import dilated, large_regions, numbered_regions

SPECK: Final = 0.01
"""m²; an unknown spot of up to this size, with free floor all around it, is floor as well."""
SPOT: Final = 0.3
"""m²; smaller unknown spots that are no specks become solid on the map: a robot would take them
for floor that no beam happened to pass (:mod:`roomba.perception.matching.surface_field`)."""
FENCE: Final = 0.1
"""m; thickness of a wall where a map ends: what a lidar sees a little too far lies in it."""
MARGIN: Final = 1.0
"""m; so wide an unknown border is kept around what is known: it is as solid as all outside."""
_COARSE: Final = 0.2
"""m; of cells larger than this a robot does not know well enough where their walls are."""
_SPLIT: Final = 0.1
"""m; such cells are split into cells of this size at most."""
_HARDLY: Final = 10
"""%; a cell that is less likely solid, or to a smaller part, is as good as unknown."""
_AROUND: Final = np.ones((3, 3), np.bool_)
"""A cell and those over its sides and corners."""


def with_small_cells(map: OccupancyMap) -> OccupancyMap:
    """Return a map of the same floor whose cells are no larger than a robot can do with.

    Cells above 0.2 m are split into smaller ones of the same value, as small as MOST_CELLS allows;
    other maps stay what they are.
    """
    frame = map.frame
    if frame.resolution <= _COARSE + 1e-9:
        return map
    most = math.isqrt(MOST_CELLS // map.values.size)
    parts = max(1, min(math.ceil(frame.resolution / _SPLIT - 1e-9), most))
    values = np.repeat(np.repeat(map.values, parts, axis=0), parts, axis=1)
    size = frame.resolution / parts
    return OccupancyMap(GridFrame(size, frame.origin_x, frame.origin_y, *values.shape), values)


def definite_map(map: OccupancyMap) -> OccupancyMap:
    """Return a map of free, occupied and unknown cells whose floor has an end on every side."""
    return _with_solid_spots(_decided(_without_specks(_fenced(_cropped(map)))))


def _cropped(map: OccupancyMap) -> OccupancyMap:
    """Return what is known of a map, and a margin."""
    known, frame = map.values != UNKNOWN, map.frame
    if not known.any():
        return map
    margin = math.ceil(MARGIN / frame.resolution - 1e-9)
    rows, columns = (_around(known.any(axis=axis), margin) for axis in (1, 0))
    values = np.ascontiguousarray(map.values[rows, columns])
    around = GridFrame(
        frame.resolution,
        frame.origin_x + columns.start * frame.resolution,
        frame.origin_y + rows.start * frame.resolution,
        *values.shape,
    )
    return OccupancyMap(around, values)


def _around(known: NDArray[np.bool_], margin: int) -> slice:
    """Return where a row of cells is known, and a margin at both ends."""
    cells = np.flatnonzero(known)
    return slice(max(int(cells[0]) - margin, 0), int(cells[-1]) + 1 + margin)


def _decided(map: OccupancyMap) -> OccupancyMap:
    """Return a map in which what is neither free nor likely occupied is not known."""
    is_decided = (map.values <= FREE) | (map.values == OCCUPIED)
    decisions = np.where(map.likely_solid, np.int8(OCCUPIED), np.int8(UNKNOWN))
    return OccupancyMap(map.frame, np.where(is_decided, map.values, decisions))


def _with_solid_spots(map: OccupancyMap) -> OccupancyMap:
    """Return a map in which small spots that are not known are occupied."""
    if not (map.values == FREE).any():
        return map
    unknown, resolution = map.values == UNKNOWN, map.frame.resolution
    is_spot = unknown & ~large_regions(unknown, resolution, SPOT, by_corners=True)
    return OccupancyMap(map.frame, np.where(is_spot, np.int8(OCCUPIED), map.values))


def _fenced(map: OccupancyMap) -> OccupancyMap:
    """Return a map with a wall around it, if there is floor where the wall of its end would be."""
    values, frame = map.values, map.frame
    wall = math.ceil(FENCE / frame.resolution - 1e-9)
    ends = (values[:wall], values[-wall:], values[:, :wall], values[:, -wall:])
    if not any((end == FREE).any() for end in ends):
        return map
    around = GridFrame(
        frame.resolution,
        frame.origin_x - wall * frame.resolution,
        frame.origin_y - wall * frame.resolution,
        frame.rows + 2 * wall,
        frame.columns + 2 * wall,
    )
    return OccupancyMap(around, np.pad(values, wall, constant_values=OCCUPIED))


def _without_specks(map: OccupancyMap) -> OccupancyMap:
    """Return a map in which small unknown spots in the midst of floor are floor.

    A cell that is partly solid, or may be, does not become floor.
    """
    if not (map.values == FREE).any():
        return map
    is_open = (map.values != FREE) & (map.values < _HARDLY)
    spots = numbered_regions(is_open)
    areas = np.bincount(spots.ravel()) * map.frame.resolution**2
    is_speck = areas <= SPECK + 1e-9
    is_speck[spots[dilated(map.values >= _HARDLY, _AROUND)]] = False
    is_speck[0] = False
    return OccupancyMap(map.frame, np.where(is_speck[spots], np.int8(FREE), map.values))
