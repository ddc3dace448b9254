"""The floor that could be swept and that was, on 1 cm cells, by counting of its own.

The robot's middle may be on the middles of cells that are REACH or more from the middles of all
solid cells; half the tool's width from there on is floor that can be swept. The library counts by
squares, not by their middles: it keeps 0.165 m from the square of a solid cell, body (0.160) and
clearance. Along a wall that is the same, and at a corner this evaluator asks for 2 mm more. Poses
are true ones, joined by straight lines.

:func:`drawn` sweeps from the cells that the lines go through, so it is off by half a cell at most.
The recorded figures of other planners were made by it, and aims are judged by it.
:func:`first_swept` is exact: a cell is swept when its middle comes within half the tool's width of
a line. Ways keep to multiples of a cell from walls and from each other, so that the middles of
cells lie just at the rim of the swept floor. There a fraction of a millimetre decides about a whole
row of cells, so it reports more missed floor than there is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask
from roomba.grid import GridFrame

REACH: Final = 0.17
"""m; from the robot's middle to the middle of a solid cell."""
TOOL: Final = 0.20
"""m; width of the tool, a disc."""
CELL: Final = 0.01
"""m; about how large cells are."""
SPARE: Final = 0.03
"""m of extra room that a way needs beside things that the map does not show: no robot squeezes
through gaps that it can only guess."""
_BESIDE: Final = 1.5
"""Times SPARE: floor so near to a way lies right beside it, corners included."""
_TOUCH: Final = 1e-3
"""cells; tolerance of distances, which are float32."""

Disc = tuple[float, float, float]
"""x, y and radius of a round thing, m."""


@dataclass(frozen=True, eq=False)
class Reachable:
    """Where the robot's middle may be, and the ``floor`` that it can sweep: bool over ``frame``."""

    frame: GridFrame
    middles: Mask
    floor: Mask

    @property
    def area(self) -> float:
        """The floor's area, m2."""
        return float(np.count_nonzero(self.floor)) * self.frame.resolution**2

    @property
    def least_way(self) -> float:
        """The least way, m: that of a tool that sweeps each spot just once."""
        return self.area / TOOL


@dataclass(frozen=True)
class Patch:
    """A connected piece of floor: its area, m2, and the middle of its bounds, m."""

    area: float
    x: float
    y: float


def reachable(
    solid: Mask,
    frame: GridFrame,
    start: tuple[float, float],
    things: Sequence[Disc] = (),
    unknown: Mask | None = None,
) -> Reachable:
    """Return what can be reached from the place nearest to ``start``, m, where the robot fits.

    ``solid`` is bool over ``frame``; all outside is solid. ``unknown`` are solid cells that the map
    does not show. Round ``things`` and unknown cells block a way unless there is SPARE more room;
    the floor right beside them counts all the same. Raises ValueError if the robot fits nowhere.
    """
    parts = max(1, round(frame.resolution / CELL))
    fine = GridFrame(
        frame.resolution / parts,
        frame.origin_x,
        frame.origin_y,
        frame.rows * parts,
        frame.columns * parts,
    )
    large = _enlarged(solid, parts)
    fits = _keeps(np.pad(large, 1, constant_values=True), REACH, fine)[1:-1, 1:-1]
    fits &= _keeps_from_things(things, REACH, fine)
    ways = fits & _keeps_from_things(things, REACH + SPARE, fine)
    if unknown is not None and unknown.any():
        ways &= _keeps(_enlarged(unknown & solid, parts), REACH + SPARE, fine)
    if not ways.any():
        raise ValueError("expected a floor where the robot fits, got none")
    _, labels = cv2.connectedComponents(ways.astype(np.uint8), connectivity=4)
    x, y = middles_of(fine)
    away = np.hypot(y[:, None] - start[1], x[None, :] - start[0])
    middles = np.asarray(labels == labels.ravel()[np.argmin(np.where(ways, away, np.inf))])
    if not np.array_equal(ways, fits):
        middles = fits & (_away_from(middles) <= _BESIDE * SPARE / fine.resolution)
    within = _away_from(middles) <= 0.5 * TOOL / fine.resolution + _TOUCH
    return Reachable(fine, middles, within & ~large)


def middles_of(frame: GridFrame) -> tuple[Floats, Floats]:
    """Return x of the columns' middles and y of the rows' middles, m."""
    x = frame.origin_x + (np.arange(frame.columns) + 0.5) * frame.resolution
    y = frame.origin_y + (np.arange(frame.rows) + 0.5) * frame.resolution
    return x, y


def first_swept(frame: GridFrame, points: Floats, width: float = TOOL) -> NDArray[np.int32]:
    """Return the index of the point on the way to which each cell was first swept, else -1.

    ``points`` is [n, 2 or more]: x and y in m, joined by straight lines; int32 over ``frame``.
    """
    first = np.full(frame.shape, -1, np.int32)
    columns = (points[:, 0] - frame.origin_x) / frame.resolution - 0.5
    rows = (points[:, 1] - frame.origin_y) / frame.resolution - 0.5
    if len(points):
        _sweep(first, columns, rows, 0.5 * width / frame.resolution + 1e-9)
    return first


def swept_share(floor: Reachable, points: Floats) -> float:
    """Return the share of the floor that is swept, 0..1, as aims are judged."""
    return _share(floor, drawn(floor.frame, points))


def exact_share(floor: Reachable, points: Floats) -> float:
    """Return the share of the floor whose cells' middles come under the tool, 0..1."""
    return _share(floor, first_swept(floor.frame, points) >= 0)


