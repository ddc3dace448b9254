"""How far a map is off the true one.

Compared are *sides*: the borders between an occupied and a free cell, each as long as a cell and
facing along an axis. Distances are between sides, not between cells, so that the two maps need
neither the same grid nor the same cell size.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask
from roomba.commands.map.error_kernels import (
    COLUMN_STEPS,
    ROW_STEPS,
    TrueSurfaces,
    count_surfaces,
    nearest_sides,
    offsets,
)
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.raster.regions import dilated, numbered_regions

NEAR: Final = 0.05
"""m; a mapped side counts as right if a true side is as near."""
_REACH: Final = 0.5
"""m; farther sides are not looked for."""
_CELL: Final = 0.01
"""m; floors are compared on cells about so large."""
_BAND: Final = 4_000_000
"""Cells that are compared at a time."""
DOUBLED_FROM, DOUBLED_TO = 0.03, 0.30
"""m; how far behind a side a second one lies if a wall was mapped twice."""
_LEAST_WALL: Final = 0.15
"""m; the least stretch on which a wall counts as mapped twice; a shorter one is a speck."""
_FIT_REACH: Final = 0.3
_FIT_ROUNDS: Final = 20


@dataclass(frozen=True, slots=True)
class MapError:
    """The errors of a map; ``walls`` is the share of its sides within NEAR of a true side, 0..1.

    ``wall_distance`` is the median distance of all its sides to the true ones, m. ``floor`` is the
    floor that is free on both maps, by that which is free on either one. ``doubled`` counts cells
    of walls that are mapped twice, ``specks`` those of shorter stretches. ``shift`` x, y, m, and
    ``rotation``, rad, move the true map onto this one, about the middle of its sides. ``extra`` is
    floor, m2, that is free on this map alone, ``missed`` on the true one alone.
    """

    walls: float
    wall_distance: float
    floor: float
    doubled: int
    specks: int
    shift: tuple[float, float]
    rotation: float
    extra: float
    missed: float


@dataclass(frozen=True, slots=True, eq=False)
class WallSides:
    """Sides of a map: their middles, float64 [n, 2], m; the way that each faces, 0 along x, then
    counter-clockwise; and the occupied cell's row and column, int64 [n, 2].
    """

    middles: Floats
    facings: NDArray[np.int64]
    cells: NDArray[np.int64]


def map_error(occupancy: OccupancyMap, frame: GridFrame, solid: Mask, seen: Mask) -> MapError:
    """Compare a map with the truth: what is ``solid``, and what of the rest counts as ``seen``.

    Both bool over ``frame``, which need not be the map's own. Free floor that is not ``seen`` does
    not count, be it on the map or not. Raises ValueError for a map without any side.
    """
    ground = TrueSurfaces(solid, seen, np.array([frame.origin_x, frame.origin_y, frame.resolution]))
    sides = sides_of(occupancy)
    if not len(sides.middles):
        raise ValueError("expected a map with occupied cells beside free ones, got none")
    away = np.empty(len(sides.middles))
    nearest_sides(ground, sides.middles, _REACH, away)
    both, extra, missed = _floors(occupancy, frame, solid, seen)
    doubled, specks = _doubled(occupancy, sides, ground)
    shift, rotation = _fit(sides, ground)
    return MapError(
        walls=float(np.mean(away <= NEAR + 1e-9)),
        wall_distance=float(np.median(np.minimum(away, _REACH))),
        floor=both / (both + extra + missed),
        doubled=int(doubled.sum()),
        specks=int(specks.sum()),
        shift=shift,
        rotation=rotation,
        extra=extra,
        missed=missed,
    )


def sides_of(occupancy: OccupancyMap) -> WallSides:
    """Return all sides between an occupied and a free cell."""
    frame, values = occupancy.frame, np.pad(occupancy.values, 1, constant_values=UNKNOWN)
    occupied, free = values == OCCUPIED, values == FREE
    middles, facings, cells = [], [], []
    for facing, (step_row, step_column) in enumerate(zip(ROW_STEPS, COLUMN_STEPS, strict=True)):
        is_side = occupied & np.roll(free, (-step_row, -step_column), (0, 1))
        at = np.argwhere(is_side) - 1
        row, column = at[:, 0] + 0.5 + 0.5 * step_row, at[:, 1] + 0.5 + 0.5 * step_column
        x = frame.origin_x + column * frame.resolution
        y = frame.origin_y + row * frame.resolution
        middles.append(np.column_stack((x, y)))
        facings.append(np.full(len(at), facing, np.int64))
        cells.append(at)
    return WallSides(np.concatenate(middles), np.concatenate(facings), np.concatenate(cells))


def wrong_sides(occupancy: OccupancyMap, frame: GridFrame, solid: Mask, seen: Mask) -> Floats:
    """Return the middles of sides that are not within NEAR of a true one, float64 [n, 2], m."""
    ground = TrueSurfaces(solid, seen, np.array([frame.origin_x, frame.origin_y, frame.resolution]))
    sides = sides_of(occupancy)
    away = np.empty(len(sides.middles))
    nearest_sides(ground, sides.middles, _REACH, away)
    return sides.middles[away > NEAR + 1e-9]


def _doubled(occupancy: OccupancyMap, sides: WallSides, ground: TrueSurfaces) -> tuple[Mask, Mask]:
    """Return the cells of walls that are mapped twice, and of shorter stretches that are."""
    twice = _has_second(occupancy, sides)
    middles, facings = sides.middles[twice], sides.facings[twice]
    counts = np.empty(len(middles), np.int64)
    count_surfaces(ground, middles, facings, DOUBLED_TO, NEAR, counts)
    least = math.ceil(_LEAST_WALL / occupancy.frame.resolution - 1e-9)
    walls, specks = np.zeros((2, *occupancy.frame.shape), np.bool_)
    for facing in range(4):
        found = np.zeros(occupancy.frame.shape, np.bool_)
        rows, columns = sides.cells[twice][(counts < 2) & (facings == facing)].T
        found[rows, columns] = True
        is_wall = _is_stretch(found, facing, least)
        walls |= is_wall
        specks |= found & ~is_wall
    return walls, specks & ~walls


def _is_stretch(cells: Mask, facing: int, least: int) -> Mask:
    """Return the connected cells that extend over ``least`` cells across their facing.

    Holes in a wall make sides that face along it: however many, they are no stretch.
    """
    # Cells that touch at corners are one wall: slanted ones are steps.
    regions = numbered_regions(dilated(cells, np.ones((3, 3), np.bool_)))
    at = np.argwhere(cells)
    numbers = regions[cells]
    across = at[:, 0] if facing % 2 == 0 else at[:, 1]
    low = np.full(int(regions.max()) + 1, np.iinfo(np.int64).max)
    high = np.full(len(low), -1)
    np.minimum.at(low, numbers, across)
    np.maximum.at(high, numbers, across)
    is_long = high - low + 1 >= least
    stretch: Mask = cells & is_long[regions]
    return stretch


def _has_second(occupancy: OccupancyMap, sides: WallSides) -> Mask:
    """Return which sides have another one that faces alike behind them, bool [n].

    Between the two lies free floor, for only there a side is seen.
    """
    size, reach = occupancy.frame.resolution, math.ceil(DOUBLED_TO / occupancy.frame.resolution)
    values = np.pad(occupancy.values, reach + 1, constant_values=UNKNOWN)
    ways = np.column_stack((ROW_STEPS, COLUMN_STEPS))[sides.facings]
    found = np.zeros(len(sides.middles), np.bool_)
    for step in range(math.ceil(DOUBLED_FROM / size), math.floor(DOUBLED_TO / size + 1e-9) + 1):
        behind = sides.cells + reach + 1 - step * ways
        before = behind + ways
        is_occupied = values[behind[:, 0], behind[:, 1]] == OCCUPIED
        found |= is_occupied & (values[before[:, 0], before[:, 1]] == FREE)
    return found


def _floors(
    occupancy: OccupancyMap, frame: GridFrame, solid: Mask, seen: Mask
) -> tuple[float, float, float]:
    """Return the floor, m2, that is free on both maps, on this one alone, on the true one alone."""
    parts = max(1, round(frame.resolution / _CELL))
    size = frame.resolution / parts
    fine = GridFrame(
        size, frame.origin_x, frame.origin_y, frame.rows * parts, frame.columns * parts
    )
    x, y = fine.centres()
    own_columns = _cells(x, occupancy, 0)
    band = max(1, _BAND // (frame.columns * parts * parts))
    own = np.pad(occupancy.values == FREE, 1)
    both = extra = missed = 0
    for first in range(0, frame.rows, band):
        last = min(first + band, frame.rows)
        own_rows = _cells(y[first * parts : last * parts], occupancy, 1)
        free = own[np.ix_(own_rows, own_columns)]
        here, wall = _enlarged(seen[first:last], parts), _enlarged(solid[first:last], parts)
        both += int(np.count_nonzero(free & here))
        extra += int(np.count_nonzero(free & wall))
        missed += int(np.count_nonzero(here & ~free))
    outside = _outside(occupancy, frame)
    return both * size**2, extra * size**2 + outside, missed * size**2


def _enlarged(mask: Mask, parts: int) -> Mask:
    return np.repeat(np.repeat(mask, parts, axis=0), parts, axis=1)


def _outside(occupancy: OccupancyMap, frame: GridFrame) -> float:
    """Return how much of a map's free floor lies outside of a frame, m2."""
    own, size = occupancy.frame, occupancy.frame.resolution
    x_min, x_max, y_min, y_max = frame.extent
    left = own.origin_x + np.arange(own.columns) * size
    low = own.origin_y + np.arange(own.rows) * size
    along_x = np.clip(np.minimum(left + size, x_max) - np.maximum(left, x_min), 0.0, size)
    along_y = np.clip(np.minimum(low + size, y_max) - np.maximum(low, y_min), 0.0, size)
    free = (occupancy.values == FREE).astype(np.float64)
    return max(0.0, float(free.sum() * size**2 - along_y @ free @ along_x))