def _share(floor: Reachable, swept: Mask) -> float:
    return float(np.count_nonzero(swept & floor.floor)) / np.count_nonzero(floor.floor)


def drawn(frame: GridFrame, points: Floats) -> Mask:
    """Return the cells that are swept from those that a way goes through, bool over ``frame``."""
    origin = np.array([frame.origin_x, frame.origin_y])
    corners = np.rint((points[:, :2] - origin) / frame.resolution - 0.5).astype(np.int32)
    line = np.zeros(frame.shape, np.uint8)
    cv2.polylines(line, [corners], False, (1,), 1)
    return np.asarray(_away_from(line > 0) <= 0.5 * TOOL / frame.resolution + _TOUCH)


def share_over_time(floor: Reachable, points: Floats) -> Floats:
    """Return for each point the share of the floor that is swept by then, as aims are judged."""
    frame = floor.frame
    corner = np.array([frame.origin_x, frame.origin_y]) + 0.5 * frame.resolution
    cells = np.rint((points[:, :2] - corner) / frame.resolution)
    first = first_swept(frame, corner + cells * frame.resolution)[floor.floor]
    counts = np.bincount(first[first >= 0], minlength=len(points))
    return np.asarray(np.cumsum(counts) / np.count_nonzero(floor.floor), np.float64)


def patches(frame: GridFrame, mask: Mask, least: float) -> tuple[Patch, ...]:
    """Return the regions of a mask of ``least`` m2 or more, the largest first."""
    count, _, table, centres = cv2.connectedComponentsWithStats(mask.astype(np.uint8))
    cell = frame.resolution
    found = [
        Patch(
            float(table[index, cv2.CC_STAT_AREA]) * cell**2,
            frame.origin_x + (float(centres[index, 0]) + 0.5) * cell,
            frame.origin_y + (float(centres[index, 1]) + 0.5) * cell,
        )
        for index in range(1, count)
    ]
    large = [patch for patch in found if patch.area >= least]
    return tuple(sorted(large, key=lambda patch: -patch.area))


def length(points: Floats) -> float:
    """Return the length of a way, m; ``points`` is [n, 2 or more], x and y in m."""
    return float(np.hypot(*np.diff(points[:, :2], axis=0).T).sum())


def turning(headings: Floats) -> float:
    """Return the sum of all turns, rad, to either side alike."""
    turns = np.diff(headings)
    return float(np.abs((turns + math.pi) % (2.0 * math.pi) - math.pi).sum())


def turning_at_corners(points: Floats) -> float:
    """Return the sum of the turns at the corners of a way, rad."""
    legs = np.diff(points[:, :2], axis=0)
    legs = legs[np.hypot(legs[:, 0], legs[:, 1]) > 1e-9]
    return turning(np.arctan2(legs[:, 1], legs[:, 0]))


def _away_from(mask: Mask) -> NDArray[np.float32]:
    """Return each cell's distance from the nearest cell of a mask, cells, middle to middle."""
    free = (~mask).astype(np.uint8)
    away: NDArray[np.float32] = cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return away


def _enlarged(mask: Mask, parts: int) -> Mask:
    """Return a mask with each cell divided into ``parts`` by ``parts`` finer cells."""
    return np.repeat(np.repeat(mask, parts, axis=0), parts, axis=1)


def _keeps(mask: Mask, distance: float, frame: GridFrame) -> Mask:
    """Return the cells at least a distance, m, from those of a mask, middle to middle."""
    return np.asarray(_away_from(mask) >= distance / frame.resolution - _TOUCH)


def _keeps_from_things(things: Sequence[Disc], distance: float, frame: GridFrame) -> Mask:
    """Return the cells at least a distance, m, from round things.

    Solid cells are measured from their middles, but things from their rims: hence half a cell less.
    """
    keeps = np.ones(frame.shape, np.bool_)
    x, y = middles_of(frame)
    for thing_x, thing_y, radius in things:
        away = np.hypot(y[:, None] - thing_y, x[None, :] - thing_x)
        keeps &= away >= radius + distance - 0.5 * frame.resolution
    return keeps


@njit(cache=True)
def _sweep(first: NDArray[np.int32], columns: Floats, rows: Floats, radius: float) -> None:
    """Write the number of a line's end point into cells of the line that have none yet."""
    height, width = first.shape
    for point in range(len(columns)):
        x, y = columns[point], rows[point]
        from_x, from_y = columns[max(point - 1, 0)], rows[max(point - 1, 0)]
        along_x, along_y = x - from_x, y - from_y
        square = along_x * along_x + along_y * along_y
        if point > 0 and square == 0.0:
            continue
        low_row = max(math.floor(min(y, from_y) - radius), 0)
        low_column = max(math.floor(min(x, from_x) - radius), 0)
        end_row = min(math.ceil(max(y, from_y) + radius) + 1, height)
        end_column = min(math.ceil(max(x, from_x) + radius) + 1, width)
        for row in range(low_row, end_row):
            for column in range(low_column, end_column):
                if first[row, column] >= 0:
                    continue
                share = 0.0
                if square > 0.0:
                    share = ((column - from_x) * along_x + (row - from_y) * along_y) / square
                    share = min(max(share, 0.0), 1.0)
                away_x = column - from_x - share * along_x
                away_y = row - from_y - share * along_y
                if away_x * away_x + away_y * away_y <= radius * radius:
                    first[row, column] = point