def _cells(middles: Floats, occupancy: OccupancyMap, axis: int) -> NDArray[np.int64]:
    """Return the columns or rows of a map, padded by one cell, in which middles of cells lie."""
    frame = occupancy.frame
    origin = frame.origin_x if axis == 0 else frame.origin_y
    count = frame.columns if axis == 0 else frame.rows
    cells = np.floor((middles - origin) / frame.resolution + 1e-9).astype(np.int64) + 1
    within: NDArray[np.int64] = np.clip(cells, 0, count + 1)
    return within


def _fit(sides: WallSides, ground: TrueSurfaces) -> tuple[tuple[float, float], float]:
    """Return shift, m, and rotation, rad, that move the true map onto this one, least squares.

    The data are the distances of sides before the true sides of the same facing.
    """
    middle = sides.middles.mean(axis=0)
    arms = sides.middles - middle
    normals = np.column_stack((np.array(COLUMN_STEPS), np.array(ROW_STEPS)))[sides.facings]
    shift, rotation = np.zeros(2), 0.0
    off = np.empty(len(arms))
    for _ in range(_FIT_ROUNDS):
        cosine, sine = math.cos(-rotation), math.sin(-rotation)
        turned = (arms - shift) @ np.array([[cosine, sine], [-sine, cosine]])
        offsets(ground, turned + middle, sides.facings, _FIT_REACH, off)
        known = np.isfinite(off)
        if known.sum() < 3:
            break
        # The farthest are other walls, or what was mapped wrong.
        known &= np.abs(off) <= max(3.0 * float(np.median(np.abs(off[known]))), 0.05)
        slopes = normals[:, 1] * turned[:, 0] - normals[:, 0] * turned[:, 1]
        design = np.column_stack((normals, slopes))[known]
        step = np.linalg.lstsq(design, off[known], rcond=None)[0]
        cosine, sine = math.cos(rotation), math.sin(rotation)
        shift = shift + np.array([[cosine, -sine], [sine, cosine]]) @ step[:2]
        rotation += float(step[2])
        if float(np.abs(step).max()) < 1e-6:
            break
    return (float(shift[0]), float(shift[1])), rotation
